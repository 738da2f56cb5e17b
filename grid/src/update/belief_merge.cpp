// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "belief_merge.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "map/block_lattice.hpp"

namespace viewgain::detail {
namespace {

/// A copy of `block` (may be null) with room, and zero beliefs, for the voxels of `mask` that it
/// lacks; those that `mask` lacks are dropped.
std::shared_ptr<BeliefBlock> reshaped(const BeliefBlock* block, const LeafMask& mask) {
  auto result = std::make_shared<BeliefBlock>();
  result->mask = mask;
  result->beliefs.reserve(count_bits(mask));
  for_each_bit(mask, [&](unsigned offset) {
    const Belief* old = block != nullptr ? block->find(offset) : nullptr;
    result->beliefs.push_back(old != nullptr ? *old : Belief{});
  });
  return result;
}

void add(float& sum, double term) {
  constexpr double kLimit = std::numeric_limits<float>::max();
  sum = static_cast<float>(std::clamp(sum + term, -kLimit, kLimit));
}

}  // namespace

void sort_by_block(std::vector<Hit>& hits, std::vector<Hit>& scratch) {
  // Radix sort from the lowest digit: stable, and most keys have few digits that vary.
  constexpr unsigned kBits = 11;
  constexpr std::size_t kBuckets = std::size_t{1} << kBits;
  std::uint64_t varying = 0;
  for (const Hit& hit : hits) varying |= hit.block ^ hits.front().block;
  scratch.resize(hits.size());
  for (unsigned shift = 0; shift < 64 && varying >> shift != 0; shift += kBits) {
    if ((varying >> shift & (kBuckets - 1)) == 0) continue;
    std::array<std::uint32_t, kBuckets> position{};
    for (const Hit& hit : hits) ++position[hit.block >> shift & (kBuckets - 1)];
    std::uint32_t sum = 0;
    for (std::uint32_t& p : position) {
      const std::uint32_t count = p;
      p = sum;
      sum += count;
    }
    for (const Hit& hit : hits) scratch[position[hit.block >> shift & (kBuckets - 1)]++] = hit;
    hits.swap(scratch);
  }
}

std::shared_ptr<const BeliefBlock> with_belief(const BeliefBlock* block, unsigned offset,
                                               const Belief* belief) {
  LeafMask mask = block != nullptr ? block->mask : LeafMask{};
  const std::uint64_t bit = std::uint64_t{1} << (offset & 63U);
  if (belief != nullptr) {
    mask[offset >> 6U] |= bit;
  } else {
    mask[offset >> 6U] &= ~bit;
  }
  if (mask == LeafMask{}) return nullptr;
  auto result = reshaped(block, mask);
  if (belief != nullptr) result->beliefs[result->rank(offset)] = *belief;
  return result;
}

std::shared_ptr<const BeliefBlock> with_hits(const BeliefBlock* block, std::span<const Hit> hits,
                                             const Readings& pixels, const Pose& T_grid_readings,
                                             Index3 origin, double voxel_size) {
  LeafMask mask = block != nullptr ? block->mask : LeafMask{};
  for (const Hit& hit : hits) mask[hit.offset >> 6U] |= std::uint64_t{1} << (hit.offset & 63U);
  auto result = reshaped(block, mask);

  const Eigen::Matrix3d R_grid_readings = T_grid_readings.rotation();
  for (const Hit& hit : hits) {
    const Index3 voxel = offset_voxel(origin, hit.offset);
    const Eigen::Vector3d offset =
        T_grid_readings * pixels.point(hit.pixel) - voxel_center(voxel, voxel_size);
    const SymmetricMatrix3 information = measurement_information(
        R_grid_readings * pixels.direction(hit.pixel), pixels.sigmas(hit.pixel));
    const Eigen::Vector3d vector = information * offset;

    Belief& belief = result->beliefs[result->rank(hit.offset)];
    const double terms[6] = {information.xx, information.yy, information.zz,
                             information.xy, information.xz, information.yz};
    for (std::size_t i = 0; i < 6; ++i) add(belief.information[i], terms[i]);
    for (std::size_t i = 0; i < 3; ++i) {
      add(belief.information_vector[i], vector[static_cast<Eigen::Index>(i)]);
    }
    // The files hold the count as a signed integer.
    constexpr std::uint32_t kMostHits = std::numeric_limits<std::int32_t>::max();
    if (belief.hits < kMostHits) ++belief.hits;
  }
  return result;
}

}  // namespace viewgain::detail
