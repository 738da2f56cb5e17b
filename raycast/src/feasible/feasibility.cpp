// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/feasibility.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "non_free_voxels.hpp"
#include "obstacle_check.hpp"
#include "oriented_box.hpp"
#include "scene/scene_data.hpp"
#include "sight_check.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain {
namespace {

using detail::OrientedBox;

constexpr double kTouch = 1e-9;           // smaller overlaps are touching [m]
constexpr std::size_t kPosesAtOnce = 16;  // that a thread takes

[[noreturn]] void fail(const std::string& what) {
  throw Error(ErrorCode::invalid_argument, "feasibility: " + what);
}

void check(const std::shared_ptr<const VoxelScene>& scene, const FeasibilityConfig& config) {
  if (scene == nullptr) fail("there is no scene");
  for (const double size : config.body.size) {
    if (!(std::isfinite(size) && size > 0)) {
      fail("the body's size must be positive and finite, not " + short_text(size));
    }
  }
  if (config.body.T_flange_camera && !rigid_pose(*config.body.T_flange_camera)) {
    fail("T_flange_camera is not a rigid transform");
  }
  if (!(std::isfinite(config.clearance) && config.clearance >= 0)) {
    fail("the clearance must be finite and not negative, not " + short_text(config.clearance));
  }
  const ReachRegion::Tolerance& taken = config.taken_tolerance;
  if (!(std::isfinite(taken.distance) && taken.distance >= 0 && std::isfinite(taken.angle) &&
        taken.angle >= 0)) {
    fail("the tolerance of views taken must be finite and not negative");
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
  /// What does not depend on the scene; shared by the checkers of all scenes.
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
    Pose T_camera_body;  ///< the body's frame has its origin in its middle
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
  if (scene == nullptr) fail("there is no scene");
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
  std::vector<Infeasibility> results(T_world_camera.size());
  impl_->settings->pool().for_each_chunk(results.size(), kPosesAtOnce,
                                         [&](std::size_t begin, std::size_t end) {
                                           for (std::size_t i = begin; i < end; ++i) {
                                             results[i] = impl_->check(T_world_camera[i], taken);
                                           }
                                         });
  return results;
}

const VoxelScene& FeasibilityChecker::scene() const noexcept { return *impl_->scene; }

}  // namespace viewgain
