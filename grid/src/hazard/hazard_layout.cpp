// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "hazard_layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "viewgain/core/error.hpp"
#include "viewgain/support/belief_block.hpp"

namespace viewgain::detail {
namespace {

// Minimum hits of a voxel, or cube of voxels, to be evidence of surface.
constexpr std::uint64_t kLeastHits = 3;
// Distance within which surface is not new [pooling lengths]. By rank correlation with the surface
// that views really show, 1.2 and 1.6 are equally good, and 2 and more are worse.
constexpr double kKnownDistance = 1.2;
constexpr double kMostReach = 127;  // of distances [cells]
constexpr std::uint64_t kMostCells = std::uint64_t{1} << 31U;

// The voxels with evidence of surface; those of a cube of 2^shift voxels per edge count together.
std::vector<Index3> evidence_in(const GridSnapshot& snapshot, int shift) {
  std::vector<Index3> voxels;
  std::vector<unsigned> occupied;
  std::array<std::uint64_t, 512> hits{};  // by the offset of a cube's lowest voxel
  for (const GridSnapshot::Leaf& leaf : snapshot.leaves) {
    if (!leaf.beliefs) continue;
    const int scale = leaf.beliefs->scale;
    const int cube = std::max(shift, scale);
    occupied.clear();
    std::size_t rank = 0;
    for_each_bit(leaf.beliefs->mask, [&](unsigned offset) {
      const Belief& belief = leaf.beliefs->beliefs[rank++];
      if (!test_bit(leaf.occupied, offset)) return;
      hits[cell_offset(offset, cube)] += belief.hits;
      occupied.push_back(offset);
    });
    for (const unsigned offset : occupied) {
      if (hits[cell_offset(offset, cube)] < kLeastHits) continue;
      for_each_in_cell(offset, scale,
                       [&](unsigned at) { voxels.push_back(offset_voxel(leaf.origin, at)); });
    }
    for (const unsigned offset : occupied) hits[cell_offset(offset, cube)] = 0;
  }
  return voxels;
}

// Bounding box of voxels; empty if there are none.
VoxelBox box_of(const std::vector<Index3>& voxels) {
  if (voxels.empty()) return {};
  VoxelBox box{voxels.front(), voxels.front()};
  for (const Index3& v : voxels) {
    box.min = {std::min(box.min.x, v.x), std::min(box.min.y, v.y), std::min(box.min.z, v.z)};
    box.max = {std::max(box.max.x, v.x), std::max(box.max.y, v.y), std::max(box.max.z, v.z)};
  }
  return {box.min, {box.max.x + 1, box.max.y + 1, box.max.z + 1}};
}

Index3 last_of(const VoxelBox& box) { return {box.max.x - 1, box.max.y - 1, box.max.z - 1}; }

Index3 moved(Index3 v, int by) { return {v.x + by, v.y + by, v.z + by}; }

int longest_side(const VoxelBox& box) {
  return std::max({box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z});
}

// log2 of the hazard cells' edge [voxels].
int shift_for(double decay_length, double voxel_size) {
  const double wanted = std::log2(0.28 * decay_length / voxel_size);
  return static_cast<int>(std::clamp(std::round(wanted), 0.0, 3.0));
}

}  // namespace

HazardLayout::HazardLayout(const GridSnapshot& snapshot, const HazardConfig& config)
    : pooling(pooling_of(snapshot)) {
  using Model = HazardConfig::Model;
  config.validate();
  evidence = evidence_in(snapshot, pooling.shift);
  const VoxelBox workspace = VoxelBox::from_dims(snapshot.min_index, snapshot.dims);
  const VoxelBox seen = evidence.empty() ? workspace : box_of(evidence);
  const double size = config.object_size.value_or(longest_side(seen) * snapshot.voxel_size);
  model = config.model.value_or(Model::for_size(size));
  follows_counters = config.calibrated && !config.model && !config.volume;
  shift = shift_for(model.decay_length, snapshot.voxel_size);
  if (evidence.empty()) return;
  const int edge = 1 << shift;
  const double cell = snapshot.voxel_size * edge;
  reach = static_cast<int>(std::clamp(Model::kCut * model.decay_length / cell, 1.0, kMostReach));
  open_reach =
      static_cast<int>(std::clamp(Model::kOpenReach * model.decay_length / cell, 1.0, 63.0));
  cells = VoxelBox{moved(cell_of(seen.min), -reach), moved(cell_of(last_of(seen)), reach + 1)}
              .intersection({cell_of(workspace.min), moved(cell_of(last_of(workspace)), 1)});
  voxels = {{cells.min.x * edge, cells.min.y * edge, cells.min.z * edge},
            {cells.max.x * edge, cells.max.y * edge, cells.max.z * edge}};
  if (cells.volume() > kMostCells) {
    throw Error(ErrorCode::capacity, "hazard: the known surface extends over " +
                                         std::to_string(cells.volume()) +
                                         " cells; the maximum is " + std::to_string(kMostCells));
  }
  // At least the neighbours of a cell with evidence.
  const double known = std::max(kKnownDistance * pooling.length / cell, 1.0);
  most_known = static_cast<std::uint32_t>(known * known);
}

}  // namespace viewgain::detail
