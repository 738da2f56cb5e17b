// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "arrays.hpp"
#include "viewgain/core/pose.hpp"

namespace viewgain::python {

// Conversions of poses from and to Python's arrays, as in arrays.hpp.

/// Poses and the shape of their array without the axes of a pose.
struct PoseBatch {
  std::vector<Pose> poses;
  Shape shape;
};

/// T_world_camera as (..., 4, 4), (..., 3, 4) or (..., 7) of tx ty tz [m] and qx qy qz qw. A pose
/// is invalid (NaN) if its last row or its rotation deviates by more than 1e-3, or a quaternion's
/// norm by more than 1e-2; with `strict`, throws with the pose's index instead.
[[nodiscard]] PoseBatch pose_batch(const py::handle& value, const char* name, bool strict);
[[nodiscard]] Pose one_pose(const py::handle& value, const char* name, bool strict = true);
[[nodiscard]] std::optional<Pose> optional_pose(const py::object& value, const char* name);
/// Poses with one leading axis, which must all be valid.
[[nodiscard]] std::vector<Pose> pose_list(const py::handle& value, const char* name);

[[nodiscard]] py::array_t<double> to_array(std::span<const Pose> poses, const Shape& leading);
[[nodiscard]] py::array_t<double> to_array(const Pose& pose);

}  // namespace viewgain::python
