// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "registration/pose_motion.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

namespace viewgain::detail {
Vector6 difference(const Pose& T, const Pose& T_from) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(T.rotation() * T_from.rotation().transpose()));
  Vector6 d;
  d << T.translation() - T_from.translation(), turn.angle() * turn.axis();
  return d;
}

Pose moved(const Pose& T, const Vector6& step) {
  const Eigen::Vector3d turn = step.tail<3>();
  const double angle = turn.norm();
  Eigen::Matrix3d R = T.rotation();
  if (angle > 0) R = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() * R;
  return orthonormalized({R, T.translation() + step.head<3>()});
}

Directions directions_of(const Matrix6& agreed, const Vector6& sigmas) {
  const Matrix6 scaled = sigmas.asDiagonal() * agreed * sigmas.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(scaled);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Matrix6 held_axes(const Directions& directions) {
  Matrix6 axes = directions.axes;
  for (int k = 0; k < 6; ++k) {
    if (!(directions.information[k] >= 1)) axes.col(k).setZero();
  }
  return axes;
}

void add_overdispersion(Overdispersion& sum, std::span<const Vector6> gradients,
                        const Matrix6& information, const Matrix6& held, const Vector6& sigmas) {
  for (int k = 0; k < 6; ++k) {
    if (held.col(k).isZero()) continue;
    const Vector6 axis = sigmas.asDiagonal() * held.col(k);
    double variance = 0;
    for (const Vector6& gradient : gradients) {
      const double slope = axis.dot(gradient);
      variance += slope * slope;
    }
    sum.sum += variance / axis.dot(information * axis);
    ++sum.motions;
  }
}

double likeliest_scale(const Eigen::MatrixXd& information, const Eigen::VectorXd& gradient,
                       const Eigen::VectorXd& away) {
  constexpr double kHonesty = 2;
  constexpr double kLeast = 1e-4, kStep = 0.9;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(information);
  const Eigen::VectorXd along = axes.eigenvectors().transpose() * away;
  const Eigen::VectorXd slope = axes.eigenvectors().transpose() * gradient;
  double best = 0, best_scale = 1;
  for (double scale = 1; scale > kLeast; scale *= kStep) {
    double score = 0;
    for (Eigen::Index k = 0; k < along.size(); ++k) {
      const double held = axes.eigenvalues()[k];
      if (!(held >= 1)) continue;
      const double x = along[k] - slope[k] / held;
      const double variance = scale + kHonesty / held;
      score -= std::log(variance) + x * x / variance;
    }
    if (scale == 1 || score > best) best = score, best_scale = scale;
  }
  return best_scale;
}

}  // namespace viewgain::detail
