// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/align_frames.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "registration/aligned_view.hpp"
#include "registration/pose_motion.hpp"
#include "registration/registration_pairs.hpp"
#include "registration/registration_readings.hpp"
#include "viewgain/core/noise.hpp"
#include "viewgain/core/thread_pool.hpp"

namespace viewgain {
namespace {

using detail::AlignedView;
using detail::Matrix6;
using detail::PairGates;
using detail::PairSums;
using detail::Reading;
using detail::Vector6;

// Lengths in voxels, or footprints where those are longer.
constexpr double kNormalRadius = 4;
constexpr double kAlongSurface = 2;
constexpr double kRedundancy = 3;
constexpr double kSettled = 0.3;  // slack of frames that were aligned before, in sigmas
constexpr int kMaxIterations = 15;
constexpr double kReach = 3;             // sigmas
constexpr std::size_t kLeastPairs = 20;  // of two frames

// What a motion of the source does, as one of the target: e falls with the motion A of that.
Matrix6 carried(const Pose& T_world_source, const Pose& T_world_target) {
  const Eigen::Vector3d d = T_world_source.translation() - T_world_target.translation();
  Matrix6 A = Matrix6::Identity();
  A.bottomLeftCorner<3, 3>() << 0, -d.z(), d.y(), d.z(), 0, -d.x(), -d.y(), d.x(), 0;
  return A;
}

// What an alignment changes of a view.
struct Motion {
  Pose T;
  double slack = 0;  // by which T may still be off, in sigmas
  int iterations = 0;
};

struct View : Motion {
  View(AlignedView view, const Pose& T_world_camera, const Vector6& prior)
      : Motion{T_world_camera}, seen(std::move(view)), T_reported(T_world_camera), sigmas(prior) {}

  AlignedView seen;
  Pose T_reported;
  Vector6 sigmas;  // of the prior
};

// What one iteration looks at.
struct Pass {
  std::size_t first_movable;
  int level;
  double still;  // a step this short ends it, in sigmas of what a pose is known to
};

}  // namespace

struct FrameAlignment::Impl {
  Sensor sensor;
  BeliefGrid layout;
  RegistrationConfig config;
  double length;  // [m]
  std::vector<Eigen::Vector3d> rays;
  mutable ThreadPool pool;
  std::vector<View> views;

  Impl(const Sensor& s, const BeliefGrid& grid, const RegistrationConfig& c, const ExecConfig& exec)
      : sensor(s),
        layout({grid.voxel_size(), grid.workspace(), grid.T_world_grid(), grid.prior_sigma()}),
        config(c),
        length(std::max(grid.voxel_size(), s.sigmas(s.working_distance).lateral)),
        rays(s.camera.ray_table()),
        pool(exec.num_threads) {}

