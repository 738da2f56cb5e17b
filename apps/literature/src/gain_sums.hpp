// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "classic_table.hpp"
#include "viewgain/literature/classic_gains.hpp"
#include "viewgain/support/isa.hpp"
#include "viewgain/support/log_odds_code.hpp"
#include "viewgain/support/walk_task.hpp"

namespace viewgain::detail {

/// Counts the distinct unknown voxels that the rays of a view pass, with one bit per voxel in nodes
/// of 128³. Nodes are allocated on first use and kept. Clearing costs no more than marking.
class DistinctVoxels {
 public:
  /// Starts another view; the table may have any size.
  void begin(const ClassicTable& table) {
    for (const Place& place : touched_) {
      Node& node = *nodes_[place.node];
      std::fill_n(node.bits.begin() + place.brick * std::size_t{8}, 8, 0);
      node.is_touched[place.brick] = 0;
    }
    touched_.clear();
    count_ = frontiers_ = 0;
    if (nodes_.size() < table.node_entries.size()) nodes_.resize(table.node_entries.size());
  }

  /// `place`: index of the brick in its node, times 512, plus any fixed numbering of voxels in a
  /// brick.
  void mark(std::uint32_t number, std::uint32_t place, std::uint32_t word) {
    std::unique_ptr<Node>& node = nodes_[number];
    if (!node) node = std::make_unique<Node>();
    const std::uint32_t brick = place >> 9U;
    if (node->is_touched[brick] == 0) {
      touched_.push_back({number, brick});  // first, so that an exception leaves no mark behind
      node->is_touched[brick] = 1;
    }
    std::uint64_t& bits = node->bits[place >> 6U];
    // Without a branch, because it would be unpredictable.
    const std::uint64_t is_new = ~bits >> (place & 63U) & 1U;
    bits |= is_new << (place & 63U);
    count_ += is_new;
    frontiers_ += is_new & word;
    static_assert(ClassicTable::kFrontier == 1);
  }

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] std::uint64_t frontiers() const { return frontiers_; }

 private:
  struct Node {
    std::array<std::uint64_t, std::size_t{4096} * 8> bits{};
    std::array<std::uint8_t, 4096> is_touched{};
  };
  struct Place {
    std::uint32_t node, brick;
  };
  std::vector<std::unique_ptr<Node>> nodes_;
  std::vector<Place> touched_;
  std::uint64_t count_ = 0, frontiers_ = 0;
};

/// Values of voxels by the code of their log-odds. q: probability that a voxel lets a ray pass.
struct VoxelValues {
  /// Codes of voxels that do not end a ray are below this.
  static constexpr std::size_t kPassed = 64;
  /// -log2 q in two parts. Integer multiples of the first part and their sums are exact in single
  /// precision. The second part is small, so its rounding does not matter.
  alignas(64) std::array<float, kPassed> absorbed{}, absorbed_rest{};
  /// H / (1 - q). For equal voxels in a row, Σ P H is this value times the decrease of P.
  alignas(64) std::array<float, kPassed> per_taken{};
  alignas(64) std::array<float, kPassed> passed_entropy{};  ///< H of codes below kPassed [nat]
  alignas(64) std::array<float, 128> entropy{};             ///< H of all codes [nat]

  explicit VoxelValues(const ClassicConfig& config);
};

/// Sums from which all gains of a view are computed. Lengths in voxels.
struct ClassicSums {
  double occlusion_aware = 0, unobserved = 0;
  double entropy = 0, voxels = 0;  ///< over the voxels of average_entropy
  double rear_side_entropy = 0;
  double proximity = 0;
  double volume = 0;  ///< Σ ω (exit³ - enter³) / 3
  std::uint64_t rear_side = 0;
  std::uint64_t on_surface = 0, on_hidden = 0;  ///< rays by class of area_factor
};

/// Data common to all views of a map.
struct ClassicView {
  const ClassicTable& table;
  const VoxelValues& values;
  double most_steps = 0;     ///< proximity_count: number from which a voxel's steps are subtracted
  bool is_distinct = false;  ///< whether to count distinct unknown voxels
};

/// Functions that walk a tile's rays through a ClassicTable.
struct ClassicKernels {
  /// Walks through all voxels in order up to the first occupied one, and adds their values.
  void (*add)(const ClassicView& view, const WalkLimits& limits, const WalkTask& task,
              ClassicSums& sums, DistinctVoxels& distinct);
  /// Walks to the first occupied voxel and `depth` [voxels] further. Marks the unknown voxels
  /// behind it with their number of steps. Changes `task`.
  void (*mark_hidden)(const ClassicTable& table, const WalkLimits& limits, float depth,
                      WalkTask& task, OcclusionSteps& steps);
};

/// `isa`: an instruction set that the CPU supports.
[[nodiscard]] const ClassicKernels& classic_kernels(Isa isa);

}  // namespace viewgain::detail
