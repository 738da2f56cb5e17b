// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace viewgain::detail {

struct PrimitiveBox;

/// Boxes are read in vectors of this many.
inline constexpr std::size_t kBoxVector = 16;

/// Boxes as centres and half edges [voxels], padded to whole vectors.
struct BoxArrays {
  std::vector<float> center_x, center_y, center_z, half_x, half_y, half_z;

  void append(const PrimitiveBox& box);
  void reserve(std::size_t size);
  /// Repeats the last box until a vector is full.
  void pad();
  [[nodiscard]] std::size_t size() const { return center_x.size(); }
};

/// The boxes of a scene, for sorting into the tiles of a view: one a primitive, or, where there are
/// more than kMaxBoxes, one for each cell of a grid that is coarse enough, and the primitives cell
/// by cell.
struct SceneBoxes {
  BoxArrays boxes;
  std::size_t count = 0;
  /// Empty: box i is primitive i. Else box i stands for the members [first[i], first[i + 1]), each
  /// cell's beginning on a whole vector.
  std::vector<std::uint32_t> first;
  BoxArrays members;
  std::vector<std::uint32_t> primitives;  ///< of the members; kNoPrimitive where padded

  explicit SceneBoxes(const std::vector<PrimitiveBox>& primitives);

  [[nodiscard]] bool are_primitives() const { return first.empty(); }

  static constexpr std::size_t kMaxBoxes = 4096;
};

}  // namespace viewgain::detail
