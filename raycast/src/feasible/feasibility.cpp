// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/feasibility.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <numeric>
#include <string>
#include <utility>

#include "non_free_voxels.hpp"
#include "obstacle_check.hpp"
#include "oriented_box.hpp"
#include "scene/scene_data.hpp"
#include "trace/scene_tracing.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/shared_rays.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// Whether much of a view is nearer than the sensor can measure. Traces a coarse bundle of rays;
/// counts those that end in the map, and of these those that end within min_range. Immutable;
/// thread safe.
class SightCheck {
 public:
  /// Removes the lens distortion.
  SightCheck(const Sensor& sensor, double max_near_share);

  /// The rotation must be orthonormal. Most views have nothing within min_range, which a look-up of
  /// the blocks there shows. Otherwise traces rays until the answer is clear. Rays end at
  /// obstacles, in single precision.
  [[nodiscard]] bool too_near(const Pose& T_grid_camera, const NonFreeVoxels& voxels,
                              const SceneData& scene) const;

 private:
  /// Neighbouring rays, and a cone around them.
  struct Bundle {
    std::size_t first = 0, count = 0;
    Eigen::Vector3d axis;
    double sine = 0, cosine = 1;
  };
  [[nodiscard]] static Bundle bundle_of(const std::vector<Eigen::Vector3d>& rays, std::size_t first,
                                        std::size_t count);

  double min_range_, max_range_, max_near_share_;
  std::vector<Eigen::Vector3d> rays_;  ///< unit directions in the camera's frame, by bundle
  std::vector<Bundle> bundles_;
  Bundle all_;
};

namespace {

constexpr int kStride = 8;  // between the pixels that are traced
constexpr int kEdge = 4;    // rays per bundle and axis
constexpr std::size_t kAtOnce = TriangleRays::kCount;
static_assert(kEdge * kEdge == kAtOnce);

// Counts of the rays of a view so far.
struct Tally {
  double max_share;
  std::size_t left;  // rays not traced yet
  std::size_t ends = 0, near = 0;

  // Whether too many rays end near, whatever the remaining rays do.
  [[nodiscard]] bool is_too_near() const { return exceeds(ends + left); }
  // Whether too many rays end near if no other ray ends in the map. If this is false and no other
  // ray ends near, the view is not too near.
  [[nodiscard]] bool may_be_too_near() const { return exceeds(ends); }

 private:
  [[nodiscard]] bool exceeds(std::size_t of) const {
    return static_cast<double>(near) > max_share * static_cast<double>(of);
  }
};

}  // namespace

SightCheck::SightCheck(const Sensor& sensor, double max_near_share)
    : min_range_(sensor.min_range), max_range_(sensor.max_range), max_near_share_(max_near_share) {
  const PinholeCamera& camera = sensor.camera;
  const auto shared = shared_rays(camera);
  const std::vector<Eigen::Vector3d>& table = *shared;
  constexpr int kStep = kStride * kEdge;
  for (int v0 = 0; v0 < camera.height; v0 += kStep) {
    for (int u0 = 0; u0 < camera.width; u0 += kStep) {
      const std::size_t first = rays_.size();
      for (int v = v0; v < std::min(v0 + kStep, camera.height); v += kStride) {
        for (int u = u0; u < std::min(u0 + kStep, camera.width); u += kStride) {
          const Eigen::Vector3d ray =
              table[static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.width) +
                    static_cast<std::size_t>(u)]
                  .normalized();
          // A pixel that the distortion model cannot invert has no ray.
          if (ray.allFinite()) rays_.push_back(ray);
        }
      }
      if (rays_.size() > first) bundles_.push_back(bundle_of(rays_, first, rays_.size() - first));
    }
  }
  all_ = bundle_of(rays_, 0, rays_.size());
}

SightCheck::Bundle SightCheck::bundle_of(const std::vector<Eigen::Vector3d>& rays,
                                         std::size_t first, std::size_t count) {
  Bundle bundle{first, count, Eigen::Vector3d::UnitZ()};
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = first; i < first + count; ++i) sum += rays[i];
  if (sum.norm() > 0) bundle.axis = sum.normalized();
  for (std::size_t i = first; i < first + count; ++i) {
    bundle.cosine = std::min(bundle.cosine, bundle.axis.dot(rays[i]));
  }
  bundle.cosine -= 1e-9;  // for rounding
  bundle.sine = std::sqrt(std::max(0.0, 1.0 - bundle.cosine * bundle.cosine));
  return bundle;
}

