// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "scene_cells.hpp"
#include "viewgain/grid/hazard.hpp"
#include "viewgain/raycast/voxel_scene.hpp"
#include "viewgain/support/isa.hpp"

namespace viewgain::detail {

struct SceneData;
class SceneTracing;

// Defined in the folder trace.

/// Tracing data for a scene whose primitives are complete. `before`: the scene that it updates, or
/// null. Throws like VoxelScene::build().
[[nodiscard]] std::shared_ptr<const SceneTracing> make_tracing(const SceneData& data,
                                                               const SceneData* before);
/// The instruction set that the scene is traced with.
[[nodiscard]] Isa isa_of(const SceneTracing& tracing);

/// Mask of a leaf for tracing: 512 bits, one cache line.
struct alignas(64) TraceMask {
  std::array<std::uint32_t, 16> words{};  ///< bit of voxel (x,y,z): x << 6 | y << 3 | z
};

/// A primitive's box in voxels, relative to the workspace's lowest corner. For a leaf it is the
/// tightest box around its set bits; first_offset is the offset of the box's lowest voxel in the
/// leaf.
struct alignas(32) PrimitiveBox {
  float min[3];
  float max[3];
  std::uint32_t first_offset;
};

/// Larger than every primitive's number, also in signed comparisons.
inline constexpr std::uint32_t kNoPrimitive = 0x7FFFFFFFU;

/// Bits per axis of a voxel's packed offset in its primitive: x << 2 bits | y << bits | z. Leaves
/// and whole unknown blocks of 8³ have three bits, larger boxes ten; kMaxBoxEdge is the limit of
/// the latter.
inline constexpr int kBlockBits = 3;
inline constexpr int kBoxBits = 10;
inline constexpr int kMaxBoxEdge = 1 << kBoxBits;

/// First primitives of a region, counted separately for leaves, whole blocks and boxes. Boxes
/// larger than a region come before all regions' boxes.
struct SceneRegion {
  std::uint32_t leaf, block, box;
};

/// Contents of a VoxelScene. Primitives [0, leaf_count) are leaves, traced by their masks;
/// [leaf_count, block_count) are whole blocks of 8³ unknown voxels; the rest are larger or clipped
/// boxes of unknown voxels.
///
/// Blocks are the 8³ cells of the lattice that touch the workspace, numbered x-major. A voxel's key
/// is block << 9 | x << 6 | y << 3 | z, with its position in the block.
struct SceneData {
  GridSnapshot snapshot;
  std::vector<TraceMask> masks;            ///< one per leaf
  std::vector<PrimitiveBox> boxes;         ///< one per primitive
  std::vector<std::uint64_t> block_keys;   ///< block << 9, one per primitive below block_count
  std::vector<std::uint32_t> leaf_source;  ///< index into snapshot.leaves, one per leaf primitive
  /// Whether it has occupied voxels, one per leaf primitive.
  std::vector<std::uint8_t> has_occupied;
  std::size_t leaf_count = 0;
  std::size_t block_count = 0;
  /// First primitives of each of the snapshot's regions, and one past the last.
  std::vector<SceneRegion> regions;
  std::shared_ptr<const Surroundings> surroundings;  ///< never null; shared by the scenes of a map
  bool has_obstacles = false;
  ExecConfig exec;                             ///< threads that compute the hazard
  std::shared_ptr<const HazardConfig> hazard;  ///< never null; shared by the scenes of a map
  std::optional<SceneCells> cells;             ///< for sweeping views
  /// Kernels and BVH, which the folder trace keeps with a scene; opaque here.
  std::shared_ptr<const SceneTracing> tracing;

  /// The hazard of unknown voxels; computed on the first call. Thread safe.
  [[nodiscard]] const HazardField& hazard_field() const {
    std::call_once(hazard_once_, [&] { hazard_field_.emplace(snapshot, *hazard, exec); });
    return *hazard_field_;
  }

  /// Key of the voxel at (x, y, z), relative to the workspace's lowest voxel.
  [[nodiscard]] std::uint64_t voxel_key(std::int32_t x, std::int32_t y, std::int32_t z) const {
    const std::int32_t gx = x + snapshot.min_index.x, gy = y + snapshot.min_index.y,
                       gz = z + snapshot.min_index.z;
    return block_of(gx >> 3, gy >> 3, gz >> 3) << 9U | block_offset({gx, gy, gz});
  }

