// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
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

/// The boxes of a scene, for sorting into the tiles of a view: one a primitive, or one for each
/// cell of a grid whose cells (32³ voxels, 64³ or 128³) are at most kMaxCells, or the coarsest, and
/// the primitives cell by cell. Boxes larger than a region are cells by themselves.
struct SceneBoxes {
  BoxArrays boxes;
  std::size_t count = 0;
  /// Empty: box i is primitive i. Else box i stands for the members [first[i], first[i + 1]), each
  /// cell's beginning on a whole vector.
  std::vector<std::uint32_t> first;
  BoxArrays members;
  std::vector<std::uint32_t> primitives;  ///< of the members; kNoPrimitive where padded

  enum class Kind : std::uint8_t { primitives, cells };

  /// Of a scene whose primitives are gathered.
  SceneBoxes(const SceneData& data, Kind kind);

  [[nodiscard]] bool are_primitives() const { return first.empty(); }

  [[nodiscard]] std::size_t bytes() const {
    return boxes.bytes() + members.bytes() +
           sizeof(std::uint32_t) * (first.size() + primitives.size());
  }

  static constexpr std::size_t kMaxCells = 4096;
};

}  // namespace viewgain::detail
