// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "arrays.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain::python {

/// A frame of the sensor from floating point arrays (height, width); `amplitude` may be None. What
/// is no depth (NaN, negative, masked) is invalid; a masked amplitude is NaN. Throws
/// py::value_error for another shape or dtype, and as MetresCheck.
[[nodiscard]] DepthFrame depth_frame(const Sensor& sensor, const py::object& depth,
                                     const py::object& amplitude);

/// The same in whatever unit: for what judges units itself.
[[nodiscard]] DepthFrame depth_frame_of_any_unit(const Sensor& sensor, const py::object& depth);

/// Are readings in metres? In millimetres, all would be out of range and carve the object away.
class MetresCheck {
 public:
  explicit MetresCheck(const Sensor& sensor) : max_range_(sensor.max_range) {}

  /// A reading [m]; what is not finite is none.
  void add(double range);
  /// Throws py::value_error if all readings are beyond 10 times max_range, or 19 in 20 are and not
  /// all at the same: one value may stand for no reading.
  void require(const char* name) const;

 private:
  double max_range_;
  std::size_t near_ = 0, far_ = 0;
  double nearest_far_ = std::numeric_limits<double>::infinity(), farthest_ = 0;
};

/// Pixels row by row as an array (height, width).
[[nodiscard]] py::array_t<float> image_array(const std::vector<float>& pixels, int height,
                                             int width);

}  // namespace viewgain::python
