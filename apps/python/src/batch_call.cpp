// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "batch_call.hpp"

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "classes.hpp"
#include "gil.hpp"

namespace viewgain::python {
namespace {

constexpr std::chrono::milliseconds kLook{50};

// Messages from the working thread to the waiting one.
struct Mailbox {
  std::mutex mutex;
  std::condition_variable finished;
  bool done = false;
  std::size_t count = 0, total = 0;
  std::exception_ptr error;
};

using Count = std::pair<std::size_t, std::size_t>;  // done, total

// Whether the progress function's result requests a stop. Passes on exceptions of its truth value.
bool asks_for_stop(const py::object& answer) {
  if (answer.is_none()) return false;
  const int truth = PyObject_IsTrue(answer.ptr());
  if (truth < 0) throw py::error_already_set();
  return truth == 0;
}

// Passes on exceptions of Python's signal handlers.
void check_signals() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

// Calls the progress function. Passes on its exceptions.
void tell(Control* control, Count now, std::optional<Count>& told, std::stop_source& stop) {
  if (control == nullptr || control->progress.is_none()) return;
  told = now;
  if (asks_for_stop(call_python(control->progress, now.first, now.second))) {
    control->stop.request_stop();
    stop.request_stop();
  }
}

}  // namespace

void run_batch(Control* control, const std::function<void(const BatchControl&)>& work) {
  Mailbox box;
  std::stop_source stop;
  std::optional<Count> told;
  // A stop from any thread takes effect immediately, not only at the next check.
  const std::stop_callback forward(
      control != nullptr ? control->stop.get_token() : std::stop_token(),
      [&] { stop.request_stop(); });
  BatchControl watched;
  watched.stop = stop.get_token();
  if (control != nullptr && !control->progress.is_none()) {
    watched.progress = [&](std::size_t count, std::size_t total) {
      const std::lock_guard lock(box.mutex);
      box.count = count;
      box.total = total;
    };
  }
  std::exception_ptr raised;  // exception from Python
  {
    const WithoutGil without_gil;
    std::jthread worker([&] {
      try {
        work(watched);
      } catch (...) {
        box.error = std::current_exception();
      }
      const std::lock_guard lock(box.mutex);
      box.done = true;
      box.finished.notify_one();
    });
    std::unique_lock lock(box.mutex);
    while (!box.finished.wait_for(lock, kLook, [&] { return box.done; })) {
      const Count now(box.count, box.total);
      lock.unlock();
      if (!raised) {
        try {
          with_gil([&] {
            check_signals();
            if (now.second > 0) tell(control, now, told, stop);
          });
        } catch (...) {
          raised = std::current_exception();
          stop.request_stop();
        }
      }
      lock.lock();
    }
  }
  if (raised) std::rethrow_exception(raised);
  if (box.error) std::rethrow_exception(box.error);
  check_signals();
  const Count last(box.count, box.total);
  if (told != last) tell(control, last, told, stop);
}

void bind_control(py::module_& module) {
  auto type = bound_class<Control>(module, "BatchControl", R"(Observes or stops a long call.

Parameters
----------
progress : callable, optional
    Called with ``(done, total)`` on the calling thread, about every 50 ms and at the end; for an
    empty batch with ``(0, 0)``. If it returns ``False`` (or another false value except ``None``),
    the call stops. If it raises an exception, the call stops and raises it.

Notes
-----
A control that was stopped stays stopped, so make a new one for each call. Ctrl-C also works without
a control.)");
  refuse_pickling(type);
  type.def(py::init([](py::object progress) {
             if (!progress.is_none() && PyCallable_Check(progress.ptr()) == 0) {
               throw py::type_error("progress must be callable");
             }
             auto control = std::make_unique<Control>();
             control->progress = std::move(progress);
             return control;
           }),
           "progress"_a = py::none())
      .def(
          "stop", [](Control& control) { control.stop.request_stop(); },
          "Asks the running call to return early with its results so far. Any thread may call it.")
      .def_property_readonly(
          "stopped", [](const Control& control) { return control.stop.stop_requested(); },
          "bool: whether a stop was requested")
      .def("__repr__", [](const Control& control) {
        return control.stop.stop_requested() ? "BatchControl(stopped)" : "BatchControl()";
      });
}

}  // namespace viewgain::python
