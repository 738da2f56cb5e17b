// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/grid/pooling.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "reading_sigma.hpp"
#include "viewgain/support/belief_block.hpp"

namespace viewgain {
namespace {

constexpr int kMostShift = 3;  // cubes stay within a leaf

// Median sigma of a reading across its ray [m]; 0 if nothing was read.
double footprint_in(const GridSnapshot& snapshot, std::optional<int> scale) {
  std::vector<float> variances;
  for (const GridSnapshot::Leaf& leaf : snapshot.leaves) {
    if (!leaf.beliefs || leaf.beliefs->scale != scale.value_or(leaf.beliefs->scale)) continue;
    std::size_t rank = 0;
    for_each_bit(leaf.beliefs->mask, [&](unsigned offset) {
      const Belief& belief = leaf.beliefs->beliefs[rank++];
      if (belief.hits == 0 || !test_bit(leaf.occupied, offset)) return;
      variances.push_back(
          static_cast<float>(detail::lateral_variance(belief.information_matrix(), belief.hits)));
    });
  }
  if (variances.empty()) return 0;
  const auto middle = variances.begin() + static_cast<std::ptrdiff_t>(variances.size() / 2);
  std::nth_element(variances.begin(), middle, variances.end());
  return std::sqrt(static_cast<double>(*middle));
}

}  // namespace

Pooling pooling_of(const GridSnapshot& snapshot, std::optional<int> scale) {
  const double footprint = footprint_in(snapshot, scale);
  Pooling pooling{scale.value_or(0), std::ldexp(snapshot.voxel_size, scale.value_or(0))};
  while (pooling.shift < kMostShift && pooling.length * std::numbers::sqrt2 < footprint) {
    ++pooling.shift;
    pooling.length *= 2;
  }
  pooling.length = std::max(pooling.length, footprint);
  return pooling;
}

}  // namespace viewgain
