// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "belief_merge.hpp"

#include <algorithm>
#include <limits>

#include "map/belief_blocks.hpp"
#include "viewgain/support/block_lattice.hpp"

namespace viewgain::detail {
namespace {

void add(float& sum, double term) {
  constexpr double kLimit = std::numeric_limits<float>::max();
  sum = static_cast<float>(std::clamp(sum + term, -kLimit, kLimit));
}

}  // namespace

std::shared_ptr<const BeliefBlock> with_hits(const BeliefBlock* block, std::span<const Hit> hits,
                                             const Readings& pixels, const Pose& T_grid_readings,
                                             Index3 origin, double voxel_size, int scale) {
  LeafMask mask = block != nullptr ? block->mask : LeafMask{};
  for (const Hit& hit : hits) set_bit(mask, hit.offset);
  auto result = reshaped(block, mask);
  result->scale = static_cast<std::uint8_t>(scale);

  const Eigen::Matrix3d R_grid_readings = T_grid_readings.rotation();
  for (const Hit& hit : hits) {
    const Index3 voxel = offset_voxel(origin, hit.offset);
    const Eigen::Vector3d offset =
        T_grid_readings * pixels.point(hit.pixel) - voxel_center(voxel, voxel_size, scale);
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
