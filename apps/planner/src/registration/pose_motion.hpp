// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>

#include "registration/registration_view.hpp"
#include "viewgain/core/pose.hpp"

namespace viewgain::detail {

/// Difference of two poses: displacement of the camera centre, and rotation vector about it; world
/// axes.
[[nodiscard]] Vector6 difference(const Pose& T, const Pose& T_from);

/// The pose after such a difference.
[[nodiscard]] Pose moved(const Pose& T, const Vector6& step);

/// Eigenvectors of the information that both sides agree on, in units of the prior's sigmas.
struct Directions {
  Vector6 information;  ///< data relative to the prior, along each; smallest first
  Matrix6 axes;
};
[[nodiscard]] Directions directions_of(const Matrix6& agreed, const Vector6& sigmas);

/// The columns along which the data are stronger than the prior; 6 columns, the others are 0.
[[nodiscard]] Matrix6 held_axes(const Directions& directions);

/// Variance of the gradients of parts, which have expectation 0 at the right pose, relative to that
/// of independent residuals.
struct Overdispersion {
  /// Sum over determined motions of the variance of their slopes over the information.
  double sum = 0;
  int motions = 0;
  [[nodiscard]] double mean() const { return motions > 0 ? sum / motions : 0.0; }
};
/// Adds a pose with the gradients of its parts and its total information; `held` are held_axes().
void add_overdispersion(Overdispersion& sum, std::span<const Vector6> gradients,
                        const Matrix6& information, const Matrix6& held, const Vector6& sigmas);

/// Ratio of the reports' variance to the prior's, between 1e-4 and 1: the most likely share s given
/// the requested motions, which maximises Σ log N(x; 0, s + v) over the axes of the information
/// (empirical Bayes, Efron and Morris 1973). x is the motion along an axis without the prior, v
/// twice its variance from the information. All in the prior's sigmas: information and gradient of
/// the data at the current poses, and the distance of these from the reports.
[[nodiscard]] double likeliest_scale(const Eigen::MatrixXd& information,
                                     const Eigen::VectorXd& gradient, const Eigen::VectorXd& away);

}  // namespace viewgain::detail
