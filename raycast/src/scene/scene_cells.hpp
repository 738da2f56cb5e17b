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

/// Boxes count as larger by this much [voxels], against rounding.
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

/// Along an axis, how far place low + i of the four from `low` on is from the camera's place on the
/// same lattice; beyond the four only the camera's side matters. Three axes add up to less than
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
  /// Does it reach out of its node? Then it has no place in an order from near to far.
  bool is_larger;
};

/// The primitives of a scene by cells, to be swept from near to far. A cell is a region of 32³
/// voxels that has primitives, or a box larger than a region.
///
/// Along a ray the coordinates of the cells of a lattice change one way only, so the sum of their
/// distances to the camera's cell rises. Cells in that order, nodes first, then the regions of a
/// node, then the blocks of a region, are met from near to far by every ray of the camera.
struct SceneCells {
  BoxArrays boxes;  ///< round the primitives of each cell
  std::vector<CellPlace> places;
  std::array<std::int32_t, 3> min_node{}, max_node{};  ///< of all places
  std::array<std::int32_t, 3> base;  ///< the workspace's lowest voxel, on the lattices
  bool has_larger = false;           ///< is any cell larger than its node?
  /// Cell i has the members [first[i], first[i + 1]), the last of whole vectors.
  std::vector<std::uint32_t> first;
  BoxArrays members;
  std::vector<std::uint32_t> primitives;  ///< of the members; kNoPrimitive where padded
  /// Of the members: the block of 8³ in the region, x | y << 2 | z << 4.
  std::vector<std::uint8_t> blocks;

  /// Of a scene whose primitives are gathered.
  explicit SceneCells(const SceneData& data);

  [[nodiscard]] std::size_t count() const { return places.size(); }
  [[nodiscard]] std::size_t bytes() const {
    return boxes.bytes() + members.bytes() + sizeof(CellPlace) * places.size() +
           sizeof(std::uint32_t) * (first.size() + primitives.size()) + blocks.size();
  }
};

}  // namespace viewgain::detail
