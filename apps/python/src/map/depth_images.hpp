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

/// A frame of the sensor from floating point arrays (height, width); `amplitude` may be None. NaN,
/// negative and masked depths are invalid; a masked amplitude is NaN. Throws py::value_error for
/// another shape or dtype. Also throws whatever MetresCheck throws.
[[nodiscard]] DepthFrame depth_frame(const Sensor& sensor, const py::object& depth,
                                     const py::object& amplitude);

/// As above in any unit, for functions that check units themselves.
[[nodiscard]] DepthFrame depth_frame_of_any_unit(const Sensor& sensor, const py::object& depth);

/// Checks that depths are in metres. In millimetres, all would be out of range and mark the object
/// as free.
class MetresCheck {
 public:
  explicit MetresCheck(const Sensor& sensor) : max_range_(sensor.max_range) {}

  /// Adds a range [m]; ignored if it is not finite.
  void add(double range);
  /// Throws py::value_error if all ranges are beyond 10 times max_range, or 19 of 20 are and
  /// differ. A single repeated value may mean "no reading".
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
