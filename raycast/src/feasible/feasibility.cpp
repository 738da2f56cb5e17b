// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/feasibility.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "box_hierarchy.hpp"
#include "obstacle_check.hpp"
#include "oriented_box.hpp"
#include "scene/scene_data.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/text.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain {
namespace {

using detail::BoxHierarchy;
using detail::OrientedBox;

constexpr double kMaxPoseError = 1e-3;
constexpr int kSightStride = 8;  // of the pixels that tell whether a view is too near
constexpr double kTouch = 1e-9;  // smaller overlaps are touching [m]

void check(const std::shared_ptr<const VoxelScene>& scene, const FeasibilityConfig& config) {
  const auto fail = [](const std::string& what) {
    throw Error(ErrorCode::invalid_argument, "feasibility: " + what);
  };
  if (scene == nullptr) fail("there is no scene");
  for (const double size : config.body.size) {
    if (!(std::isfinite(size) && size > 0)) {
      fail("the body's size must be positive and finite, not " + short_text(size));
    }
  }
  if (config.body.T_flange_camera &&
      !(orthonormality_error(*config.body.T_flange_camera) <= kMaxPoseError)) {
    fail("T_flange_camera is not a rigid transform");
  }
  if (!(std::isfinite(config.clearance) && config.clearance >= 0)) {
    fail("the clearance must be finite and not negative, not " + short_text(config.clearance));
  }
  const PoseTolerance& taken = config.taken_tolerance;
  if (!(std::isfinite(taken.distance) && taken.distance >= 0 && std::isfinite(taken.angle) &&
        taken.angle >= 0)) {
    fail("the tolerance of views taken must be finite and not negative");
  }
  if (config.support_plane && !std::isfinite(*config.support_plane)) {
    fail("the support plane's height is not finite");
  }
  config.reach.validate();
  if (config.sensor) config.sensor->validate();
  if (!(config.max_near_share >= 0 && config.max_near_share <= 1)) {
    fail("the share of near rays must be in 0..1, not " + short_text(config.max_near_share));
  }
}

Box box_of(const Index3& min, const Index3& max) {
  return {{static_cast<double>(min.x), static_cast<double>(min.y), static_cast<double>(min.z)},
          {static_cast<double>(max.x), static_cast<double>(max.y), static_cast<double>(max.z)}};
}

// Leaves first, then tiles.
std::vector<Box> boxes_of(const GridSnapshot& snapshot) {
  std::vector<Box> boxes;
  boxes.reserve(snapshot.leaves.size() + snapshot.tiles.size());
  for (const SnapshotLeaf& leaf : snapshot.leaves) {
    const Index3& o = leaf.origin;
    boxes.push_back(box_of(o, {o.x + 8, o.y + 8, o.z + 8}));
  }
  for (const VoxelBox& tile : snapshot.tiles) boxes.push_back(box_of(tile.min, tile.max));
  return boxes;
}

Eigen::Vector3d vector(const Index3& index) {
  return {static_cast<double>(index.x), static_cast<double>(index.y), static_cast<double>(index.z)};
}

/// The voxels of a scene that are not free. Lengths in voxels, in the grid's frame.
class NonFreeVoxels {
 public:
  explicit NonFreeVoxels(const GridSnapshot& snapshot)
      : snapshot_(snapshot), boxes_(boxes_of(snapshot)) {}

  [[nodiscard]] bool overlap(const OrientedBox& body) const {
    const Box range = body.bounds();
    const auto voxel_limits = body.limits(Eigen::Vector3d::Constant(0.5));
    const auto leaf_limits = body.limits(Eigen::Vector3d::Constant(4.0));
    return boxes_.any(range, [&](std::uint32_t item) {
      if (item >= snapshot_.leaves.size()) {
        const VoxelBox& tile = snapshot_.tiles[item - snapshot_.leaves.size()];
        return body.overlaps(box_of(tile.min, tile.max));
      }
      const SnapshotLeaf& leaf = snapshot_.leaves[item];
      const Eigen::Vector3d origin = vector(leaf.origin);
      return body.overlaps(origin + Eigen::Vector3d::Constant(4.0), leaf_limits) &&
             voxels_overlap(body, range, leaf, origin, voxel_limits);
    });
  }

