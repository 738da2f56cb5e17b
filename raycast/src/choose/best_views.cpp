// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The best views of a batch, exactly: all are scored.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain {

std::vector<std::size_t> best_indices(std::span<const ViewGain> results, std::size_t k) {
  std::vector<std::size_t> indices(results.size());
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  k = std::min(k, indices.size());
  const auto better = [&](std::size_t a, std::size_t b) {
    const double ga = results[a].gain, gb = results[b].gain;
    if (std::isnan(ga) || std::isnan(gb)) {
      return std::isnan(ga) == std::isnan(gb) ? a < b : std::isnan(gb);
    }
    return ga != gb ? ga > gb : a < b;
  };
  std::partial_sort(indices.begin(), indices.begin() + static_cast<std::ptrdiff_t>(k),
                    indices.end(), better);
  indices.resize(k);
  return indices;
}

BestViews GainEvaluator::best(std::span<const Pose> T_world_camera, std::size_t k,
                              const BatchControl& control) const {
  BestViews best;
  if (k == 0 || T_world_camera.empty()) return best;
  std::vector<ViewGain> gains(T_world_camera.size());
  const std::size_t scored = evaluate(T_world_camera, gains, control);
  best.complete = scored == gains.size();
  best.indices = best_indices(gains, k);
  if (!best.complete) {
    // Those that were not reached look like bad poses, which come last.
    std::erase_if(best.indices, [&](std::size_t i) { return std::isnan(gains[i].gain); });
  }
  for (const std::size_t i : best.indices) best.gains.push_back(gains[i]);
  return best;
}

}  // namespace viewgain
