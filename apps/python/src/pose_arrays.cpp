// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "pose_arrays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "viewgain/support/text.hpp"

namespace viewgain::python {
namespace {

constexpr double kRigid = kMaxPoseError;

// Poses are (4, 4), (3, 4) or 7 numbers in the last axes.
constexpr const char* kPoseShapes = "(..., 4, 4), (..., 3, 4) or (..., 7) of tx ty tz qx qy qz qw";
constexpr std::size_t kQuaternion = 7;
constexpr double kMendableNorm = 1e-2;  // as in files of poses

// Number of the last axes that form a pose; 0 if the array has no poses.
py::ssize_t pose_axes(const py::array& array) {
  const py::ssize_t n = array.ndim();
  if (n >= 2 && array.shape(n - 1) == 4 && (array.shape(n - 2) == 4 || array.shape(n - 2) == 3)) {
    return 2;
  }
  return n >= 1 && array.shape(n - 1) == static_cast<py::ssize_t>(kQuaternion) ? 1 : 0;
}

double norm_of(std::span<const double> m) {
  return std::hypot(std::hypot(m[3], m[4]), std::hypot(m[5], m[6]));
}

// The pose from 16, 12 or 7 numbers; NaN if its last row or its quaternion is invalid.
Pose pose_of(std::span<const double> m) {
  Pose pose;
  if (m.size() == kQuaternion) {
    if (!(std::abs(norm_of(m) - 1.0) <= kMendableNorm)) {
      pose.m[0] = std::numeric_limits<double>::quiet_NaN();
      return pose;
    }
    const auto q = Eigen::Quaterniond(m[6], m[3], m[4], m[5]).normalized();
    return {q.toRotationMatrix(), Eigen::Vector3d(m[0], m[1], m[2])};
  }
  std::copy_n(m.begin(), 12, pose.m.begin());
  const std::array<double, 4> last{0, 0, 0, 1};
  for (std::size_t i = 12; i < m.size(); ++i) {
    if (!(std::abs(m[i] - last[i - 12]) <= kRigid)) {
      pose.m[0] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return pose;
}

// What is wrong with pose = pose_of(m); empty if nothing.
std::string fault_of(const Pose& pose, std::span<const double> m) {
  if (!std::all_of(m.begin(), m.end(), [](double x) { return std::isfinite(x); })) {
    return "has a number that is not finite";
  }
  if (!std::isfinite(pose.m[0])) {
    return m.size() == kQuaternion
               ? "has a quaternion of norm " + short_text(norm_of(m)) + ", not 1"
               : std::string("has a last row that is not 0 0 0 1");
  }
  const double error = orthonormality_error(pose);
  if (!(error <= kRigid)) {
    return "has a rotation matrix that deviates by " + short_text(error) +
           " from an orthonormal, right-handed matrix";
  }
  return {};
}

std::string index_text(std::size_t index, const Shape& shape) {
  if (shape.empty()) return "";
  std::string text;
  for (std::size_t axis = shape.size(); axis-- > 0;) {
    const auto extent = static_cast<std::size_t>(shape[axis]);
    text.insert(0, std::to_string(index % extent) + (text.empty() ? "" : ", "));
    index /= extent;
  }
  return "[" + text + "]";
}

}  // namespace

PoseBatch pose_batch(const py::handle& value, const char* name, bool strict) {
  const Doubles array = doubles(value, name);
  PoseBatch batch;
  if (is_empty_list(array)) {
    batch.shape = {0};
    return batch;
  }
  const py::ssize_t axes = pose_axes(array);
  if (axes == 0) reject_shape(name, kPoseShapes, array);
  batch.shape = leading_shape(array, axes);
  std::size_t size = kQuaternion;
  if (axes == 2) size = array.shape(array.ndim() - 2) == 4 ? 16 : 12;
  const std::size_t count = static_cast<std::size_t>(array.size()) / size;
  batch.poses.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::span<const double> m(array.data() + i * size, size);
    batch.poses.push_back(pose_of(m));
    if (!strict) continue;
    const std::string fault = fault_of(batch.poses.back(), m);
    if (!fault.empty()) {
      throw py::value_error(std::string(name) + index_text(i, batch.shape) + " " + fault);
    }
  }
  return batch;
}

Pose one_pose(const py::handle& value, const char* name, bool strict) {
  const Doubles array = doubles(value, name);
  const PoseBatch batch = pose_batch(array, name, strict);
  if (!batch.shape.empty()) reject_shape(name, "(4, 4), (3, 4) or (7,) of one pose", array);
  return batch.poses.front();
}

std::optional<Pose> optional_pose(const py::object& value, const char* name) {
  if (value.is_none()) return std::nullopt;
  return one_pose(value, name);
}

std::vector<Pose> pose_list(const py::handle& value, const char* name) {
  const Doubles array = doubles(value, name);
  PoseBatch batch = pose_batch(array, name, true);
  if (batch.shape.size() != 1) reject_shape(name, "(n, 4, 4), (n, 3, 4) or (n, 7)", array);
  return std::move(batch.poses);
}

py::array_t<double> to_array(std::span<const Pose> poses, const Shape& leading) {
  Shape shape = leading;
  shape.insert(shape.end(), {4, 4});
  py::array_t<double> array(shape);
  double* m = array.mutable_data();
  for (const Pose& pose : poses) {
    m = std::copy(pose.m.begin(), pose.m.end(), m);
    for (const double last : {0.0, 0.0, 0.0, 1.0}) *m++ = last;
  }
  return array;
}

py::array_t<double> to_array(const Pose& pose) { return to_array(std::span(&pose, 1), {}); }

}  // namespace viewgain::python
