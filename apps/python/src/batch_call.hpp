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

/// Observes or stops long calls from Python: a callable for progress, and stop(), which any thread
/// may call.
struct Control {
  py::object progress = py::none();  ///< called with (done, total); a false answer asks for a stop
  std::stop_source stop{};
};

/// Runs a long call on another thread without the GIL. Meanwhile the caller, with the GIL, checks
/// for signals such as Ctrl-C and calls the progress function every 50 ms, and once at the end. An
/// exception of either stops the call and passes through. `control` may be null. Takes about 50 µs
/// more than the call itself. Call with the GIL; `work` may use Python only through with_gil().
void run_batch(Control* control, const std::function<void(const BatchControl&)>& work);

}  // namespace viewgain::python
