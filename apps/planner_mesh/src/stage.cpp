// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner_mesh/stage.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "viewgain/core/error.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/mesh/mesh_io.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

double longest_side(const TriangleMesh& mesh) {
  double longest = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto [low, high] =
        std::minmax_element(mesh.vertices.begin(), mesh.vertices.end(),
                            [a](const auto& v, const auto& w) { return v[a] < w[a]; });
    longest = std::max(longest, (*high)[a] - (*low)[a]);
  }
  return longest;
}

}  // namespace

Stage set_stage(const StageConfig& config, const ExecConfig& exec) {
  if (config.size && (!(*config.size > 0) || !std::isfinite(*config.size))) {
    throw Error(ErrorCode::invalid_argument,
                "object size " + short_text(*config.size) + " m is not positive and finite");
  }
  TriangleMesh mesh = read_mesh(config.mesh, {config.up, true, config.size.value_or(0)});
  Stage stage;
  stage.size = config.size ? *config.size : longest_side(mesh);
  if (!(stage.size > 0)) {
    throw Error(ErrorCode::invalid_argument, config.mesh.string() + ": the mesh has no extent");
  }
  if (config.support_plane) {
    double lowest = 0;  // the box is centred at the origin
    for (const auto& v : mesh.vertices) lowest = std::min(lowest, v[2]);
    for (auto& v : mesh.vertices) v[2] += *config.support_plane - lowest;
    stage.center.z() = *config.support_plane - lowest;
  }
  const double half = 0.5 * stage.size * 0.4 / 0.35;
  for (std::size_t a = 0; a < 3; ++a) {
    const double middle = stage.center[static_cast<Eigen::Index>(a)];
    stage.workspace.min[a] = middle - half;
    stage.workspace.max[a] = middle + half;
  }
  if (config.workspace) stage.workspace = *config.workspace;
  if (config.support_plane) {
    stage.workspace.min[2] = std::max(stage.workspace.min[2], *config.support_plane);
    if (!(stage.workspace.min[2] < stage.workspace.max[2])) {
      throw Error(ErrorCode::invalid_argument, "the workspace lies under the support plane at " +
                                                   short_text(*config.support_plane) + " m");
    }
  }
  stage.scene = std::make_shared<const SurfaceScene>(std::move(mesh), exec);
  return stage;
}

Pose default_start(const Stage& stage, double distance, std::uint64_t seed,
                   const ReachRegion& reach, const std::optional<double>& support_plane) {
  const auto possible = [&](const Pose& pose) {
    return reach.contains(pose) && !(support_plane && pose.translation().z() <= *support_plane);
  };
  // The golden angle spreads the seeds' azimuths evenly.
  const double azimuth =
      std::fmod(static_cast<double>(seed % 360'000) * 137.50776 * kDegree, 2 * std::numbers::pi);
  const Pose wanted = orbit_poses(1, distance, 27 * kDegree, azimuth, 0.0, stage.center).front();
  if (possible(wanted)) return wanted;
  std::vector<Pose> others = sphere_poses(2562, distance, stage.center);
  others.insert(others.end(), reach.poses.begin(), reach.poses.end());
  const Pose* nearest = nullptr;
  double least = 0;
  for (const Pose& pose : others) {
    const double d = (pose.translation() - wanted.translation()).norm();
    if (possible(pose) && (nearest == nullptr || d < least)) nearest = &pose, least = d;
  }
  if (nearest == nullptr) {
    throw Error(ErrorCode::invalid_argument,
                "no pose that looks at the object lies in the reachable region");
  }
  return *nearest;
}

}  // namespace viewgain
