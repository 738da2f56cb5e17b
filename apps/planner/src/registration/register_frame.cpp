// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/register_frame.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "registration/pose_motion.hpp"
#include "registration/registration_pairs.hpp"
#include "registration/registration_readings.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/noise.hpp"
#include "viewgain/core/thread_pool.hpp"
#include "viewgain/grid/pooling.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

using detail::difference;
using detail::Directions;
using detail::directions_of;
using detail::held_axes;
using detail::judge;
using detail::Matrix6;
using detail::ModelPoint;
using detail::moved;
using detail::PairGates;
using detail::PairSums;
using detail::Reading;
using detail::Vector6;

// Lengths in pooling lengths.
constexpr double kPointNormalRadius = 5;  // as FusedPointsConfig::normal_radius
constexpr double kAlongSurface = 2;
constexpr double kCube = 10;
// What all points of the map share does not show in residuals. Measured: squared errors of poses
// are 2.8 to 3.9 times those of independent errors.
constexpr double kLeastWidening = 3;
constexpr std::array<double, detail::kLevels> kSlack{1.0, 0.3, 0.0};  // of the prior's sigmas
constexpr int kMaxIterations = 15;                                    // of a level
// A step this short ends a level, in sigmas of what the pose is known to.
constexpr std::array<double, detail::kLevels> kStill{0.5, 0.2, 0.05};

// How much more residuals say of the pose than is true, along what is held: neighbours' errors are
// alike, see FrameRegistration::covariance.
double alikeness_of(const PairSums& sums, const std::vector<Vector6>& cubes,
                    const Vector6& sigmas) {
  const Matrix6 held = held_axes(directions_of(sums.agreed, sigmas));
  return detail::overdispersion_of(cubes, sums.information, held, sigmas).mean();
}

// What Gauss and Newton solve, in the prior's sigmas, along the motions that the frame holds.
class Problem {
 public:
  Problem(const Pose& T_reported, const Vector6& sigmas)
      : T_reported_(T_reported), sigmas_(sigmas) {}

  // A step; false if it was shorter than `still`, in sigmas of what the pose is known to.
  bool move(Pose& T, const PairSums& sums, double still) const {
    const Terms terms = terms_of(T, sums);
    const Matrix6 whole = terms.information + Matrix6::Identity() / scale_;
    const Vector6 step = whole.llt().solve(-(terms.gradient + terms.away / scale_));
    T = moved(T, sigmas_.asDiagonal() * step);
    return std::sqrt(step.dot(whole * step)) >= still;
  }

  // What is known only where the frame fits: how alike errors are, and how far poses may be off.
  void estimate(const Pose& T, const PairSums& sums, const std::vector<Vector6>& cubes) {
    alikeness_ = std::max(1.0, alikeness_of(sums, cubes, sigmas_));
    const Terms terms = terms_of(T, sums);
    const double more = widening() / alikeness_;
    scale_ = detail::likeliest_scale(terms.information / more, terms.gradient / more, terms.away);
  }

  [[nodiscard]] Matrix6 covariance(const PairSums& sums) const {
    const Matrix6 whole =
        terms_of(T_reported_, sums).information * (alikeness_ / widening()) + Matrix6::Identity();
    const Matrix6 scaled = whole.llt().solve(Matrix6::Identity());
    return sigmas_.asDiagonal() * scaled * sigmas_.asDiagonal();
  }

 private:
  [[nodiscard]] double widening() const { return std::max(kLeastWidening, alikeness_); }
  struct Terms {
    Matrix6 information;
    Vector6 gradient, away;
  };
  [[nodiscard]] Terms terms_of(const Pose& T, const PairSums& sums) const {
    const Matrix6 held = held_axes(directions_of(sums.agreed, sigmas_));
    const Matrix6 onto = held * held.transpose() * sigmas_.asDiagonal();
    return {onto * sums.information * onto.transpose() / alikeness_,
            onto * sums.gradient / alikeness_, difference(T, T_reported_).cwiseQuotient(sigmas_)};
  }

  Pose T_reported_;
  Vector6 sigmas_;
  double scale_ = 1;      // of the prior's variances
  double alikeness_ = 1;  // by which residuals count less
};

double median_range(const std::vector<Reading>& readings) {
  std::vector<double> ranges;
  ranges.reserve(readings.size());
  for (const Reading& reading : readings) ranges.push_back(reading.point.norm());
  const auto middle = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() / 2);
  std::nth_element(ranges.begin(), middle, ranges.end());
  return *middle;
}

}  // namespace

std::string_view registration_status_name(RegistrationStatus status) {
  switch (status) {
    case RegistrationStatus::registered:
      return "registered";
    case RegistrationStatus::too_little_overlap:
      return "too_little_overlap";
    case RegistrationStatus::refused:
      return "refused";
  }
  return "unknown";
}

PoseSigma FrameRegistration::pose_sigma() const {
  const auto of_axes = [&](std::size_t first) {
    double variance = 0;
    for (std::size_t k = first; k < first + 3; ++k) variance += covariance[7 * k];
    return std::sqrt(std::max(variance, 0.0) / 3);
  };
  return {of_axes(0), of_axes(3)};
}

struct FrameRegistrar::Impl {
  Sensor sensor;
  RegistrationConfig config;
  std::vector<Eigen::Vector3d> rays;
  mutable ThreadPool pool;

  Impl(const Sensor& s, const RegistrationConfig& c, const ExecConfig& exec)
      : sensor(s), config(c), rays(s.camera.ray_table()), pool(exec.num_threads) {}