  /// Blocks that n voxels from min on touch.
  [[nodiscard]] static std::uint64_t block_extent(std::int32_t min, std::int32_t n) {
    return static_cast<std::uint64_t>(((min + n - 1) >> 3) - (min >> 3) + 1);
  }

  /// Number of the block at block coordinates (voxel index / 8, rounded down).
  [[nodiscard]] std::uint64_t block_of(std::int32_t bx, std::int32_t by, std::int32_t bz) const {
    const auto& base = snapshot.min_index;
    const auto& dims = snapshot.dims;
    return (static_cast<std::uint64_t>(bx - (base.x >> 3)) * block_extent(base.y, dims.y) +
            static_cast<std::uint64_t>(by - (base.y >> 3))) *
               block_extent(base.z, dims.z) +
           static_cast<std::uint64_t>(bz - (base.z >> 3));
  }

  /// The inverse: the voxel of a key, as an index of the grid's lattice.
  [[nodiscard]] Index3 voxel_at(std::uint64_t key) const {
    const auto& base = snapshot.min_index;
    const auto& dims = snapshot.dims;
    const std::uint64_t block = key >> 9U;
    const std::uint64_t ny = block_extent(base.y, dims.y), nz = block_extent(base.z, dims.z);
    const auto coordinate = [](std::uint64_t b, std::int32_t min, std::uint64_t low) {
      return ((static_cast<std::int32_t>(b) + (min >> 3)) << 3) + static_cast<std::int32_t>(low);
    };
    return {coordinate(block / (ny * nz), base.x, key >> 6U & 7U),
            coordinate(block / nz % ny, base.y, key >> 3U & 7U),
            coordinate(block % nz, base.z, key & 7U)};
  }

  /// The voxel of a hit, as an index of the grid's lattice.
  [[nodiscard]] Index3 voxel_index(std::uint32_t primitive, std::uint32_t offset) const {
    const int bits = primitive < block_count ? kBlockBits : kBoxBits;
    const std::uint32_t low = (1U << bits) - 1U;
    const auto x = static_cast<std::int32_t>(offset >> 2 * bits);
    const auto y = static_cast<std::int32_t>(offset >> bits & low);
    const auto z = static_cast<std::int32_t>(offset & low);
    if (primitive < leaf_count) {
      const Index3& origin = snapshot.leaves[leaf_source[primitive]].origin;
      return {origin.x + x, origin.y + y, origin.z + z};
    }
    const auto& min = boxes[primitive].min;
    return {snapshot.min_index.x + static_cast<std::int32_t>(min[0]) + x,
            snapshot.min_index.y + static_cast<std::int32_t>(min[1]) + y,
            snapshot.min_index.z + static_cast<std::int32_t>(min[2]) + z};
  }

  /// The leaf of an occupied voxel that was hit; null if the voxel is unknown.
  [[nodiscard]] const GridSnapshot::Leaf* occupied_leaf(std::uint32_t primitive,
                                                        std::uint32_t offset) const {
    if (primitive >= leaf_count) return nullptr;
    const GridSnapshot::Leaf& leaf = snapshot.leaves[leaf_source[primitive]];
    return test_bit(leaf.occupied, offset) ? &leaf : nullptr;
  }

  [[nodiscard]] std::uint64_t hit_key(std::uint32_t primitive, std::uint32_t offset) const {
    if (primitive < block_count) return block_keys[primitive] | offset;
    const Index3 voxel = voxel_index(primitive, offset);
    return voxel_key(voxel.x - snapshot.min_index.x, voxel.y - snapshot.min_index.y,
                     voxel.z - snapshot.min_index.z);
  }

 private:
  mutable std::once_flag hazard_once_;
  mutable std::optional<HazardField> hazard_field_;
};

/// Access to a scene's data for this module's other folders and for perf/.
struct SceneAccess {
  [[nodiscard]] static const SceneData& data(const VoxelScene& scene) { return *scene.data_; }
  [[nodiscard]] static std::shared_ptr<const VoxelScene> make(
      std::unique_ptr<const SceneData> data) {
    return std::shared_ptr<const VoxelScene>(new VoxelScene(std::move(data)));
  }
};

}  // namespace viewgain::detail