bool SightCheck::too_near(const Pose& T_grid_camera, const NonFreeVoxels& voxels,
                          const SceneData& scene) const {
  const double voxel_size = scene.snapshot.voxel_size;
  const Eigen::Matrix3d R_grid_camera = T_grid_camera.rotation();
  const Eigen::Vector3d tip = T_grid_camera.translation() / voxel_size;
  const double near_end = min_range_ / voxel_size, far_end = max_range_ / voxel_size;

  const auto may_be_near = [&](const Bundle& bundle) {
    const Eigen::Vector3d axis = R_grid_camera * bundle.axis;
    // The points of the cone within min_range lie between the tip and the cap at its end.
    const Eigen::Vector3d middle = tip + near_end * axis;
    const double radius = near_end * std::sqrt(std::max(0.0, 2.0 - 2.0 * bundle.cosine));
    Box range;
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      range.min[i] = std::min(tip[k], middle[k] - radius);
      range.max[i] = std::max(tip[k], middle[k] + radius);
    }
    return voxels.may_meet({tip, axis, bundle.sine, bundle.cosine}, range);
  };
  if (!may_be_near(all_)) return false;

  // Counts the rays, at most kAtOnce, that end between `begin` and `end`; visits the others.
  Tally tally{max_near_share_, rays_.size()};
  const Index3& base = scene.snapshot.min_index;
  const Eigen::Vector3f tip_scene = (tip - Eigen::Vector3d(base.x, base.y, base.z)).cast<float>();
  const auto count = [&](std::span<const std::size_t> rays, double begin, double end,
                         const auto& visit) {
    TriangleRays packet;
    std::uint32_t ended = 0, is_near = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Eigen::Vector3d direction = R_grid_camera * rays_[rays[i]];
      const double t = voxels.first_along(HalfLine(tip, direction), begin, end);
      if (!(t <= end)) {
        visit(rays[i]);
        continue;
      }
      ended |= 1U << i;
      is_near |= (t < near_end ? 1U : 0U) << i;
      packet.ox[i] = tip_scene.x(), packet.oy[i] = tip_scene.y(), packet.oz[i] = tip_scene.z();
      packet.dx[i] = static_cast<float>(direction.x());
      packet.dy[i] = static_cast<float>(direction.y());
      packet.dz[i] = static_cast<float>(direction.z());
      packet.far[i] = static_cast<float>(t);
    }
    tally.left -= static_cast<std::size_t>(std::popcount(ended));
    if (scene.has_obstacles && ended != 0) {
      ended &= ~scene.tracing->obstacles->triangles().block(packet, ended);
    }
    tally.ends += static_cast<std::size_t>(std::popcount(ended));
    tally.near += static_cast<std::size_t>(std::popcount(ended & is_near));
  };
  std::vector<std::size_t> farther;  // rays that do not end near
  for (const Bundle& bundle : bundles_) {
    std::array<std::size_t, kAtOnce> rays{};
    const auto own = std::span(rays).first(bundle.count);
    std::iota(own.begin(), own.end(), bundle.first);
    if (!may_be_near(bundle)) {
      farther.insert(farther.end(), own.begin(), own.end());
      continue;
    }
    count(own, 0, near_end, [&](std::size_t ray) { farther.push_back(ray); });
    if (tally.is_too_near()) return true;
  }
  for (std::size_t first = 0; first < farther.size(); first += kAtOnce) {
    if (!tally.may_be_too_near()) return false;
    const auto some = std::span(farther).subspan(first, std::min(kAtOnce, farther.size() - first));
    count(some, near_end, far_end, [&](std::size_t) { --tally.left; });
    if (tally.is_too_near()) return true;
  }
  return tally.may_be_too_near();
}

}  // namespace viewgain::detail

