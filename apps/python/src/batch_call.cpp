// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "batch_call.hpp"

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "bindings.hpp"

namespace viewgain::python {
namespace {

constexpr std::chrono::milliseconds kLook{50};

// What the working thread tells the waiting one.
struct Mailbox {
  std::mutex mutex;
  std::condition_variable finished;
  bool done = false;
  std::size_t count = 0, total = 0;
  std::exception_ptr error;
};

// Signals first, then the progress function. Throws what they raise.
void look(Control* control, std::pair<std::size_t, std::size_t> now,
          std::pair<std::size_t, std::size_t>& told, std::stop_source& stop) {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (control == nullptr) return;
  if (control->stop.stop_requested()) stop.request_stop();
  if (control->progress.is_none() || now == told || now.second == 0) return;
  told = now;
  const py::object answer = control->progress(now.first, now.second);
  if (answer.is(py::handle(Py_False))) {
    control->stop.request_stop();
    stop.request_stop();
  }
}

}  // namespace

void run_batch(Control* control, const std::function<void(const BatchControl&)>& work) {
  Mailbox box;
  std::stop_source stop;
  std::pair<std::size_t, std::size_t> told{0, 0};
  // A stop from another thread must not wait for the next look.
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
  std::exception_ptr raised;  // by Python
  {
    const py::gil_scoped_release without_gil;
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
      const std::pair now(box.count, box.total);
      lock.unlock();
      if (!raised) {
        const py::gil_scoped_acquire with_gil;
        try {
          look(control, now, told, stop);
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
  look(control, {box.count, box.total}, told, stop);
}

void bind_control(py::module_& module) {
  py::class_<Control>(module, "BatchControl", R"(Watches or ends a long call.

Parameters
----------
progress : callable, optional
    Called with ``(done, total)`` on the calling thread, at most about every 50 ms and at the end.
    If it returns ``False`` the call stops; an exception that it raises stops the call and is raised
    from there.

Notes
-----
A control that was stopped stays so: make one for each call. Ctrl-C is honoured with or without one.)")
      .def(py::init([](py::object progress) {
             if (!progress.is_none() && PyCallable_Check(progress.ptr()) == 0) {
               throw py::type_error("progress must be callable");
             }
             auto control = std::make_unique<Control>();
             control->progress = std::move(progress);
             return control;
           }),
           py::arg("progress") = py::none())
      .def(
          "stop", [](Control& control) { control.stop.request_stop(); },
          "Ask the running call to return early, with what it has. Any thread may call it.")
      .def_property_readonly(
          "stopped", [](const Control& control) { return control.stop.stop_requested(); },
          "bool: a stop was asked for.")
      .def("__repr__", [](const Control& control) {
        return control.stop.stop_requested() ? "BatchControl(stopped)" : "BatchControl()";
      });
}

}  // namespace viewgain::python