  [[nodiscard]] PairGates gates_of(const View& view) const {
    return {view.slack * view.sigmas[0], view.slack * view.sigmas[3], kAlongSurface * length,
            std::cos(config.max_normal_angle)};
  }
  [[nodiscard]] std::vector<Reading> readings_of(const DepthFrame& frame, const Pose& T) const;
  [[nodiscard]] bool is_on_plane(const Eigen::Vector3d& point, const Eigen::Vector3d& sight) const {
    const double range = sight.norm();
    return config.support_plane &&
           is_of_plane(point.z() - *config.support_plane, sight.z() / range, sensor.sigmas(range));
  }
  bool move(const Pass& pass);
  void align(const Pass& pass) {
    for (int i = 0; i < kMaxIterations && move(pass); ++i) {
    }
  }
  void align_newest();
  [[nodiscard]] FrameRegistration result_of(std::size_t index) const;
};

std::vector<Reading> FrameAlignment::Impl::readings_of(const DepthFrame& frame,
                                                       const Pose& T_world_camera) const {
  // What does not count is not to thin out the rest.
  DepthFrame inside = frame;
  for (std::size_t i = 0; i < inside.depth.size(); ++i) {
    const double z = static_cast<double>(inside.depth[i]);
    if (!(z > 0) || !std::isfinite(z) || !rays[i].allFinite()) continue;
    const Eigen::Vector3d sight = T_world_camera.rotation() * (z * rays[i]);
    const Eigen::Vector3d point = sight + T_world_camera.translation();
    if (!layout.index_of(point) || is_on_plane(point, sight)) {
      inside.depth[i] = DepthFrame::kInvalid;
    }
  }
  return detail::readings_of(inside, sensor, rays, kNormalRadius * length, true,
                             config.max_readings, pool);
}

// One step of Gauss and Newton; false if it was short.
bool FrameAlignment::Impl::move(const Pass& pass) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t j = 0; j < views.size(); ++j) {
      if (i != j && std::max(i, j) >= pass.first_movable) pairs.emplace_back(i, j);
    }
  }
  std::vector<PairSums> sums(pairs.size());
  pool.for_each_chunk(pairs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const View& source = views[pairs[k].first];
      const View& target = views[pairs[k].second];
      sums[k] = detail::pair_sums(source.seen, source.T, gates_of(source), target.seen, target.T,
                                  gates_of(target), pass.level);
    }
  });

  const auto n = static_cast<Eigen::Index>(6 * views.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(n);
  std::vector<Matrix6> agreed(views.size(), Matrix6::Zero());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const PairSums& s = sums[k];
    if (s.pairs < kLeastPairs) continue;
    const auto [i, j] = pairs[k];
    const Matrix6 A = carried(views[i].T, views[j].T);
    const auto a = static_cast<Eigen::Index>(6 * i), b = static_cast<Eigen::Index>(6 * j);
    information.block<6, 6>(a, a) += s.information;
    information.block<6, 6>(b, b) += A * s.information * A.transpose();
    information.block<6, 6>(a, b) -= s.information * A.transpose();
    information.block<6, 6>(b, a) -= A * s.information;
    gradient.segment<6>(a) += s.gradient;
    gradient.segment<6>(b) -= A * s.gradient;
    agreed[i] += s.agreed;
    agreed[j] += A * s.agreed * A.transpose();
  }
  // In sigmas of the priors, along what the others hold of each frame.
  Eigen::MatrixXd onto = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd away = Eigen::VectorXd::Zero(n);
  for (std::size_t i = pass.first_movable; i < views.size(); ++i) {
    const View& view = views[i];
    const auto a = static_cast<Eigen::Index>(6 * i);
    const Matrix6 held =
        detail::held_axes(detail::directions_of(agreed[i] / kRedundancy, view.sigmas));
    onto.block<6, 6>(a, a) = view.sigmas.asDiagonal() * held * held.transpose();
    away.segment<6>(a) = detail::difference(view.T, view.T_reported).cwiseQuotient(view.sigmas);
  }
  const Eigen::MatrixXd whole =
      onto.transpose() * information * onto / kRedundancy + Eigen::MatrixXd::Identity(n, n);
  const Eigen::VectorXd step =
      whole.llt().solve(-(onto.transpose() * gradient / kRedundancy + away));
  for (std::size_t i = pass.first_movable; i < views.size(); ++i) {
    const Vector6 own = step.segment<6>(static_cast<Eigen::Index>(6 * i));
    views[i].T = detail::moved(views[i].T, own.cwiseProduct(views[i].sigmas));
    ++views[i].iterations;
  }
  return std::sqrt(step.dot(whole * step)) >= pass.still;
}

void FrameAlignment::Impl::align_newest() {
  for (View& view : views) view.slack = kSettled, view.iterations = 0;
  views.front().slack = 0;
  views.back().slack = 1;
  align({views.size() - 1, 0, 0.5});
  views.back().slack = kSettled;
  align({1, 0, 0.2});
  for (View& view : views) view.slack = 0;
  // Neighbouring readings share most of their surroundings: a quarter of them says as much.
  align({1, 1, 0.1});
}

