// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/align_frames.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "registration/joint_registration.hpp"
#include "registration/registration_view.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/jump_edge_filter.hpp"
#include "viewgain/core/noise.hpp"
#include "viewgain/grid/fused_points.hpp"
#include "viewgain/raycast/obstacle_view.hpp"
#include "viewgain/support/shared_rays.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/support/thread_pool.hpp"

// The method of FrameAlignment.
//
// It minimises, over the poses T_i of all frames that move and a rim width b,
//   Σ_ij Σ_k w ρ(e) / c + Σ_i |T_i ⊖ T_i,reported|² / (s σ²) + (b - 0.03)² / 0.03².
// e = nᵀ(T_i s - T_j m) is the distance of reading s of frame i from the reading m of frame j into
// whose pixel it projects, along the mean n of both normals (symmetric distance: Rusinkiewicz, ACM
// Trans. Graphics 38(4), 2019), or from a map. 1/w is the sum of both variances along the normals;
// ρ is Cauchy's function of e² over the variance. Gates on distance and on the angle of normals
// select the pairs; they start at the uncertainty of the reports. Gauss-Newton uses every 4th, then
// 2nd, then every selected pixel of a row.
//
// Readings are smoothed by planes through the surrounding 5x5 pixels. Single readings, with five
// times the noise, push frames apart: 12 views of the camel by 7 mm. A pixel also sees surface
// beside its ray, so rims seem wider than they are: s and m are moved back along their normals by b
// lateral sigmas for each of the 25 pixels past a rim. Readings of a map are its fused_points(),
// rendered into the image; the readings of a frame compared with it are single ones.
//
// Errors of neighbours are correlated, so readings carry less information than independent ones.
// c is the squared gradient of single neighbours relative to the noise of their readings, averaged
// over the motions (sandwich estimate, Huber 1967). It is at least 3, because a reading is used in
// several pairs. A map's neighbours are cubes of 10 pooling lengths. A frame's are other frames,
// where it counts 8 times: 0.1 to 0.4 for simulated objects, 9 in a room with a real camera, whose
// systematic errors would otherwise pull frames along.
//
// Random errors of normals would make even a sphere seem to fix a rotation. Therefore information
// is Σ w (J_m J_sᵀ + J_s J_mᵀ) / 2c, with the J of either side's normals, whose errors are
// independent. A motion with less information than the report is free and stays as reported.
//
// s, at most 1, is common to all frames: its most likely value given the corrections (empirical
// Bayes). Poses that are better than their sigmas say then stay in place. Covariances use s = 1.
//
// A frame is refused if it shows surface in free space of the others, or sees past their surface:
// at its best fit or, if that is poorly determined, within a sigma. The others are the frames
// connected to the first frame by a chain of fits. If the reported pose leads to a refused fit,
// twelve poses within 1.5 sigmas are tried.

namespace viewgain::detail {
namespace {

// Columns of radius 1 around points 0.75 to 1 apart: each reading of the map is in about three.
constexpr double kPointsPerReading = 3;
constexpr double kPoseSigmas = 5;  // largest error of the pose
constexpr double kBehind = 10;     // pooling lengths behind the surface that the frame shows
constexpr double kCube = 10;       // pooling lengths

// Largest depth that a frame can see, for all likely poses [m].
class SeenDepths {
 public:
  SeenDepths(const RegistrationView& frame, const Sensor& sensor, const PoseSigma& sigma,
             double nearest)
      : camera_(frame.camera) {
    const double shift = kPoseSigmas * sigma.translation, turn = kPoseSigmas * sigma.rotation;
    tile_ = static_cast<int>(
        std::clamp((shift / nearest + turn) * camera_.fx, 8.0, std::max(8.0, camera_.width / 2.0)));
    columns_ = camera_.width / tile_ + 3;  // one tile beside the image, on each side
    deepest_.assign(static_cast<std::size_t>(columns_ * (camera_.height / tile_ + 3)), 0.0);
    for (std::size_t i = 0; i < frame.depth.size(); ++i) {
      const auto z = static_cast<double>(frame.depth[i]);
      if (!(z > 0) || !std::isfinite(z)) continue;
      const int pixel = static_cast<int>(i);
      double& deepest = deepest_[tile_of(pixel % camera_.width, pixel / camera_.width)];
      deepest = std::max(deepest, z + shift + 2 * turn * z + 4 * sensor.noise_sigmas(z).axial);
    }
  }

