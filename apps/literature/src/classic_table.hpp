// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/literature/classic_gains.hpp"
#include "viewgain/support/brick_index.hpp"
#include "viewgain/support/log_odds_code.hpp"

namespace viewgain::detail {

/// Number of steps of each unknown voxel behind a measured surface, stored by brick of 8³ voxels in
/// table coordinates (ClassicTable).
class OcclusionSteps {
 public:
  static constexpr std::uint8_t kNone = 0;
  using Brick = std::array<std::uint8_t, 512>;  ///< x << 6 | y << 3 | z
  using Place = std::array<std::int32_t, 3>;    ///< of a brick: x / 8, y / 8, z / 8

  /// The lowest value for a voxel counts; `steps` is above 0.
  void mark(std::int32_t x, std::int32_t y, std::int32_t z, std::uint8_t steps) {
    const Place place{x >> 3, y >> 3, z >> 3};
    if (last_ == nullptr || place != last_place_) {
      std::unique_ptr<Brick>& found = bricks_[place];
      if (!found) found = std::make_unique<Brick>();
      last_place_ = place;
      last_ = found.get();
    }
    lower((*last_)[static_cast<std::size_t>((x & 7) << 6 | (y & 7) << 3 | (z & 7))], steps);
  }

  void merge(const OcclusionSteps& other) {
    for (const auto& [place, brick] : other.bricks_) {
      std::unique_ptr<Brick>& own = bricks_[place];
      if (!own) own = std::make_unique<Brick>();
      for (std::size_t i = 0; i < brick->size(); ++i) {
        if ((*brick)[i] != kNone) lower((*own)[i], (*brick)[i]);
      }
    }
  }

  [[nodiscard]] const std::map<Place, std::unique_ptr<Brick>>& bricks() const { return bricks_; }

 private:
  static void lower(std::uint8_t& own, std::uint8_t steps) {
    if (own == kNone || steps < own) own = steps;
  }

  std::map<Place, std::unique_ptr<Brick>> bricks_;
  Place last_place_{};
  Brick* last_ = nullptr;
};

/// Voxel data for classic gains, indexed by place.
struct ClassicTable : BrickIndex {
  /// A word has 13 bits. The lower 10 of a known voxel hold the code of its log-odds; those of an
  /// unknown one hold kUnknown, the steps behind a measured surface, and whether it is a surface
  /// frontier. The upper 3 hold the binary logarithm of the edge [voxels] of the largest aligned
  /// uniform cube around it: 0 to 2 in a brick, otherwise 3 to kLargestShift.
  static constexpr std::uint32_t kCode = 0x7FU, kFrontier = 1, kUnknown = 0x200U;
  static constexpr int kStepsShift = 1, kEdgeShift = 10;
  static constexpr std::uint32_t kMostSteps = 255, kValue = 0x3FFU, kEdge = 7;
  static constexpr unsigned kLargestShift = 5;
  [[nodiscard]] static bool is_unknown(std::uint32_t word) { return (word & kUnknown) != 0; }
  [[nodiscard]] static bool is_occupied(std::uint32_t word) {
    return !is_unknown(word) && (word & kCode) > kZeroCode;
  }
  [[nodiscard]] static bool is_frontier(std::uint32_t word) {
    return is_unknown(word) && (word & kFrontier) != 0;
  }
  [[nodiscard]] static std::uint32_t steps(std::uint32_t word) {
    return is_unknown(word) ? word >> kStepsShift & kMostSteps : 0;
  }
  /// Edge of the cube [voxels].
  [[nodiscard]] static std::int32_t edge(std::uint32_t word) {
    return 1 << (word >> kEdgeShift & kEdge);
  }

  /// An entry with this bit is the word of all voxels of its brick; otherwise it is the brick's
  /// first index in `words`.
  static constexpr std::uint32_t kUniform = 0x80000000U;

  /// 512 per mixed brick, by word_in_brick(); the first 512 are unused.
  std::vector<std::uint16_t> words;

  /// From the current grid. Throws Error(capacity).
  explicit ClassicTable(const BeliefGrid& grid);

  /// Adds the steps of unknown voxels.
  void add(const OcclusionSteps& steps);

  /// Word of a voxel of the workspace, in table coordinates.
  [[nodiscard]] std::uint32_t word(std::int32_t x, std::int32_t y, std::int32_t z) const {
    const std::uint32_t entry = entries[entry_index(x, y, z)];
    if ((entry & kUniform) != 0) return entry;
    return words[entry + word_in_brick(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                       static_cast<std::uint32_t>(z))];
  }
  /// Words are ordered by cubes of 4³, two cache lines each.
  [[nodiscard]] static std::uint32_t word_in_brick(std::uint32_t x, std::uint32_t y,
                                                   std::uint32_t z) {
    return (x & 4U) << 6U | (y & 4U) << 5U | (z & 4U) << 4U | (x & 3U) << 4U | (y & 3U) << 2U |
           (z & 3U);
  }

  [[nodiscard]] std::uint64_t bytes() const {
    return BrickIndex::bytes() + words.size() * sizeof(std::uint16_t);
  }

 private:
  std::uint16_t* own_words(Index3 brick);
  void find_frontiers(const std::vector<Index3>& with_occupied);
  void mark_frontiers(Index3 brick);
  void find_cubes();
};

/// Whether occlusion distances are known, or why not.
enum class OcclusionKnown : std::uint8_t { yes, no_sensor, no_views };

/// The data of a ClassicMap.
struct ClassicMapData {
  std::shared_ptr<const VoxelScene> scene;
  ClassicTable table;
  OcclusionKnown occlusion = OcclusionKnown::no_sensor;
  double occlusion_depth = 0;  ///< [voxels]

  ClassicMapData(std::shared_ptr<const VoxelScene> s, const BeliefGrid& grid)
      : scene(std::move(s)), table(grid) {}
};

/// Gives this library access to the data of a ClassicMap.
struct ClassicAccess {
  [[nodiscard]] static const ClassicMapData& data(const ClassicMap& map) { return *map.data_; }
};

}  // namespace viewgain::detail
