// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/box.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/triangle_mesh.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/hazard.hpp"
#include "viewgain/grid/hazard_probe.hpp"

namespace viewgain {

namespace detail {
struct SceneAccess;
struct SceneData;
}  // namespace detail

/// Known objects that are not part of the map, in the world frame. They block rays at any range and
/// have no gain.
struct VIEWGAIN_EXPORT Obstacles {
  std::vector<Box> boxes;            ///< solid boxes
  std::vector<TriangleMesh> meshes;  ///< closed meshes are solid, open meshes are sheets
};

/// Known surroundings of the map, world frame.
struct VIEWGAIN_EXPORT Surroundings {
  Obstacles obstacles{};  ///< known obstacles
  /// Height z of an infinite table [m]. The camera's body must stay above it. Descending rays end
  /// at the table, except with the paper's gain.
  std::optional<double> support_plane{};
};

/// An immutable scene for ray tracing: the unknown and occupied voxels of a grid, and the
/// obstacles. Leaves (blocks of 8³ voxels) and tiles (larger boxes of unknown voxels) are those of
/// GridSnapshot. A scene owns its data, so the grid may change or be destroyed. Share a scene by
/// copying the shared_ptr. Thread safety: members may run from many threads.
/// @code
/// auto scene = VoxelScene::build(grid);
/// integrator.integrate(grid, frame, T_world_camera);
/// scene = VoxelScene::update(scene, grid);
/// @endcode
class VIEWGAIN_EXPORT VoxelScene {
 public:
  /// Takes a snapshot of the grid and builds a bounding volume hierarchy (BVH) of the obstacles.
  /// `exec` sets the number of threads for hazard(). The BVH uses the threads of TBB, which `exec`
  /// does not limit. Throws Error(backend) if Embree fails, and Error(capacity) above 2^23 leaves
  /// and tiles. Throws Error(invalid_argument) for invalid obstacles, a support plane that is not
  /// finite or an invalid number of threads. Also throws whatever HazardConfig::validate() throws.
  /// Cost: about 0.2 ms per 1,000 leaves, and some milliseconds when hazard() is first needed.
  [[nodiscard]] static std::shared_ptr<const VoxelScene> build(
      const BeliefGrid& grid, const Surroundings& surroundings = {}, const ExecConfig& exec = {},
      const HazardConfig& hazard = {});
  /// As above, from a snapshot of BeliefGrid::snapshot(), which is not checked.
  [[nodiscard]] static std::shared_ptr<const VoxelScene> build(
      GridSnapshot snapshot, const Surroundings& surroundings = {}, const ExecConfig& exec = {},
      const HazardConfig& hazard = {});
  /// The scene of the current grid, with the surroundings and hazard settings of `before`. The
  /// scene `before` does not change. If it is a scene of the same grid, this is faster than
  /// build(), because unchanged parts of the map and the BVH are reused (perf/README.md). Throws
  /// Error(invalid_argument) for a null scene. Also throws whatever build() throws.
  [[nodiscard]] static std::shared_ptr<const VoxelScene> update(
      const std::shared_ptr<const VoxelScene>& before, const BeliefGrid& grid,
      const ExecConfig& exec = {});
  /// As above, from a snapshot that BeliefGrid::snapshot(before->snapshot()) returned, which is not
  /// checked.
  [[nodiscard]] static std::shared_ptr<const VoxelScene> update(
      const std::shared_ptr<const VoxelScene>& before, GridSnapshot snapshot,
      const ExecConfig& exec = {});
  ~VoxelScene();
  VoxelScene(const VoxelScene&) = delete;
  VoxelScene& operator=(const VoxelScene&) = delete;

  /// The snapshot from which the scene was made.
  [[nodiscard]] const GridSnapshot& snapshot() const noexcept;
  /// The surroundings. A scene from update() shares this object with the scene `before`.
  [[nodiscard]] const Surroundings& surroundings() const noexcept;

  /// Hazard of unknown voxels, and their distance to known surface. Computed on the first call, in
  /// some milliseconds. Valid as long as the scene.
  [[nodiscard]] const HazardField& hazard() const;
  /// As hazard(), but computes the values of single voxels on demand.
  [[nodiscard]] HazardProbe hazard_probe() const;

  /// Instruction set with which this scene is traced: "avx512", "avx2" or "sse4"; "baseline" on
  /// other architectures than x86-64. It is chosen when the scene is built: the best that the CPU
  /// supports, unless the environment variable VIEWGAIN_ISA limits it.
  [[nodiscard]] std::string_view isa() const noexcept;

  /// Number of leaves and tiles.
  [[nodiscard]] std::size_t primitive_count() const noexcept;
  /// Memory of the scene [bytes], without the snapshot, Embree's BVH and data that are computed on
  /// demand.
  [[nodiscard]] std::uint64_t bytes() const noexcept;

 private:
  friend struct detail::SceneAccess;
  explicit VoxelScene(std::unique_ptr<const detail::SceneData> data);
  std::unique_ptr<const detail::SceneData> data_;
};

/// Names of the instruction sets that this machine and build support, best first. Constant time.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<std::string> available_isas();

}  // namespace viewgain
