// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "arrays.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain::python {

/// A frame of the sensor from floating point arrays (height, width); `amplitude` may be None. What
/// is no depth (NaN, negative, masked) is invalid; a masked amplitude is NaN. Throws
/// py::value_error for another shape or dtype, and as require_metres().
[[nodiscard]] DepthFrame depth_frame(const Sensor& sensor, const py::object& depth,
                                     const py::object& amplitude);

/// Throws py::value_error if even the nearest reading [m] is beyond 10 times the sensor's
/// max_range, as where a frame is in millimetres: all would be out of range and carve the object
/// away. Infinite: there is no reading.
void require_metres(double nearest, const Sensor& sensor, const char* name);

/// Pixels row by row as an array (height, width).
[[nodiscard]] py::array_t<float> image_array(const std::vector<float>& pixels, int height,
                                             int width);

}  // namespace viewgain::python
