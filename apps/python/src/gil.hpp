// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cxxabi.h>
#include <pybind11/pybind11.h>
#include <unistd.h>

#include <memory>
#include <utility>

namespace viewgain::python {

// The GIL. A daemon thread that wants it back while the interpreter ends does not get it: Python up
// to 3.13 calls pthread_exit there, which unwinds the stack, runs destructors that need the GIL and
// aborts the process at the first noexcept function. Here such a thread stays where it is until the
// process is gone, as Python itself does it from 3.14 on. pybind11's own guards do not.

/// Waits for the end of the process.
[[noreturn]] inline void stay() {
  for (;;) ::pause();
}

/// Leaves the GIL as long as it lives. Make it with the GIL held.
class WithoutGil {
 public:
  WithoutGil() : state_(PyEval_SaveThread()) {}
  ~WithoutGil() {
    try {
      PyEval_RestoreThread(state_);
    } catch (...) {  // the unwinding of pthread_exit, which must not be swallowed: never leave
      stay();
    }
  }
  WithoutGil(const WithoutGil&) = delete;
  WithoutGil& operator=(const WithoutGil&) = delete;

 private:
  PyThreadState* state_;
};

/// f() without the GIL, with which it is called; f must not touch Python.
template <typename F>
auto outside_gil(const F& f) {
  const WithoutGil without_gil;
  return f();
}

/// Holds the GIL as long as it lives, on any thread. For callbacks use with_gil.
class WithGil {
 public:
  WithGil() noexcept : state_(ensure()) {}
  ~WithGil() { PyGILState_Release(state_); }
  WithGil(const WithGil&) = delete;
  WithGil& operator=(const WithGil&) = delete;

 private:
  // PyGILState_Ensure asks nobody: when the interpreter has forgotten this thread it makes a state
  // for it in an interpreter that is no more.
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

/// f() with the GIL held, on any thread; exceptions of C++ pass. Python code in f may lose the GIL
/// and not get it back, so the callers, who catch everything, are kept from that.
template <typename F>
auto with_gil(const F& f) {
  const WithGil guard;
  try {
    return f();
  } catch (const abi::__forced_unwind&) {
    stay();
  }
}

/// Calls a callable of Python's; throws py::error_already_set. Stops an unwinding before the
/// arguments would be dropped without the GIL.
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

/// A callable of Python's that C++ may keep, copy and drop on any thread, with the GIL or without.
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
