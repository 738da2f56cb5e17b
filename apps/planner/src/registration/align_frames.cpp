// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/align_frames.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "registration/joint_registration.hpp"
#include "registration/map_view.hpp"
#include "registration/registration_readings.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/jump_edge_filter.hpp"
#include "viewgain/core/noise.hpp"
#include "viewgain/grid/pooling.hpp"
#include "viewgain/raycast/obstacle_view.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain {
namespace {

using detail::JointRegistration;
using detail::RegistrationView;

// Lengths. Single readings as FusedPointsConfig::normal_radius: noisier normals would hold what
// slides.
constexpr double kSmoothedRadius = 4, kSingleRadius = 5;
// Smoothed neighbours share most of their surroundings: more say hardly more, and take longer.
constexpr std::size_t kSmoothedReadings = 6'000, kSingleReadings = 20'000;

void check(const Pose& T_reported, const PoseSigma& sigma) {
  const auto fail = [](const std::string& what) {
    throw Error(ErrorCode::invalid_argument, "registration: " + what);
  };
  if (!rigid_pose(T_reported)) {
    fail("the reported pose is not a rigid transform of finite numbers");
  }
  for (const auto& [name, value] : {std::pair("sigma_translation", sigma.translation),
                                    std::pair("sigma_rotation", sigma.rotation)}) {
    if (value > 0 && std::isfinite(value)) continue;
    fail(std::string(name) + " " + short_text(value) + " must be positive and finite");
  }
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

struct FrameAlignment::Impl {
  // Of the frames that were added.
  struct Added {
    BeliefGrid layout;
    double length;  // [m]
    JointRegistration frames;
  };

  Sensor sensor;
  GridConfig grid;
  std::optional<double> support_plane;
  std::optional<JumpEdgeFilter> filter;
  ObstacleView obstacles;
  ExecConfig exec;
  std::vector<Eigen::Vector3d> rays;
  mutable ThreadPool pool;
  std::optional<Added> added;

  Impl(const Sensor& s, const MapModelConfig& map, const ExecConfig& e)
      : sensor(s),
        grid(map.grid),
        support_plane(map.surroundings.support_plane),
        obstacles(map.surroundings.obstacles, s, e),
        exec(e),
        rays(s.camera.ray_table()),
        pool(e.num_threads) {
    if (map.jump_edges) filter.emplace(s.camera, *map.jump_edges);
  }

  [[nodiscard]] bool is_on_plane(const Eigen::Vector3d& point, const Eigen::Vector3d& sight) const {
    const double range = sight.norm();
    return support_plane &&
           is_of_plane(point.z() - *support_plane, sight.z() / range, sensor.sigmas(range));
  }

  // Of a frame as a map with this workspace takes it.
  [[nodiscard]] RegistrationView view_of(DepthFrame frame, const Pose& T_world_camera,
                                         const BeliefGrid& layout, double length,
                                         bool is_smoothed) const {
    if (filter) filter->apply(frame);
    obstacles.mark(frame, T_world_camera);
    // What does not count is not to thin out the rest.
    DepthFrame inside = frame;
    const Eigen::Matrix3d R = T_world_camera.rotation();
    pool.for_each_chunk(inside.depth.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const double z = static_cast<double>(inside.depth[i]);
        if (!(z > 0) || !std::isfinite(z) || !rays[i].allFinite()) continue;
        const Eigen::Vector3d sight = R * (z * rays[i]);
        const Eigen::Vector3d point = sight + T_world_camera.translation();
        if (!layout.index_of(point) || is_on_plane(point, sight)) {
          inside.depth[i] = DepthFrame::kInvalid;
        }
      }
    });
    return detail::view_of(
        frame, sensor.camera,
        detail::readings_of(inside, sensor, rays,
                            (is_smoothed ? kSmoothedRadius : kSingleRadius) * length, is_smoothed,
                            is_smoothed ? kSmoothedReadings : kSingleReadings, pool));
  }
};

FrameAlignment::FrameAlignment(const Sensor& sensor, const MapModelConfig& map,
                               const ExecConfig& exec) {
  sensor.validate();
  impl_ = std::make_unique<Impl>(sensor, map, exec);
}
FrameAlignment::~FrameAlignment() = default;
FrameAlignment::FrameAlignment(FrameAlignment&&) noexcept = default;
FrameAlignment& FrameAlignment::operator=(FrameAlignment&&) noexcept = default;

const FrameRegistration& FrameAlignment::add(DepthFrame frame, const Pose& T_reported,
                                             const PoseSigma& sigma) {
  Impl& m = *impl_;
  check_frame_size(frame, m.sensor.camera);
  check(T_reported, sigma);
  if (!m.added) {
    BeliefGrid layout(m.grid);
    const double length =
        std::max(m.grid.voxel_size, m.sensor.sigmas(m.sensor.working_distance).lateral);
    m.added.emplace(Impl::Added{std::move(layout), length, {length, "another frame", m.pool}});
  }
  const Pose T = orthonormalized(T_reported);
  JointRegistration& frames = m.added->frames;
  RegistrationView view = m.view_of(std::move(frame), T, m.added->layout, m.added->length, true);
  if (frames.results().empty()) {
    frames.add_fixed(std::move(view), T);
  } else {
    frames.add(std::move(view), T, sigma);
  }
  return frames.results().back();
}

const std::vector<FrameRegistration>& FrameAlignment::registrations() const {
  static const std::vector<FrameRegistration> kNone;
  return impl_->added ? impl_->added->frames.results() : kNone;
}

FrameRegistration FrameAlignment::register_frame(const BeliefGrid& grid, DepthFrame frame,
                                                 const Pose& T_reported,
                                                 const PoseSigma& sigma) const {
  const Impl& m = *impl_;
  check_frame_size(frame, m.sensor.camera);
  check(T_reported, sigma);
  const Pose T = orthonormalized(T_reported);
  const double length = pooling_of(grid.snapshot()).length;
  // The means that a map's points are are not smoothed either.
  RegistrationView view = m.view_of(std::move(frame), T, grid, length, false);
  JointRegistration frames(length, "the map", m.pool);
  RegistrationView map = detail::map_view(grid, length, m.sensor, view, T, sigma, m.exec);
  const bool is_first = map.readings.empty() && grid.views().empty();
  const bool shows_nothing = view.readings.empty();
  frames.add_fixed(std::move(map), T);
  frames.add(std::move(view), T, sigma);
  FrameRegistration result = frames.results().back();
  if (shows_nothing) result.reason = "the frame shows no surface in the workspace";
  if (is_first) result.reason = "the map has no surface yet", result.covariance = {};
  return result;
}

}  // namespace viewgain
