// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/suspect_set_up.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "check/figure.hpp"
#include "viewgain/raycast/feasibility.hpp"

namespace viewgain {
namespace {

using detail::figure;

Eigen::AlignedBox3d aligned(const Box& box) {
  return {Eigen::Vector3d(box.min[0], box.min[1], box.min[2]),
          Eigen::Vector3d(box.max[0], box.max[1], box.max[2])};
}

// The workspace's bounds in the world.
Eigen::AlignedBox3d world_bounds(const BeliefGrid& map) {
  const Eigen::AlignedBox3d own = aligned(map.workspace());
  Eigen::AlignedBox3d bounds;
  for (int corner = 0; corner < 8; ++corner) {
    bounds.extend(map.T_world_grid() *
                  own.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
  }
  return bounds;
}

double longest(const Eigen::AlignedBox3d& box) { return box.sizes().maxCoeff(); }

// A view of the map can see as far beyond the map again.
double far_from_map(const Sensor& sensor) { return 2 * sensor.max_range; }

// Smallest distance of the region's parts from the map; there must be parts.
template <typename Parts, typename Distance>
double nearest_part(const Parts& parts, const Distance& distance) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& part : parts) nearest = std::min(nearest, distance(part));
  return nearest;
}

}  // namespace

Suspicion suspect_workspace(const BeliefGrid& map, const Sensor& sensor) {
  constexpr double kHuge = 50;  // times the sensor's range
  const double side = longest(aligned(map.workspace()));
  if (side <= kHuge * sensor.max_range && map.voxel_size() <= 0.5 * sensor.max_range) return {};
  return {"workspace_unit",
          "the workspace is " + figure(side) + " m long and its voxels are " +
              figure(map.voxel_size()) + " m wide, but the sensor's range ends at " +
              figure(sensor.max_range) + " m. Lengths must be in metres, not in millimetres"};
}

Suspicion suspect_obstacle(const Box& bounds, const BeliefGrid& map, const Sensor& sensor) {
  constexpr double kHuge = 100;  // times the workspace
  const Eigen::AlignedBox3d workspace = world_bounds(map), box = aligned(bounds);
  const double distance = workspace.exteriorDistance(box), side = longest(box);
  if (distance <= far_from_map(sensor) && side <= kHuge * longest(workspace)) return {};
  return {"obstacle_unit", "is " + figure(side) + " m long and " + figure(distance) +
                               " m from the map, which is " + figure(longest(workspace)) +
                               " m long. Is the obstacle in metres?"};
}

Box obstacle_bounds(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return {{0, 0, 0}, {0, 0, 0}};
  Box box{mesh.vertices.front(), mesh.vertices.front()};
  for (const auto& vertex : mesh.vertices) {
    for (std::size_t a = 0; a < 3; ++a) {
      box.min[a] = std::min(box.min[a], vertex[a]);
      box.max[a] = std::max(box.max[a], vertex[a]);
    }
  }
  return box;
}

Suspicion suspect_solid_obstacles(const Obstacles& obstacles, std::span<const Pose> views) {
  if (views.empty() || (obstacles.boxes.empty() && obstacles.meshes.empty())) return {};
  // A map of one voxel and a tiny body, so that only obstacles block.
  const BeliefGrid nothing(
      {.voxel_size = 1, .workspace = {{0, 0, 0}, {1, 1, 1}}, .prior_sigma = 1});
  FeasibilityConfig config;
  config.body.size = {1e-4, 1e-4, 1e-4};
  const FeasibilityChecker checker(VoxelScene::build(nothing, {obstacles, {}}), config);
  const auto inside = std::count_if(views.begin(), views.end(), [&checker](const Pose& view) {
    return checker.check(view) == Infeasibility::obstacle;
  });
  if (2 * static_cast<std::size_t>(inside) <= views.size()) return {};
  return {"views_in_obstacle",
          std::to_string(inside) + " of the map's " + std::to_string(views.size()) +
              " views were taken inside an obstacle, where no view is possible. Boxes and closed "
              "meshes are solid. Give the walls of a room as an open mesh or as one box per wall"};
}

Suspicion suspect_reach(const ReachRegion& reach, const BeliefGrid& map, const Sensor& sensor) {
  const Eigen::AlignedBox3d workspace = world_bounds(map);
  const double boxes = nearest_part(
      reach.boxes, [&](const Box& box) { return workspace.exteriorDistance(aligned(box)); });
  const double shells = nearest_part(reach.shells, [&](const ReachRegion::Shell& shell) {
    const double nearest = workspace.exteriorDistance(shell.center);
    double farthest = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const auto at = workspace.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
      farthest = std::max(farthest, (at - shell.center).norm());
    }
    return std::max({0.0, nearest - shell.max_radius, shell.min_radius - farthest});
  });
  const double poses = nearest_part(reach.poses, [&](const Pose& pose) {
    return workspace.exteriorDistance(Eigen::Vector3d(pose.translation()));
  });
  const double half_spaces = nearest_part(reach.half_spaces, [&](const auto& half) {
    double nearest = std::numeric_limits<double>::infinity();
    for (int corner = 0; corner < 8; ++corner) {
      const auto at = workspace.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
      nearest = std::min(nearest, (half.offset - half.normal.dot(at)) / half.normal.norm());
    }
    return nearest;
  });
  double distance = 0;
  for (const double part : {boxes, shells, poses, half_spaces}) {
    if (std::isfinite(part)) distance = std::max(distance, part);
  }
  if (distance <= far_from_map(sensor)) return {};
  return {"reach_unit", "the nearest reachable position is " + figure(distance) +
                            " m from the map, but the sensor's range ends at " +
                            figure(sensor.max_range) +
                            " m. Lengths in the reach file must be in metres, not in millimetres"};
}

Suspicion suspect_support_plane(double z, const BeliefGrid& map, const Sensor& sensor) {
  const Eigen::AlignedBox3d workspace = world_bounds(map);
  const double distance = std::max(workspace.min().z() - z, z - workspace.max().z());
  if (distance <= far_from_map(sensor)) return {};
  return {"plane_unit", "the support plane at z = " + figure(z) + " m is " + figure(distance) +
                            " m from the map, but the sensor's range ends at " +
                            figure(sensor.max_range) +
                            " m. The plane's height must be in metres, not in millimetres"};
}

Suspicion suspect_object_size(double size, const BeliefGrid& map) {
  constexpr double kHuge = 10;  // times the workspace
  const double side = longest(aligned(map.workspace()));
  if (size <= kHuge * side && size >= map.voxel_size()) return {};
  return {"object_size_unit",
          "an object size of " + figure(size) + " m does not fit a map " + figure(side) +
              " m long with voxels of " + figure(map.voxel_size()) +
              " m. The object's longest side must be in metres, not in millimetres"};
}

Suspicion suspect_clearance(double clearance) {
  if (clearance <= 2) return {};
  return {"clearance_unit", "a clearance of " + figure(clearance) +
                                " m around the camera's housing leaves no room anywhere. "
                                "Clearances must be in metres, not in millimetres"};
}

}  // namespace viewgain