FrameRegistration FrameAlignment::Impl::result_of(std::size_t index) const {
  const View& view = views[index];
  const std::vector<Reading>& readings = view.seen.readings();
  FrameRegistration result;
  result.T_world_camera = view.T;
  result.readings = readings.size();
  result.iterations = view.iterations;
  std::vector<std::uint8_t> is_paired(readings.size(), 0), is_paired_before(readings.size(), 0);
  PairSums after, before;
  for (std::size_t j = 0; j < views.size(); ++j) {
    if (j == index) continue;
    const View& other = views[j];
    const PairGates gates = gates_of(other);
    after += detail::pair_sums(view.seen, view.T, gates, other.seen, other.T, gates,
                               detail::kLevels - 1, &is_paired);
    before += detail::pair_sums(view.seen, view.T_reported, gates, other.seen, other.T, gates,
                                detail::kLevels - 1, &is_paired_before);
  }
  result.residual_before = before.residual();
  result.residual_after = after.residual();
  const detail::Directions directions =
      detail::directions_of(after.agreed / kRedundancy, view.sigmas);
  result.smallest_information = directions.information[0];
  result.pairs =
      static_cast<std::size_t>(std::count(is_paired.begin(), is_paired.end(), std::uint8_t{1}));
  result.overlap = static_cast<double>(result.pairs) /
                   static_cast<double>(std::max<std::size_t>(readings.size(), 1));
  // A frame that the others do not hold may be as far off as its prior says.
  PairGates prior;
  if (result.overlap < config.min_overlap) {
    prior.slack_translation = view.sigmas[0], prior.slack_rotation = view.sigmas[3];
  }
  std::size_t against = 0;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (is_paired[i] != 0) continue;
    const double reach = kReach * std::sqrt(prior.slack_variance(readings[i].point.norm()));
    const double margin = 4 * readings[i].sigmas.axial + kAlongSurface * length;
    const Eigen::Vector3d p_world = view.T * readings[i].point;
    for (std::size_t j = 0; j < views.size(); ++j) {
      if (j == index) continue;
      if (views[j].seen.looks_past(views[j].T.inverse() * p_world, margin + reach, reach)) {
        ++against;
        break;
      }
    }
  }
  const Vector6 correction = detail::difference(view.T, view.T_reported);
  result.translation = correction.head<3>().norm();
  result.rotation = correction.tail<3>().norm();
  for (int k = 0; k < 6; ++k) {
    if (directions.information[k] >= 1) continue;
    const Vector6 motion = view.sigmas.cwiseProduct(directions.axes.col(k));
    result.free_directions.push_back({motion.head<3>(), motion.tail<3>()});
  }
  for (int k = 0; k < 6; ++k) {
    result.covariance[static_cast<std::size_t>(7 * k)] = view.sigmas[k] * view.sigmas[k];
  }
  result.status = RegistrationStatus::registered;
  if (index > 0) detail::judge(result, against, config, view.sigmas, "another frame");
  return result;
}

FrameAlignment::FrameAlignment(const Sensor& sensor, const BeliefGrid& layout,
                               const RegistrationConfig& config, const ExecConfig& exec) {
  sensor.validate();
  detail::check(config);
  impl_ = std::make_unique<Impl>(sensor, layout, config, exec);
}
FrameAlignment::~FrameAlignment() = default;
FrameAlignment::FrameAlignment(FrameAlignment&&) noexcept = default;
FrameAlignment& FrameAlignment::operator=(FrameAlignment&&) noexcept = default;

FrameRegistration FrameAlignment::add(const DepthFrame& frame, const PosePrior& prior) {
  check_frame_size(frame, impl_->sensor.camera);
  detail::check(prior);
  std::vector<View>& views = impl_->views;
  const Pose T = orthonormalized(prior.T_world_camera);
  const std::vector<Motion> before(views.begin(), views.end());
  views.emplace_back(AlignedView(frame, impl_->sensor.camera, impl_->readings_of(frame, T)), T,
                     detail::sigmas_of(prior));
  if (views.size() > 1) impl_->align_newest();
  FrameRegistration result = impl_->result_of(views.size() - 1);
  if (result.status == RegistrationStatus::registered) return result;
  for (std::size_t i = 0; i < before.size(); ++i) static_cast<Motion&>(views[i]) = before[i];
  if (result.status == RegistrationStatus::too_little_overlap) {
    views.back().T = T;
  } else {
    views.pop_back();
  }
  result.T_world_camera = T;
  return result;
}

std::vector<Pose> FrameAlignment::poses() const {
  std::vector<Pose> poses;
  for (const View& view : impl_->views) poses.push_back(view.T);
  return poses;
}

std::vector<FrameRegistration> FrameAlignment::registrations() const {
  std::vector<FrameRegistration> all;
  for (std::size_t i = 0; i < impl_->views.size(); ++i) all.push_back(impl_->result_of(i));
  return all;
}

}  // namespace viewgain
