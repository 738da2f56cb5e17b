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

/// Known objects that are not part of the map. They block rays at any range and have no gain. World
/// frame.
struct VIEWGAIN_EXPORT Obstacles {
  std::vector<Box> boxes;            ///< solid
  std::vector<TriangleMesh> meshes;  ///< closed ones are solid, open ones are sheets
};

/// Surroundings of the map, world frame.
struct VIEWGAIN_EXPORT Surroundings {
  Obstacles obstacles{};  ///< known obstacles
  /// Height z of an infinite table [m]. Bodies must stay above the table. Descending rays end at
  /// the table, except with the paper's gain.
  std::optional<double> support_plane{};
};

/// An immutable scene for ray tracing: the voxels of a grid that are not free, and the obstacles.
/// Owns its data, so the grid may change or be destroyed. Share it by copying the shared_ptr.
/// Thread safety: all members are const and may run from many threads.
/// @code
/// auto scene = VoxelScene::build(grid);
/// integrator.integrate(grid, frame, T_world_camera);
/// scene = VoxelScene::update(scene, grid);
/// @endcode
class VIEWGAIN_EXPORT VoxelScene {
 public:
  /// Takes a snapshot of the grid (about 0.2 ms per 1,000 leaves) and builds a BVH of the
  /// obstacles, which update() keeps. The hazard, on the threads of `exec`, and the known surface
  /// are computed when first needed (some milliseconds). The rest runs on the calling thread; the
  /// BVH also uses the threads of TBB, which `exec` does not limit. Throws Error(backend) if Embree
  /// fails; Error(capacity) above 2^23 leaves and tiles; Error(invalid_argument) for invalid
  /// obstacles, a support plane that is not finite or an invalid number of threads. Also throws
  /// whatever HazardConfig::validate() throws.
  [[nodiscard]] static std::shared_ptr<const VoxelScene> build(
      const BeliefGrid& grid, const Surroundings& surroundings = {}, const ExecConfig& exec = {},
      const HazardConfig& hazard = {});
  /// As above, from a result of BeliefGrid::snapshot(). Its lists are not checked.
  [[nodiscard]] static std::shared_ptr<const VoxelScene> build(
      GridSnapshot snapshot, const Surroundings& surroundings = {}, const ExecConfig& exec = {},
      const HazardConfig& hazard = {});
  /// The scene of the current `grid` with the surroundings and hazard settings of `before`, which
  /// does not change. If `before` is a scene of the same grid, this is faster than build(), because
  /// unchanged parts of the map are copied (perf/README.md). Throws Error(invalid_argument) for a
  /// null scene. Also throws whatever build() throws.
  [[nodiscard]] static std::shared_ptr<const VoxelScene> update(
      const std::shared_ptr<const VoxelScene>& before, const BeliefGrid& grid,
      const ExecConfig& exec = {});
  /// As above, from a snapshot that BeliefGrid::snapshot() made from the snapshot of `before`.
  /// Unchecked.
  [[nodiscard]] static std::shared_ptr<const VoxelScene> update(
      const std::shared_ptr<const VoxelScene>& before, GridSnapshot snapshot,
      const ExecConfig& exec = {});
  ~VoxelScene();
  VoxelScene(const VoxelScene&) = delete;
  VoxelScene& operator=(const VoxelScene&) = delete;

  /// The snapshot of the scene.
  [[nodiscard]] const GridSnapshot& snapshot() const noexcept;
  /// The surroundings. All scenes that update() made from one scene share this object.
  [[nodiscard]] const Surroundings& surroundings() const noexcept;

  /// Hazard of unknown voxels and their distance to known surface; computed on the first call, in
  /// some milliseconds. Valid as long as the scene.
  [[nodiscard]] const HazardField& hazard() const;
  /// The same at single voxels, without computing all of it.
  [[nodiscard]] HazardProbe hazard_probe() const;

  /// Instruction set that traces this scene: "avx512", "avx2" or "sse4" ("baseline" off x86-64).
  /// Chosen when the scene is built: the best that the CPU supports, limited by the environment
  /// variable VIEWGAIN_ISA.
  [[nodiscard]] std::string_view isa() const noexcept;

  /// Number of leaves and tiles.
  [[nodiscard]] std::size_t primitive_count() const noexcept;
  /// Memory of the scene in addition to the snapshot [bytes]: primitives, boxes and obstacles,
  /// without Embree's BVH and data computed on demand.
  [[nodiscard]] std::uint64_t bytes() const noexcept;

 private:
  friend struct detail::SceneAccess;
  explicit VoxelScene(std::unique_ptr<const detail::SceneData> data);
  std::unique_ptr<const detail::SceneData> data_;
};

/// Names of the instruction sets that this machine and build support, best first. Constant time.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<std::string> available_isas();

}  // namespace viewgain
