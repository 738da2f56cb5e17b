// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cxxabi.h>
#include <pybind11/pybind11.h>
#include <unistd.h>

#include <memory>
#include <utility>

namespace viewgain::python {

// Guards for the GIL. While the interpreter ends, a daemon thread does not get the GIL back: Python
// up to 3.13 calls pthread_exit, which runs destructors that need the GIL, and aborts the process
// at the first noexcept function. With these guards such a thread waits until the process ends, as
// in Python 3.14. pybind11's own guards do not do this.

/// Waits for the end of the process.
[[noreturn]] inline void stay() {
  for (;;) ::pause();
}

/// Releases the GIL while it exists. Create it with the GIL held.
class WithoutGil {
 public:
  WithoutGil() : state_(PyEval_SaveThread()) {}
  ~WithoutGil() {
    try {
      PyEval_RestoreThread(state_);
    } catch (...) {  // unwinding of pthread_exit, which must not be caught: never leave
      stay();
    }
  }
  WithoutGil(const WithoutGil&) = delete;
  WithoutGil& operator=(const WithoutGil&) = delete;

 private:
  PyThreadState* state_;
};

/// Calls f() without the GIL. Call it with the GIL; f must not touch Python.
template <typename F>
auto outside_gil(const F& f) {
  const WithoutGil without_gil;
  return f();
}

/// Holds the GIL while it exists, on any thread. For callbacks use with_gil.
class WithGil {
 public:
  WithGil() noexcept : state_(ensure()) {}
  ~WithGil() { PyGILState_Release(state_); }
  WithGil(const WithGil&) = delete;
  WithGil& operator=(const WithGil&) = delete;

 private:
  // PyGILState_Ensure does not check whether the interpreter still exists, and would make a state
  // in an interpreter that has ended.
  static PyGILState_STATE ensure() noexcept {
    if (Py_IsInitialized() == 0) stay();
    try {
      return PyGILState_Ensure();
    } catch (...) {
      stay();
    }
  }
  PyGILState_STATE state_;
};

/// Calls f() with the GIL, on any thread; C++ exceptions pass. Python code in f can lose the GIL
/// and not get it back; the unwinding then never reaches the callers, which catch everything.
template <typename F>
auto with_gil(const F& f) {
  const WithGil guard;
  try {
    return f();
  } catch (const abi::__forced_unwind&) {
    stay();
  }
}

/// Calls a Python callable; throws py::error_already_set. Stops an unwinding before the arguments
/// would be destroyed without the GIL.
template <typename... Args>
pybind11::object call_python(const pybind11::object& callable, Args&&... args) {
  const pybind11::tuple tuple = pybind11::make_tuple(std::forward<Args>(args)...);
  PyObject* answer = nullptr;
  try {
    answer = PyObject_CallObject(callable.ptr(), tuple.ptr());
  } catch (const abi::__forced_unwind&) {
    stay();
  }
  if (answer == nullptr) throw pybind11::error_already_set();
  return pybind11::reinterpret_steal<pybind11::object>(answer);
}

/// A Python callable that C++ may keep, copy and destroy on any thread, with or without the GIL.
class PythonCall {
 public:
  explicit PythonCall(pybind11::object callable)
      : callable_(new pybind11::object(std::move(callable)),
                  [](pybind11::object* held) { with_gil([&] { delete held; }); }) {}

  /// Call with the GIL.
  template <typename... Args>
  pybind11::object operator()(Args&&... args) const {
    return call_python(*callable_, std::forward<Args>(args)...);
  }

 private:
  std::shared_ptr<pybind11::object> callable_;
};

}  // namespace viewgain::python
