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

namespace viewgain {

namespace detail {
struct SceneAccess;
struct SceneData;
}  // namespace detail

/// Known things that are not part of the map: they block rays at any range and gain nothing. World
/// frame.
struct VIEWGAIN_EXPORT Obstacles {
  std::vector<Box> boxes;            ///< solid, in any order
  std::vector<TriangleMesh> meshes;  ///< closed ones are solid, open ones sheets; in any order
};

/// What stands there beside what is mapped, world frame.
struct VIEWGAIN_EXPORT Surroundings {
  Obstacles obstacles{};  ///< known ones
  /// Height z of a table without end [m]. Bodies stay above it. Rays of the surface, the combined
  /// and the literature's gains that go down end there.
  std::optional<double> support_plane{};
};

/// An immutable scene to trace: the voxels of a grid that are not free, by cells, to be swept from
/// near to far, and obstacles in Embree's BVH. Owns all that it reads; the grid may
/// change or go. Copying a shared_ptr of it is how to share it. Thread safety: all members are
/// const and may run from many threads.
/// @code
/// auto scene = VoxelScene::build(grid);
/// integrator.integrate(grid, frame, T_world_camera);
/// scene = VoxelScene::update(scene, grid);
/// @endcode
class VIEWGAIN_EXPORT VoxelScene {
 public:
  /// Takes a snapshot of the grid and sorts it (about 0.2 ms per 1,000 leaves), and builds a BVH of
  /// the obstacles, which update() keeps. Throws Error(backend) if Embree fails, Error(capacity)
  /// beyond 2^23 leaves and tiles, Error(invalid_argument) if an obstacle has a vertex that is not
  /// finite, an index out of range or a box inside out, for a support plane that is not finite, or
  /// for a number of threads out of range. Runs on the calling thread, and with obstacles on those
  /// that the process's TBB has: exec does not limit it. Throws as HazardConfig::validate(), too.
  /// The hazard of unknown voxels and what is known of the surface are found when an evaluator of
  /// the surface or combined gain first wants them (some milliseconds).
  [[nodiscard]] static std::shared_ptr<const VoxelScene> build(
      const BeliefGrid& grid, const Surroundings& surroundings = {}, const ExecConfig& exec = {},
      const HazardConfig& hazard = {});
  /// The same of a snapshot as BeliefGrid::snapshot() made it; its lists are not checked.
  [[nodiscard]] static std::shared_ptr<const VoxelScene> build(
      GridSnapshot snapshot, const Surroundings& surroundings = {}, const ExecConfig& exec = {},
      const HazardConfig& hazard = {});
  /// The scene of what `grid` is now, with surroundings and hazard config of `before`, which stays
  /// as it is: as build(), but regions that have not changed since a scene of the same grid are
  /// copied from it. Throws Error(invalid_argument) for a null scene, and as build(). Costs 0.2
  /// times build() where a frame has changed an eighth of a map of 512³ voxels (perf/README.md).
  [[nodiscard]] static std::shared_ptr<const VoxelScene> update(
      const std::shared_ptr<const VoxelScene>& before, const BeliefGrid& grid,
      const ExecConfig& exec = {});
  /// The same of a snapshot that BeliefGrid::snapshot() made from that of `before`. It is not
  /// checked.
  [[nodiscard]] static std::shared_ptr<const VoxelScene> update(
      const std::shared_ptr<const VoxelScene>& before, GridSnapshot snapshot,
      const ExecConfig& exec = {});
  ~VoxelScene();
  VoxelScene(const VoxelScene&) = delete;
  VoxelScene& operator=(const VoxelScene&) = delete;

  /// What the scene was built from.
  [[nodiscard]] const GridSnapshot& snapshot() const noexcept;
  /// The same object in all scenes that update() has made from one.
  [[nodiscard]] const Surroundings& surroundings() const noexcept;

  /// The hazard of unknown voxels and how far they are from known surface; found when first asked
  /// for, in some milliseconds. Lives with the scene.
  [[nodiscard]] const HazardField& hazard() const;

  /// Which kernel traces this scene: "avx512", "avx2" or "sse4" ("baseline" off x86-64). Chosen
  /// when the scene is built: the best that the CPU has, lowered by the environment variable
  /// VIEWGAIN_ISA.
  [[nodiscard]] std::string_view isa() const noexcept;

  /// Leaves and tiles, and the bytes that the scene adds to the snapshot's: primitives, boxes,
  /// obstacles; Embree's BVH and what is found when it is wanted are not counted.
  [[nodiscard]] std::size_t primitive_count() const noexcept;
  /// Memory that the scene adds to the snapshot's [bytes].
  [[nodiscard]] std::uint64_t bytes() const noexcept;

 private:
  friend struct detail::SceneAccess;
  explicit VoxelScene(std::unique_ptr<const detail::SceneData> data);
  std::unique_ptr<const detail::SceneData> data_;
};

/// Names of the instruction sets that this machine and this build have, best first. Takes constant
/// time.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<std::string> available_isas();

}  // namespace viewgain
