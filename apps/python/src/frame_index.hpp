// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <cstddef>

#include "viewgain/formats/frames.hpp"

namespace viewgain::python {

/// From the end if negative. Throws py::index_error.
[[nodiscard]] inline std::size_t frame_index(const FrameSequence& frames, pybind11::ssize_t index) {
  const auto count = static_cast<pybind11::ssize_t>(frames.images.size());
  if (index < 0) index += count;
  if (index < 0 || index >= count) throw pybind11::index_error("there is no such frame");
  return static_cast<std::size_t>(index);
}

}  // namespace viewgain::python