  // Whether a point is in voxels that are not free whichever side of a face it may be on.
  [[nodiscard]] bool enclose(const Eigen::Vector3d& point, double touch) const {
    const auto low = [&](int axis) { return std::floor(point[axis] - touch); };
    const auto high = [&](int axis) { return std::floor(point[axis] + touch); };
    for (double x = low(0); x <= high(0); ++x) {
      for (double y = low(1); y <= high(1); ++y) {
        for (double z = low(2); z <= high(2); ++z) {
          if (!contains({x, y, z})) return false;
        }
      }
    }
    return true;
  }

 private:
  // The voxel with this lowest corner.
  [[nodiscard]] bool contains(const Eigen::Vector3d& corner) const {
    const Eigen::Vector3d p = corner + Eigen::Vector3d::Constant(0.5);
    const Box range{{p.x(), p.y(), p.z()}, {p.x(), p.y(), p.z()}};
    return boxes_.any(range, [&](std::uint32_t item) {
      if (item >= snapshot_.leaves.size()) return true;
      const SnapshotLeaf& leaf = snapshot_.leaves[item];
      const Eigen::Vector3d place = corner - vector(leaf.origin);
      return test_bit(leaf.non_free, static_cast<unsigned>(place.x()) << 6U |
                                         static_cast<unsigned>(place.y()) << 3U |
                                         static_cast<unsigned>(place.z()));
    });
  }

  [[nodiscard]] static bool voxels_overlap(const OrientedBox& body, const Box& range,
                                           const SnapshotLeaf& leaf, const Eigen::Vector3d& origin,
                                           const OrientedBox::Limits& limits) {
    // The voxels [low, high) of the leaf are those within the body's bounds.
    std::array<unsigned, 3> low{}, high{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double base = origin[static_cast<Eigen::Index>(k)];
      low[k] = static_cast<unsigned>(std::clamp(std::floor(range.min[k] - base), 0.0, 8.0));
      high[k] = static_cast<unsigned>(std::clamp(std::ceil(range.max[k] - base), 0.0, 8.0));
    }
    const std::uint64_t row = (1ULL << high[2]) - (1ULL << low[2]);
    std::uint64_t within = 0;  // bits are y << 3 | z
    for (unsigned y = low[1]; y < high[1]; ++y) within |= row << 8U * y;
    for (unsigned x = low[0]; x < high[0]; ++x) {
      for (std::uint64_t bits = leaf.non_free[x] & within; bits != 0; bits &= bits - 1) {
        const auto bit = static_cast<unsigned>(std::countr_zero(bits));
        const Eigen::Vector3d center =
            origin + Eigen::Vector3d(x + 0.5, (bit >> 3U) + 0.5, (bit & 7U) + 0.5);
        if (body.overlaps(center, limits)) return true;
      }
    }
    return false;
  }

  const GridSnapshot& snapshot_;
  BoxHierarchy boxes_;
};

}  // namespace

std::string_view infeasibility_name(Infeasibility reason) {
  switch (reason) {
    case Infeasibility::none:
      return "none";
    case Infeasibility::bad_pose:
      return "bad_pose";
    case Infeasibility::unreachable:
      return "unreachable";
    case Infeasibility::taken:
      return "taken";
    case Infeasibility::plane:
      return "plane";
    case Infeasibility::obstacle:
      return "obstacle";
    case Infeasibility::collision:
      return "collision";
    case Infeasibility::too_near:
      break;
  }
  return "too_near";
}

struct FeasibilityChecker::Impl {
  Impl(std::shared_ptr<const VoxelScene> scene_in, FeasibilityConfig config_in)
      : scene(std::move(scene_in)),
        config(std::move(config_in)),
        obstacles(detail::SceneAccess::data(*scene).obstacles),
        voxels(scene->snapshot()),
        T_grid_world(scene->snapshot().T_world_grid.inverse()) {
    const SensorBody& body = config.body;
    const double depth = body.size[2];
    half = 0.5 * Eigen::Vector3d(body.size[0], body.size[1], depth) +
           Eigen::Vector3d::Constant(config.clearance);
    T_camera_body = Pose(Eigen::Matrix3d::Identity(), {0, 0, -0.5 * depth});
    if (body.T_flange_camera) {
      T_camera_body = orthonormalized(*body.T_flange_camera).inverse() *
                      Pose(Eigen::Matrix3d::Identity(), {0, 0, 0.5 * depth});
    }
    if (config.sensor && config.sensor->min_range > 0) {
      GainConfig from_the_lens;
      from_the_lens.min_range = 0.0;
      from_the_lens.pixel_stride = kSightStride;
      // Only ranges are asked for, also where the sensor's noise is not defined.
      Sensor eye = *config.sensor;
      eye.noise = ConstantNoise{};
      sight.emplace(scene, eye, from_the_lens, ExecConfig{1});
    }
  }

