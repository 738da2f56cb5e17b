// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "viewgain/core/exec_config.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain::bench {

/// The objects that maps are made of; the camel is the first.
[[nodiscard]] std::vector<std::filesystem::path> object_meshes();

struct ModelMapPlan {
  std::vector<std::filesystem::path> meshes = object_meshes();
  std::uint64_t seeds = 10;               ///< 1 .. seeds, of start and noise
  std::vector<int> views = {1, 2, 4, 8};  ///< ascending; after so many there is a map
  int voxels = 128;                       ///< along the workspace's longest side
  std::size_t most = 200;                 ///< maps, then it ends
};

/// A map on the way of a model.
struct ModelMap {
  std::filesystem::path mesh;
  std::uint64_t seed = 0;
  int views = 0;
  std::shared_ptr<const VoxelScene> scene;
};

/// Cameras stand so far from the object's centre [m].
inline constexpr double kModelDistance = 0.6;

/// Calls visit for each map, seed by seed, object by object, view by view: a disturbed SR4000 (see
/// ModelScene) begins where `viewgain reconstruct` would and then goes to the best of 200 poses on
/// the sphere that it has not been at, scored on every fourth pixel. Deterministic; one map at a
/// time is kept. Throws Error.
void for_each_model_map(const ModelMapPlan& plan, const ExecConfig& exec,
                        const std::function<void(const ModelMap&)>& visit);

}  // namespace viewgain::bench
