// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "gain_accumulator.hpp"

#include <cmath>
#include <limits>

namespace viewgain::detail {

GainAccumulator::GainAccumulator(const SceneData& scene, const GainSettings& settings,
                                 std::size_t max_rays)
    : VoxelSums(scene, settings, max_rays) {
  if (settings.criterion == Criterion::trace || !settings.weights.empty()) {
    each_.resize(max_rays + 2 * kOverhang);
  }
}

GainAccumulator::ClassGain GainAccumulator::explored() {
  LogProduct ratios, posterior;
  double* each = each_.empty() ? nullptr : each_.data();
  finish_unknown(ratios, settings().posterior_entropy ? &posterior : nullptr, each);
  return gain_of(unknown(), ratios, posterior, each);
}

GainAccumulator::ClassGain GainAccumulator::refined() {
  look_up();
  LogProduct ratios, posterior;
  double* each = each_.empty() ? nullptr : each_.data() + unknown().size() + kOverhang;
  finish_occupied(ratios, settings().posterior_entropy ? &posterior : nullptr, each);
  return gain_of(occupied(), ratios, posterior, each);
}

GainAccumulator::ClassGain GainAccumulator::gain_of(std::span<const std::uint32_t> members,
                                                    const LogProduct& ratios,
                                                    const LogProduct& posterior,
                                                    const double* each) const {
  const double left =
      settings().posterior_entropy ? posterior.log() : std::numeric_limits<double>::quiet_NaN();
  if (each == nullptr) return {0.5 * ratios.log(), left};
  const bool logarithmic = settings().criterion != Criterion::trace;
  double sum = 0;
  for (std::size_t i = 0; i < members.size(); ++i) {
    sum += weight(members[i]) * (logarithmic ? 0.5 * std::log(each[i]) : each[i]);
  }
  return {sum, left};
}

void GainAccumulator::finish(const ClassGain& explored, const ClassGain& refined,
                             ViewGain& result) const {
  result.exploration = explored.gain;
  result.refinement = refined.gain;
  result.gain = result.exploration + result.refinement;
  result.posterior_entropy = explored.posterior_entropy + refined.posterior_entropy;
  result.hits = hit_count();
  result.unknown_voxels = static_cast<std::uint32_t>(unknown().size());
  result.occupied_voxels = static_cast<std::uint32_t>(occupied().size());
}

}  // namespace viewgain::detail
