// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/pose.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

/// Sine of the angle under which two directions count as parallel; cos(pi/2) in doubles is 6e-17.
constexpr double kParallelSine = 1e-8;

bool all_finite(const Pose& pose) {
  return std::all_of(pose.m.begin(), pose.m.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace

double orthonormality_error(const Pose& pose) {
  const Eigen::Matrix3d R = pose.rotation();
  if (!all_finite(pose) || !(R.determinant() > 0)) return std::numeric_limits<double>::infinity();
  return (R.transpose() * R - Eigen::Matrix3d::Identity()).lpNorm<Eigen::Infinity>();
}

Pose orthonormalized(const Pose& pose) {
  if (!all_finite(pose)) return pose;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(pose.rotation(),
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d U = svd.matrixU();
  // For a reflection, the nearest rotation flips the weakest axis.
  if ((U * svd.matrixV().transpose()).determinant() < 0) U.col(2) = -U.col(2);
  return {U * svd.matrixV().transpose(), pose.translation()};
}

std::optional<Pose> rigid_pose(const Pose& pose) {
  constexpr double kUnnoticed = 1e-9;
  const double error = orthonormality_error(pose);
  if (!(error <= kMaxPoseError)) return std::nullopt;
  return error <= kUnnoticed ? pose : orthonormalized(pose);
}

Pose look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, const Eigen::Vector3d& up) {
  if (!eye.allFinite() || !target.allFinite() || !up.allFinite()) {
    refuse("look_at: eye, target and up must be finite");
  }
  const Eigen::Vector3d direction = target - eye;
  if (!direction.allFinite()) refuse("look_at: eye and target are too far apart");
  if (direction.isZero(0)) refuse("look_at: eye and target are the same point");
  if (up.isZero(0)) refuse("look_at: up must not be zero");

  const Eigen::Vector3d z = direction.stableNormalized();
  Eigen::Vector3d x = z.cross(up.stableNormalized());
  if (x.norm() < kParallelSine) x = z.cross(Eigen::Vector3d::UnitX());
  if (x.norm() < kParallelSine) x = z.cross(Eigen::Vector3d::UnitY());
  x.normalize();
  // A short cross product has a large relative error. Orthogonalises again, now with unit vectors.
  x = (x - z * z.dot(x)).normalized();

  Eigen::Matrix3d R;
  R.col(0) = x;
  R.col(1) = z.cross(x);
  R.col(2) = z;
  return {R, eye};
}

}  // namespace viewgain