namespace viewgain {
namespace {

using detail::OrientedBox;

constexpr double kTouch = 1e-9;           // smaller overlaps count as touching [m]
constexpr std::size_t kPosesAtOnce = 16;  // per task of a thread

[[noreturn]] void fail(const std::string& what) { refuse("feasibility: " + what); }

void check(const std::shared_ptr<const VoxelScene>& scene, const FeasibilityConfig& config) {
  if (scene == nullptr) fail("the scene is null");
  for (const double size : config.body.size) {
    if (!(std::isfinite(size) && size > 0)) {
      fail("the body's size must be positive and finite, not " + short_text(size));
    }
  }
  if (config.body.T_flange_camera && !rigid_pose(*config.body.T_flange_camera)) {
    fail("T_flange_camera is not a rigid transform");
  }
  if (!(std::isfinite(config.clearance) && config.clearance >= 0)) {
    fail("the clearance must be at least 0 and finite, not " + short_text(config.clearance));
  }
  const ReachRegion::Tolerance& taken = config.taken_tolerance;
  if (!(std::isfinite(taken.distance) && taken.distance >= 0 && std::isfinite(taken.angle) &&
        taken.angle >= 0)) {
    fail("the tolerance around taken views must be at least 0 and finite");
  }
  config.reach.validate();
  if (config.sensor) config.sensor->validate();
  if (!(config.max_near_share >= 0 && config.max_near_share <= 1)) {
    fail("the share of near rays must be in 0..1, not " + short_text(config.max_near_share));
  }
}

}  // namespace

std::string_view infeasibility_name(Infeasibility reason) {
  constexpr std::array<std::string_view, 8> kNames{"none",  "bad_pose", "unreachable", "taken",
                                                   "plane", "obstacle", "collision",   "too_near"};
  return kNames[std::min<std::size_t>(static_cast<std::size_t>(reason), kNames.size() - 1)];
}

struct FeasibilityChecker::Impl {
  /// Data that do not depend on the scene; shared by the checkers of all scenes.
  struct Settings {
    Settings(FeasibilityConfig config_in, const ExecConfig& exec)
        : config(std::move(config_in)), num_threads(thread_count(exec.num_threads)) {
      const FeasibilityConfig::Body& body = config.body;
      const double depth = body.size[2];
      half = 0.5 * Eigen::Vector3d(body.size[0], body.size[1], depth) +
             Eigen::Vector3d::Constant(config.clearance);
      T_camera_body = Pose(Eigen::Matrix3d::Identity(), {0, 0, -0.5 * depth});
      if (body.T_flange_camera) {
        T_camera_body = rigid_pose(*body.T_flange_camera)->inverse() *
                        Pose(Eigen::Matrix3d::Identity(), {0, 0, 0.5 * depth});
      }
      if (config.sensor && config.sensor->min_range > 0) {
        sight.emplace(*config.sensor, config.max_near_share);
      }
    }

    [[nodiscard]] ThreadPool& pool() const {
      std::call_once(pool_once, [this] { pool_made.emplace(num_threads); });
      return *pool_made;
    }

    FeasibilityConfig config;
    int num_threads;
    Eigen::Vector3d half;
    Pose T_camera_body;  ///< the origin of the body's frame is its middle
    std::optional<detail::SightCheck> sight;
    mutable std::once_flag pool_once;
    mutable std::optional<ThreadPool> pool_made;
  };

  Impl(std::shared_ptr<const VoxelScene> scene_in, std::shared_ptr<const Settings> settings_in,
       std::shared_ptr<const detail::ObstacleCheck> obstacles_in)
      : scene(std::move(scene_in)),
        settings(std::move(settings_in)),
        obstacles(std::move(obstacles_in)),
        voxels(scene->snapshot()),
        T_grid_world(scene->snapshot().T_world_grid.inverse()) {}

  [[nodiscard]] bool meets_plane(const Pose& T_world_body, const Eigen::Vector3d& camera) const {
    const std::optional<double>& plane = scene->surroundings().support_plane;
    if (!plane) return false;
    const double below = T_world_body.rotation().row(2).cwiseAbs().dot(settings->half);
    return std::min(T_world_body.translation().z() - below, camera.z()) <= *plane + kTouch;
  }

  [[nodiscard]] bool meets_obstacle(const Pose& T_world_body, const Eigen::Vector3d& camera) const {
    if (obstacles->is_empty()) return false;
    const Eigen::Vector3d center = T_world_body.translation();
    return obstacles->overlaps(OrientedBox(center, T_world_body.rotation(), settings->half, kTouch),
                               center) ||
           obstacles->enclose(camera, kTouch);
  }

  [[nodiscard]] bool meets_voxel(const Pose& T_world_body, const Eigen::Vector3d& camera) const {
    const double per_voxel = 1.0 / scene->snapshot().voxel_size;
    const Pose T_grid_body = T_grid_world * T_world_body;
    const OrientedBox body(T_grid_body.translation() * per_voxel, T_grid_body.rotation(),
                           settings->half * per_voxel, kTouch * per_voxel);
    return voxels.overlap(body) ||
           voxels.enclose((T_grid_world * camera) * per_voxel, kTouch * per_voxel);
  }

