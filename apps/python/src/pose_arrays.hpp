// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "arrays.hpp"
#include "viewgain/core/pose.hpp"

namespace viewgain::python {

// Poses from Python's arrays and back, as in arrays.hpp.

/// Poses and the shape of their array without the axes of a pose.
struct PoseBatch {
  std::vector<Pose> poses;
  Shape shape;
};

/// T_world_camera as (..., 4, 4), (..., 3, 4) or (..., 7) of tx ty tz qx qy qz qw [m], [1]. A last
/// row or a rotation that is off by more than 1e-3, or a quaternion's norm by 1e-2, makes a bad
/// pose (NaN); with `strict` it throws and names the pose's index.
[[nodiscard]] PoseBatch pose_batch(const py::handle& value, const char* name, bool strict);
[[nodiscard]] Pose one_pose(const py::handle& value, const char* name, bool strict = true);
[[nodiscard]] std::optional<Pose> optional_pose(const py::object& value, const char* name);
/// Of one leading axis, every one good.
[[nodiscard]] std::vector<Pose> pose_list(const py::handle& value, const char* name);

[[nodiscard]] py::array_t<double> to_array(std::span<const Pose> poses, const Shape& leading);
[[nodiscard]] py::array_t<double> to_array(const Pose& pose);

}  // namespace viewgain::python
