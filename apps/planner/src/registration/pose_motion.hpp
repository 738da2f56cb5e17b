// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>

#include "registration/registration_view.hpp"
#include "viewgain/core/pose.hpp"

namespace viewgain::detail {

/// How a pose differs from another: the way of the camera's centre, the rotation vector about it;
/// world axes.
[[nodiscard]] Vector6 difference(const Pose& T, const Pose& T_from);

/// The pose after such a difference.
[[nodiscard]] Pose moved(const Pose& T, const Vector6& step);

/// Eigenvectors of what two sides agree on, in units of the prior's sigmas.
struct Directions {
  Vector6 information;  ///< of the data over that of the prior, along each; the least first
  Matrix6 axes;
};
[[nodiscard]] Directions directions_of(const Matrix6& agreed, const Vector6& sigmas);

/// The columns along which the data say more than the prior; 6 columns, the others are 0.
[[nodiscard]] Matrix6 held_axes(const Directions& directions);

/// By how much the gradients of parts, which have expectation 0 where a pose fits, differ from what
/// independent residuals would give.
struct Overdispersion {
  double sum = 0;  ///< over held motions, of the variance of their slopes over the information
  int motions = 0;
  [[nodiscard]] double mean() const { return motions > 0 ? sum / motions : 0.0; }
};
/// Adds that of one pose, whose parts' gradients and whole information these are; `held` are
/// held_axes().
void add_overdispersion(Overdispersion& sum, std::span<const Vector6> gradients,
                        const Matrix6& information, const Matrix6& held, const Vector6& sigmas);

/// By how much the variance of what was reported differs from the prior's, at most 1 and at least
/// 1e-4: the share s under which the motions that the data ask for are the likeliest, which
/// maximises Σ log N(x; 0, s + v) over the axes of the information (empirical Bayes, Efron and
/// Morris 1973). x is the motion along an axis, did the prior not hold it, v twice the variance
/// that the information gives it. All in the prior's sigmas: information and gradient of the data
/// where the poses are now, and how far these are from what was reported.
[[nodiscard]] double likeliest_scale(const Eigen::MatrixXd& information,
                                     const Eigen::VectorXd& gradient, const Eigen::VectorXd& away);

}  // namespace viewgain::detail
