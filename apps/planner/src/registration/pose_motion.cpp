// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "registration/pose_motion.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::detail {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw Error(ErrorCode::invalid_argument, "registration: " + what);
}

void check_positive(const char* name, double value) {
  if (!(value > 0) || !std::isfinite(value)) {
    fail(std::string(name) + " " + short_text(value) + " must be positive and finite");
  }
}

std::string rounded(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

}  // namespace

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

void check(const RegistrationConfig& config) {
  if (config.max_readings < 100) fail("max_readings must be at least 100");
  check_positive("max_normal_angle", config.max_normal_angle);
  check_positive("max_sigmas", config.max_sigmas);
  for (const auto& [name, share] : {std::pair("min_overlap", config.min_overlap),
                                    std::pair("max_contradiction", config.max_contradiction)}) {
    if (!(share >= 0 && share <= 1)) {
      fail(std::string(name) + " " + short_text(share) + " must be in 0..1");
    }
  }
  if (config.support_plane && !std::isfinite(*config.support_plane)) {
    fail("support_plane must be finite");
  }
}

void check(const PosePrior& prior) {
  if (!(orthonormality_error(prior.T_world_camera) <= 1e-3)) {
    fail("the reported pose is not a rigid transform of finite numbers");
  }
  check_positive("sigma_translation", prior.sigma_translation);
  check_positive("sigma_rotation", prior.sigma_rotation);
}

Vector6 sigmas_of(const PosePrior& prior) {
  Vector6 sigmas;
  sigmas << Eigen::Vector3d::Constant(prior.sigma_translation),
      Eigen::Vector3d::Constant(prior.sigma_rotation);
  return sigmas;
}

std::array<double, 36> by_rows(const Matrix6& covariance) {
  std::array<double, 36> rows{};
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 6; ++c) rows[static_cast<std::size_t>(6 * r + c)] = covariance(r, c);
  }
  return rows;
}

Overdispersion overdispersion_of(std::span<const Vector6> gradients, const Matrix6& information,
                                 const Matrix6& held, const Vector6& sigmas) {
  Overdispersion found;
  for (int k = 0; k < 6; ++k) {
    if (held.col(k).isZero()) continue;
    const Vector6 axis = sigmas.asDiagonal() * held.col(k);
    double variance = 0;
    for (const Vector6& gradient : gradients) {
      const double slope = axis.dot(gradient);
      variance += slope * slope;
    }
    found.sum += variance / axis.dot(information * axis);
    ++found.motions;
  }
  return found;
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

// Few readings may by chance all be wrong.
bool contradicts(const Agreement& agreement, std::size_t readings,
                 const RegistrationConfig& config) {
  return agreement.contradiction() > config.max_contradiction &&
         agreement.against > config.min_pairs &&
         static_cast<double>(agreement.against) >
             config.min_overlap * static_cast<double>(readings);
}

void judge(FrameRegistration& result, const Agreement& readings, const Agreement& surface,
           const RegistrationConfig& config, const Vector6& sigmas, const char* what) {
  result.contradiction = std::max(readings.contradiction(), surface.contradiction());
  const double far = config.max_sigmas;
  if (result.translation > far * sigmas[0] || result.rotation > far * sigmas[3]) {
    result.status = RegistrationStatus::refused;
    result.reason = "the correction, " + rounded(1e3 * result.translation) + " mm and " +
                    rounded(result.rotation * 180 / std::numbers::pi) + " deg, is beyond " +
                    rounded(far) + " sigma of the reported pose";
  } else if (contradicts(readings, result.readings, config)) {
    result.status = RegistrationStatus::refused;
    result.reason = rounded(100 * readings.contradiction()) + " % of the readings lie where " +
                    what + " says free, or behind its surface";
  } else if (contradicts(surface, result.readings, config)) {
    result.status = RegistrationStatus::refused;
    result.reason = "the frame looks past " + rounded(100 * surface.contradiction()) +
                    " % of the surface that " + what + " has there";
  } else if (result.overlap < config.min_overlap || result.pairs < config.min_pairs) {
    result.status = RegistrationStatus::too_little_overlap;
    result.reason = std::to_string(result.pairs) + " of " + std::to_string(result.readings) +
                    " readings show surface that " + what + " has";
  } else {
    result.status = RegistrationStatus::registered;
    result.reason.clear();
  }
}

}  // namespace viewgain::detail
