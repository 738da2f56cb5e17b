// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace viewgain::detail {

struct PrimitiveBox;
struct SceneData;

/// Margin of boxes for rounding [voxels].
inline constexpr float kBoxMargin = 0.02F;

/// Boxes are read in vectors of this many.
inline constexpr std::size_t kBoxVector = 16;

/// Boxes as centres and half edges [voxels], padded to whole vectors.
struct BoxArrays {
  std::vector<float> center_x, center_y, center_z, half_x, half_y, half_z;

  void resize(std::size_t size);
  void set(std::size_t at, const PrimitiveBox& box);
  [[nodiscard]] std::size_t size() const { return center_x.size(); }
  [[nodiscard]] std::size_t bytes() const { return 6 * sizeof(float) * size(); }
};

/// Distances along an axis between the camera's position and the four positions from `low` on, on
/// the same lattice. Beyond the four only the camera's side matters. Sums over three axes are below
/// kDistances.
inline constexpr std::uint32_t kDistances = 10;
[[nodiscard]] inline std::int32_t distance_in_four(std::int32_t low, std::int32_t i,
                                                   std::int32_t camera) {
  return std::abs(low + i - std::clamp(camera, low, low + 3));
}

/// Where a cell lies on the lattices of 128³ and 32³ voxels of the grid.
struct CellPlace {
  std::array<std::int32_t, 3> node;  ///< of 128³
  std::array<std::uint8_t, 3> part;  ///< of 32³ in the node, 0 to 3
  /// Whether it extends beyond its node. It then has no place in an order from near to far.
  bool is_larger;
};

/// The primitives of a scene by cells, for sweeping from near to far. A cell is a region of 32³
/// voxels that has primitives, or a box larger than a region.
///
/// Along a ray, lattice coordinates of cells only increase or only decrease, so the sum of their
/// distances to the camera's cell increases. If cells are visited in this order (nodes, then
/// regions of a node, then blocks of a region), every ray of the camera reaches them from near to
/// far.
struct SceneCells {
  BoxArrays boxes;  ///< around the primitives of each cell
  std::vector<CellPlace> places;
  std::array<std::int32_t, 3> min_node{}, max_node{};  ///< of all places
  std::array<std::int32_t, 3> base;  ///< the workspace's lowest voxel, on the lattices
  bool has_larger = false;           ///< whether any cell is larger than its node
  /// Cell i has the members [first[i], first[i + 1]), padded to whole vectors.
  std::vector<std::uint32_t> first;
  BoxArrays members;
  std::vector<std::uint32_t> primitives;  ///< of the members; kNoPrimitive for padding
  /// Per member: the block of 8³ voxels in the region, x | y << 2 | z << 4.
  std::vector<std::uint8_t> blocks;

  /// The scene's primitives must be complete.
  explicit SceneCells(const SceneData& data);

  [[nodiscard]] std::size_t count() const { return places.size(); }
  [[nodiscard]] std::size_t bytes() const {
    return boxes.bytes() + members.bytes() + sizeof(CellPlace) * places.size() +
           sizeof(std::uint32_t) * (first.size() + primitives.size()) + blocks.size();
  }
};

}  // namespace viewgain::detail
