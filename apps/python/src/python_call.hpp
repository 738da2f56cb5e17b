// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <utility>

#include "gil.hpp"

namespace viewgain::python {

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
