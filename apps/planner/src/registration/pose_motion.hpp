// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "registration/registration_pairs.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/planner/register_frame.hpp"

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

/// Throws Error(invalid_argument), naming the value, unless all of it is in its range.
void check(const RegistrationConfig& config);
/// The same for the sigmas, and for a pose that is not rigid (1e-3).
void check(const PosePrior& prior);

/// Prior's sigmas of the six parts of a difference.
[[nodiscard]] Vector6 sigmas_of(const PosePrior& prior);

/// Sets status and reason by the figures of the result. `what` is what the readings were held
/// against, `against` how many of them contradict it, of which the contradiction follows.
void judge(FrameRegistration& result, std::size_t against, const RegistrationConfig& config,
           const Vector6& sigmas, const char* what);

}  // namespace viewgain::detail