  // Largest depth around a pixel of the image.
  [[nodiscard]] double round(const Eigen::Vector2d& pixel) const {
    const std::size_t tile =
        tile_of(static_cast<int>(pixel.x() + 0.5), static_cast<int>(pixel.y() + 0.5));
    double deepest = 0;
    for (const int row : {-columns_, 0, columns_}) {
      const auto middle = deepest_.begin() + static_cast<std::ptrdiff_t>(tile) + row;
      deepest = std::max({deepest, middle[-1], middle[0], middle[1]});
    }
    return deepest;
  }

 private:
  [[nodiscard]] std::size_t tile_of(int u, int v) const {
    return static_cast<std::size_t>((v / tile_ + 1) * columns_ + u / tile_ + 1);
  }

  const PinholeCamera& camera_;
  int tile_, columns_;           // [px], including those beside the image
  std::vector<double> deepest_;  // tile by tile
};

// Number of the cube that contains a point.
class Cubes {
 public:
  explicit Cubes(double edge) : edge_(edge) {}
  std::uint32_t of(const Eigen::Vector3d& point) {
    const Eigen::Array3d cube = (point / edge_).array().floor();
    const auto next = static_cast<std::uint32_t>(numbers_.size());
    return numbers_.try_emplace({cube.x(), cube.y(), cube.z()}, next).first->second;
  }
  [[nodiscard]] std::size_t size() const { return numbers_.size(); }

 private:
  double edge_;
  std::map<std::array<double, 3>, std::uint32_t> numbers_;
};

// Each lattice node gets the nearest of the points that project onto it.
void draw(RegistrationView& view) {
  view.clear_lattice();
  for (std::size_t i = 0; i < view.readings.size(); ++i) {
    const Eigen::Vector3d& point = view.readings[i].point;
    const Eigen::Vector2d node = view.camera.project(point) / view.stride;
    const int column = static_cast<int>(node.x() + 0.5), row = static_cast<int>(node.y() + 0.5);
    if (column >= view.columns() || row >= view.rows()) continue;
    std::int32_t& at = view.at[view.node(column, row)];
    if (at < 0 || point.z() < view.readings[static_cast<std::size_t>(at)].point.z()) {
      at = static_cast<std::int32_t>(i);
    }
  }
}

/// The map's surface that a frame can show: its fused points as the readings of a view from the
/// frame's reported pose, whose uncertainty is `sigma`. `frame` has readings; `length` is the map's
/// pooling length [m]. Keeps a reference to the grid.
RegistrationView map_view(const BeliefGrid& grid, double length, const Sensor& sensor,
                          const RegistrationView& frame, const Pose& T_reported,
                          const PoseSigma& sigma, const ExecConfig& exec) {
  RegistrationView view{frame.camera, {}, 1, {}, {}, &grid, T_reported};
  view.clear_lattice();
  if (frame.readings.empty()) return view;
  double range = 0, nearest = frame.readings.front().point.z();
  for (const Reading& reading : frame.readings) {
    range += reading.point.norm() / static_cast<double>(frame.readings.size());
    nearest = std::min(nearest, reading.point.z());
  }
  const SeenDepths seen(frame, sensor, sigma, nearest);
  const Pose T_camera_world = T_reported.inverse();
  const PinholeCamera& camera = frame.camera;
  FusedPointsConfig config;
  config.where = [&](const Eigen::Vector3d& p_world) {
    const Eigen::Vector3d p = T_camera_world * p_world;
    return camera.sees(p) && p.z() <= seen.round(camera.project(p)) + kBehind * length;
  };
  Cubes cubes(kCube * length);
  const Eigen::Matrix3d R_camera_world = T_camera_world.rotation();
  for (const FusedPoint& fused : fused_points(grid, config, exec)) {
    const Eigen::Vector3d point(fused.position.data()), normal(fused.toward_free.data());
    Reading reading;
    reading.point = T_camera_world * point;
    reading.normal = R_camera_world * normal;
    // Seen from the back, or outside the image.
    if (!(reading.normal.dot(reading.point) < 0) || !camera.sees(reading.point)) continue;
    const double variance = normal.dot(fused.covariance * normal);
    reading.axial = std::sqrt(variance);
    reading.variance = kPointsPerReading * variance;
    reading.part = cubes.of(point);
    view.readings.push_back(reading);
  }
  view.parts = cubes.size();
  view.stride = std::max(1, static_cast<int>(std::lround(length * camera.fx / range)));
  draw(view);
  // All readings of a point share its error.
  const auto drawn = std::count_if(view.at.begin(), view.at.end(), [](auto i) { return i >= 0; });
  const double share = static_cast<double>(frame.readings.size()) /
                       static_cast<double>(std::max<std::ptrdiff_t>(drawn, 1));
  for (Reading& reading : view.readings) reading.variance *= std::max(1.0, share);
  return view;
}

}  // namespace
}  // namespace viewgain::detail

