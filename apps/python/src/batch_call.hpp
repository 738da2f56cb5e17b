// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <stop_token>

#include "viewgain/core/exec_config.hpp"

namespace viewgain::python {

namespace py = pybind11;
using namespace py::literals;

/// Watches or ends long calls from Python: a callable that is told how far a call is, and stop(),
/// which any thread may call.
struct Control {
  py::object progress = py::none();  ///< called with (done, total); a false answer asks for a stop
  std::stop_source stop{};
};

/// Runs a long call without the GIL, so that Ctrl-C and progress are seen to while it runs: the
/// work is done on a thread of its own (and the pool's), and the caller, with the GIL, looks every
/// 50 ms for signals and calls the progress function, which is told the end in any case. An
/// exception of either stops the call and passes through. `control` may be null. Takes about 50 µs
/// more than the call itself. Call with the GIL; `work` must not touch Python
/// but by with_gil().
void run_batch(Control* control, const std::function<void(const BatchControl&)>& work);

}  // namespace viewgain::python