  [[nodiscard]] bool too_near(const Pose& T_world_camera) const {
    if (!sight) return false;
    std::size_t ends = 0, near = 0;
    for (const RayHit& hit : sight->trace(T_world_camera)) {
      if (hit.kind != RayHit::Kind::unknown && hit.kind != RayHit::Kind::occupied) continue;
      ++ends;
      if (hit.range < config.sensor->min_range) ++near;
    }
    return static_cast<double>(near) > config.max_near_share * static_cast<double>(ends);
  }

  [[nodiscard]] bool meets_plane(const Pose& T_world_body, const Eigen::Vector3d& camera) const {
    const double below = T_world_body.rotation().row(2).cwiseAbs().dot(half);
    const double lowest = std::min(T_world_body.translation().z() - below, camera.z());
    return config.support_plane && lowest <= *config.support_plane + kTouch;
  }

  [[nodiscard]] bool meets_obstacle(const Pose& T_world_body) const {
    const Eigen::Vector3d center = T_world_body.translation();
    return obstacles.overlaps(OrientedBox(center, T_world_body.rotation(), half, kTouch), center);
  }

  [[nodiscard]] bool meets_voxel(const Pose& T_world_body, const Eigen::Vector3d& camera) const {
    const double per_voxel = 1.0 / scene->snapshot().voxel_size;
    const Pose T_grid_body = T_grid_world * T_world_body;
    const OrientedBox body(T_grid_body.translation() * per_voxel, T_grid_body.rotation(),
                           half * per_voxel, kTouch * per_voxel);
    return voxels.overlap(body) ||
           voxels.enclose((T_grid_world * camera) * per_voxel, kTouch * per_voxel);
  }

  std::shared_ptr<const VoxelScene> scene;
  FeasibilityConfig config;
  detail::ObstacleCheck obstacles;
  NonFreeVoxels voxels;
  Pose T_grid_world;
  Pose T_camera_body;  ///< the body's frame has its origin in its middle
  Eigen::Vector3d half;
  std::optional<GainEvaluator> sight;  ///< a coarse bundle of rays that start at the lens
};

FeasibilityChecker::FeasibilityChecker(std::shared_ptr<const VoxelScene> scene,
                                       const FeasibilityConfig& config) {
  ::viewgain::check(scene, config);
  impl_ = std::make_unique<Impl>(std::move(scene), config);
}

FeasibilityChecker::~FeasibilityChecker() = default;
FeasibilityChecker::FeasibilityChecker(FeasibilityChecker&&) noexcept = default;
FeasibilityChecker& FeasibilityChecker::operator=(FeasibilityChecker&&) noexcept = default;

Infeasibility FeasibilityChecker::check(const Pose& T_world_camera,
                                        std::span<const Pose> taken) const {
  const Impl& impl = *impl_;
  if (!(orthonormality_error(T_world_camera) <= kMaxPoseError)) return Infeasibility::bad_pose;
  if (!impl.config.reach.contains(T_world_camera)) return Infeasibility::unreachable;
  if (is_among(T_world_camera, taken, impl.config.taken_tolerance)) return Infeasibility::taken;

  const Eigen::Vector3d camera = T_world_camera.translation();
  const Pose T_world_body = orthonormalized(T_world_camera) * impl.T_camera_body;
  if (impl.meets_plane(T_world_body, camera)) return Infeasibility::plane;
  if (impl.meets_obstacle(T_world_body)) return Infeasibility::obstacle;
  if (impl.meets_voxel(T_world_body, camera)) return Infeasibility::collision;
  if (impl.too_near(T_world_camera)) return Infeasibility::too_near;
  return Infeasibility::none;
}

}  // namespace viewgain