namespace viewgain {
namespace {

using detail::JointRegistration;
using detail::RegistrationView;

// Pooling lengths. Single readings need a radius as FusedPointsConfig::normal_radius: noisier
// normals would seem to fix sliding motions.
constexpr double kSmoothedRadius = 4, kSingleRadius = 5;
// Smoothed neighbours overlap mostly: more of them add little and take longer.
constexpr std::size_t kSmoothedReadings = 6'000, kSingleReadings = 20'000;

void check(const Pose& T_reported, const PoseSigma& sigma) {
  const auto fail = [](const std::string& what) { refuse("registration: " + what); };
  if (!rigid_pose(T_reported)) fail("the reported pose is not a rigid transform of finite numbers");
  for (const auto& [name, value] : {std::pair("sigma_translation", sigma.translation),
                                    std::pair("sigma_rotation", sigma.rotation)}) {
    if (value > 0 && std::isfinite(value)) continue;
    fail(std::string(name) + " must be positive and finite, not " + short_text(value));
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
  // Poses of the added frames.
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
  std::shared_ptr<const std::vector<Eigen::Vector3d>> rays;
  mutable ThreadPool pool;
  std::optional<Added> added;

  Impl(const Sensor& s, const ScorerConfig& map, const ExecConfig& e)
      : sensor(s),
        grid(map.grid()),
        support_plane(map.support_plane),
        obstacles(map.obstacles, s, e),
        exec(e),
        rays(shared_rays(s.camera)),
        pool(e.num_threads) {
    if (map.jump_edges) filter.emplace(s.camera, *map.jump_edges, e);
  }

  [[nodiscard]] bool is_on_plane(const Eigen::Vector3d& point, const Eigen::Vector3d& sight) const {
    const double range = sight.norm();
    return support_plane &&
           is_of_plane(point.z() - *support_plane, sight.z() / range, sensor.sigmas(range));
  }

  // A frame as used in a map with this workspace.
  [[nodiscard]] RegistrationView view_of(DepthFrame frame, const Pose& T_world_camera,
                                         const BeliefGrid& layout, double length,
                                         bool is_smoothed) const {
    if (filter) filter->apply(frame);
    obstacles.mark(frame, T_world_camera);
    // Excluded readings must not thin out the others.
    DepthFrame inside = frame;
    const Eigen::Matrix3d R = T_world_camera.rotation();
    pool.for_each_chunk(inside.depth.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const double z = static_cast<double>(inside.depth[i]);
        if (!(z > 0) || !std::isfinite(z) || !(*rays)[i].allFinite()) continue;
        const Eigen::Vector3d sight = R * (z * (*rays)[i]);
        const Eigen::Vector3d point = sight + T_world_camera.translation();
        if (!layout.index_of(point) || is_on_plane(point, sight)) {
          inside.depth[i] = DepthFrame::kInvalid;
        }
      }
    });
    return detail::view_of(
        frame, sensor.camera,
        detail::readings_of(inside, sensor, *rays,
                            (is_smoothed ? kSmoothedRadius : kSingleRadius) * length, is_smoothed,
                            is_smoothed ? kSmoothedReadings : kSingleReadings, pool));
  }
};

FrameAlignment::FrameAlignment(const Sensor& sensor, const ScorerConfig& map,
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
  // The map's points, which are means, are not smoothed either.
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