  [[nodiscard]] Infeasibility check(const Pose& T_world_camera, std::span<const Pose> taken) const {
    const std::optional<Pose> T_rigid = rigid_pose(T_world_camera);
    if (!T_rigid) return Infeasibility::bad_pose;
    const FeasibilityConfig& config = settings->config;
    if (!config.reach.contains(T_world_camera)) return Infeasibility::unreachable;
    if (is_among(T_world_camera, taken, config.taken_tolerance)) return Infeasibility::taken;

    const Eigen::Vector3d camera = T_world_camera.translation();
    const Pose T_world_body = *T_rigid * settings->T_camera_body;
    if (meets_plane(T_world_body, camera)) return Infeasibility::plane;
    if (meets_obstacle(T_world_body, camera)) return Infeasibility::obstacle;
    if (meets_voxel(T_world_body, camera)) return Infeasibility::collision;
    if (settings->sight && settings->sight->too_near(T_grid_world * *T_rigid, voxels,
                                                     detail::SceneAccess::data(*scene))) {
      return Infeasibility::too_near;
    }
    return Infeasibility::none;
  }

  std::shared_ptr<const VoxelScene> scene;
  std::shared_ptr<const Settings> settings;
  std::shared_ptr<const detail::ObstacleCheck> obstacles;
  detail::NonFreeVoxels voxels;
  Pose T_grid_world;
};

FeasibilityChecker::FeasibilityChecker(std::shared_ptr<const VoxelScene> scene,
                                       const FeasibilityConfig& config, const ExecConfig& exec) {
  ::viewgain::check(scene, config);
  auto obstacles = std::make_shared<const detail::ObstacleCheck>(scene->surroundings().obstacles);
  impl_ = std::make_unique<Impl>(
      std::move(scene), std::make_shared<const Impl::Settings>(config, exec), std::move(obstacles));
}

FeasibilityChecker::FeasibilityChecker(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FeasibilityChecker::~FeasibilityChecker() = default;
FeasibilityChecker::FeasibilityChecker(FeasibilityChecker&&) noexcept = default;
FeasibilityChecker& FeasibilityChecker::operator=(FeasibilityChecker&&) noexcept = default;

FeasibilityChecker FeasibilityChecker::with_scene(std::shared_ptr<const VoxelScene> scene) const {
  if (scene == nullptr) fail("the scene is null");
  auto obstacles = impl_->obstacles;
  if (&scene->surroundings() != &impl_->scene->surroundings()) {
    obstacles = std::make_shared<const detail::ObstacleCheck>(scene->surroundings().obstacles);
  }
  return FeasibilityChecker(
      std::make_unique<Impl>(std::move(scene), impl_->settings, std::move(obstacles)));
}

Infeasibility FeasibilityChecker::check(const Pose& T_world_camera,
                                        std::span<const Pose> taken) const {
  return impl_->check(T_world_camera, taken);
}

std::vector<Infeasibility> FeasibilityChecker::check(std::span<const Pose> T_world_camera,
                                                     std::span<const Pose> taken) const {
  // Sorted by x, so that each pose is compared only with views nearby. A map can have ten thousand
  // views.
  const double reach = impl_->settings->config.taken_tolerance.distance;
  const auto x_of = [](const Pose& pose) { return pose.translation().x(); };
  std::vector<Pose> by_x(taken.begin(), taken.end());
  std::erase_if(by_x, [&](const Pose& pose) { return !std::isfinite(x_of(pose)); });
  std::ranges::sort(by_x, {}, x_of);
  const auto near = [&](const Pose& pose) {
    const double x = x_of(pose), slack = reach + 1e-9 * (1 + std::abs(x));  // for rounding
    const auto begin = std::ranges::lower_bound(by_x, x - slack, {}, x_of);
    return std::span(begin, std::ranges::upper_bound(begin, by_x.end(), x + slack, {}, x_of));
  };
  std::vector<Infeasibility> results(T_world_camera.size());
  impl_->settings->pool().for_each_chunk(
      results.size(), kPosesAtOnce, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          results[i] = impl_->check(T_world_camera[i], near(T_world_camera[i]));
        }
      });
  return results;
}

const VoxelScene& FeasibilityChecker::scene() const noexcept { return *impl_->scene; }

}  // namespace viewgain