  [[nodiscard]] bool is_of_map(const Reading& reading, const BeliefGrid& grid,
                               const Pose& T_world_camera) const {
    const Eigen::Vector3d sight = T_world_camera.rotation() * reading.point;
    const Eigen::Vector3d point = sight + T_world_camera.translation();
    if (!grid.index_of(point)) return false;
    return !config.support_plane || !is_of_plane(point.z() - *config.support_plane,
                                                 sight.z() / sight.norm(), reading.sigmas);
  }

  // In the grid: free where the reading is, and as far as it may be off along its ray.
  [[nodiscard]] static bool is_in_free_space(const Reading& reading, const BeliefGrid& grid,
                                             const Pose& T_world_camera, double margin) {
    const double range = reading.point.norm();
    for (const double shift : {-margin, 0.0, margin}) {
      const auto voxel =
          grid.index_of(T_world_camera * Eigen::Vector3d(reading.point * (1 + shift / range)));
      if (!voxel || grid.state(*voxel) != VoxelState::free) return false;
    }
    return true;
  }

  FrameRegistration run(const BeliefGrid& grid, std::span<const FusedPoint> points,
                        const DepthFrame& frame, const PosePrior& prior) const;
};

FrameRegistration FrameRegistrar::Impl::run(const BeliefGrid& grid,
                                            std::span<const FusedPoint> points,
                                            const DepthFrame& frame, const PosePrior& prior) const {
  const Pose T_reported = orthonormalized(prior.T_world_camera);
  const Vector6 sigmas = detail::sigmas_of(prior);
  FrameRegistration result;
  result.T_world_camera = T_reported;
  result.covariance = detail::by_rows(sigmas.cwiseAbs2().asDiagonal());
  if (points.empty()) {
    result.reason = "the map has no surface yet";
    if (grid.views().empty()) result.covariance = {};
    return result;
  }
  const double length = pooling_of(grid.snapshot()).length;
  std::vector<Reading> readings = detail::readings_of(
      frame, sensor, rays, kPointNormalRadius * length, false, config.max_readings, pool);
  std::erase_if(readings, [&](const Reading& r) { return !is_of_map(r, grid, T_reported); });
  result.readings = readings.size();
  if (readings.empty()) {
    result.reason = "the frame shows no surface in the workspace";
    return result;
  }
  const detail::RegistrationModel model = detail::registration_model(points, kCube * length);
  detail::RegistrationPairs pairs(model, readings, sensor.camera, length, median_range(readings),
                                  pool);

  Pose T = T_reported;
  PairGates gates;
  gates.along_surface = kAlongSurface * length;
  gates.min_cosine = std::cos(config.max_normal_angle);
  Problem problem{T_reported, sigmas};
  const auto align = [&](int level) {
    const auto l = static_cast<std::size_t>(level);
    gates.slack_translation = kSlack[l] * prior.sigma_translation;
    gates.slack_rotation = kSlack[l] * prior.sigma_rotation;
    bool is_moving = true;
    for (int i = 0; i < kMaxIterations && is_moving; ++i) {
      pairs.find(T, level, gates);
      is_moving = problem.move(T, pairs.sums(T), kStill[l]);
      ++result.iterations;
    }
  };
  for (int level = 0; level < detail::kLevels; ++level) align(level);
  pairs.find(T, detail::kLevels - 1, gates);
  problem.estimate(T, pairs.sums(T), pairs.sums_by_cube(T));
  align(detail::kLevels - 1);

  pairs.find(T, detail::kLevels - 1, gates);
  const PairSums sums = pairs.sums(T);
  const Directions directions = directions_of(sums.agreed, sigmas);
  const Matrix6 held = held_axes(directions);
  result.pairs = sums.pairs;
  result.overlap = static_cast<double>(sums.pairs) / static_cast<double>(readings.size());
  result.residual_before = pairs.sums(T_reported).residual();
  result.residual_after = sums.residual();
  result.smallest_information = directions.information[0];
  for (int k = 0; k < 6; ++k) {
    if (!held.col(k).isZero()) continue;
    const Vector6 motion = sigmas.asDiagonal() * directions.axes.col(k);
    result.free_directions.push_back({motion.head<3>(), motion.tail<3>()});
  }
  std::size_t against = 0;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (pairs.targets()[i] >= 0) continue;
    const double margin = 4 * readings[i].sigmas.axial + kAlongSurface * length;
    if (is_in_free_space(readings[i], grid, T, margin) ||
        pairs.is_behind_surface(readings[i], margin)) {
      ++against;
    }
  }
  const Vector6 correction = difference(T, T_reported);
  result.translation = correction.head<3>().norm();
  result.rotation = correction.tail<3>().norm();
  judge(result, {result.pairs, against}, {}, config, sigmas, "the map");
  if (result.status == RegistrationStatus::registered) {
    result.T_world_camera = T;
    result.covariance = detail::by_rows(problem.covariance(sums));
  }
  return result;
}

FrameRegistrar::FrameRegistrar(const Sensor& sensor, const RegistrationConfig& config,
                               const ExecConfig& exec) {
  sensor.validate();
  detail::check(config);
  impl_ = std::make_unique<Impl>(sensor, config, exec);
}
FrameRegistrar::~FrameRegistrar() = default;
FrameRegistrar::FrameRegistrar(FrameRegistrar&&) noexcept = default;
FrameRegistrar& FrameRegistrar::operator=(FrameRegistrar&&) noexcept = default;

FrameRegistration FrameRegistrar::register_frame(const BeliefGrid& grid,
                                                 std::span<const FusedPoint> points,
                                                 const DepthFrame& frame,
                                                 const PosePrior& prior) const {
  check_frame_size(frame, impl_->sensor.camera);
  detail::check(prior);
  return impl_->run(grid, points, frame, prior);
}

}  // namespace viewgain
