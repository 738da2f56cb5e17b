// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/pybind11.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <new>

#include "bindings.hpp"

namespace viewgain::python {
namespace {

// Debian's OpenVDB loads log4cplus, which starts threads as soon as it is loaded. A forked child
// has none of them, but it has the exit handler that waits for them, for ever. What is registered
// last runs first, so this one ends the process before it comes to that; Python has by then been
// through its own end, atexit functions included. Handlers that the parent registered in C are left
// out, which is how a child should end that did not exec.
void leave_at_exit() {
  const int failed = on_exit(
      [](int status, void*) {
        std::fflush(nullptr);
        _exit(status);
      },
      nullptr);
  if (failed != 0) throw std::bad_alloc();
}

}  // namespace

void bind_fork() {
  namespace py = pybind11;
  py::module_::import("os").attr("register_at_fork")(py::arg("after_in_child") =
                                                         py::cpp_function(&leave_at_exit));
}

}  // namespace viewgain::python
