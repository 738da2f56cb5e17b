// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "arrays.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain::python {

/// A frame of the sensor from arrays (height, width); `amplitude` may be None. What is no depth
/// (NaN, negative) is invalid.
[[nodiscard]] inline DepthFrame depth_frame(const Sensor& sensor, const py::object& depth,
                                            const py::object& amplitude) {
  const int width = sensor.camera.width, height = sensor.camera.height;
  DepthFrame frame{width, height, image(depth, "depth", height, width)};
  for (float& z : frame.depth) {
    if (!(z > 0)) z = DepthFrame::kInvalid;
  }
  if (!amplitude.is_none()) frame.amplitude = image(amplitude, "amplitude", height, width);
  return frame;
}

/// Pixels row by row as an array (height, width).
[[nodiscard]] inline py::array_t<float> image_array(const std::vector<float>& pixels, int height,
                                                    int width) {
  return py::array_t<float>(Shape{height, width}, pixels.data());
}

}  // namespace viewgain::python
