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

/// The meshes of the objects; the camel is the first.
[[nodiscard]] std::vector<std::filesystem::path> object_meshes();

struct ModelMapPlan {
  std::vector<std::filesystem::path> meshes = object_meshes();
  std::uint64_t seeds = 10;               ///< seeds 1 to this, for start and noise
  std::vector<int> views = {1, 2, 4, 8};  ///< numbers of views of the maps, ascending
  int voxels = 128;                       ///< along the longest side of the workspace
  std::size_t most = 200;                 ///< maximum number of maps
};

/// A map of a model after some views.
struct ModelMap {
  std::filesystem::path mesh;
  std::uint64_t seed = 0;
  int views = 0;
  std::shared_ptr<const VoxelScene> scene;
};

/// Distance of cameras from the object's centre [m].
inline constexpr double kModelDistance = 0.6;

/// Calls `visit` for each map, by seed, object and view. A disturbed SR4000 (see ModelScene) starts
/// like `viewgain reconstruct`. It then goes to the best new pose among 200 on the sphere, scored
/// on every fourth pixel. Deterministic. Only one map is kept at a time. Throws Error.
void for_each_model_map(const ModelMapPlan& plan, const ExecConfig& exec,
                        const std::function<void(const ModelMap&)>& visit);

}  // namespace viewgain::bench
