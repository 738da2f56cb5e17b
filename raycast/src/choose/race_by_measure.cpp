// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The best views of a batch by a measure of the user's own, very probably: in two stages.
#include "race_by_measure.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "ranking.hpp"

namespace viewgain::detail {
namespace {

// So many poses say how a measure of few rays compares with that of all.
constexpr std::size_t kAnchors = 8;

// Part of a batch, for a control that counts all of it.
BatchControl part_of(const BatchControl& control, std::size_t before, std::size_t total) {
  BatchControl part;
  part.stop = control.stop;
  part.is_cancelled = control.is_cancelled;
  if (control.progress) {
    part.progress = [&control, before, total](std::size_t done, std::size_t) {
      control.progress(before + done, total);
    };
  }
  return part;
}

std::vector<Pose> selected(std::span<const Pose> poses, std::span<const std::size_t> indices) {
  std::vector<Pose> result;
  result.reserve(indices.size());
  for (const std::size_t i : indices) result.push_back(poses[i]);
  return result;
}

// The median ratio of the measure by all rays to that by few.
double scale_between(const GainEvaluator& full, std::span<const Pose> poses,
                     std::span<const double> coarse, const RaceConfig& config) {
  std::vector<std::size_t> anchors;
  const std::size_t step = std::max<std::size_t>(1, poses.size() / kAnchors);
  for (std::size_t i = 0; i < poses.size(); i += step) anchors.push_back(i);
  std::vector<double> values(anchors.size()), ratios;
  measure(full, selected(poses, anchors), config, values, {});
  for (std::size_t j = 0; j < anchors.size(); ++j) {
    const double ratio = values[j] / coarse[anchors[j]];
    if (std::isfinite(ratio) && ratio > 0) ratios.push_back(ratio);
  }
  if (ratios.empty()) return 1;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return *middle;
}

}  // namespace

std::size_t measure(const GainEvaluator& evaluator, std::span<const Pose> poses,
                    const RaceConfig& config, std::span<double> values,
                    const BatchControl& control) {
  return config.measure != nullptr
             ? evaluator.evaluate(poses, values, *config.measure, control)
             : evaluator.evaluate(poses, values, *config.run_measure, control);
}

RacedViews race_by_measure(const GainEvaluator& full, const GainEvaluator* coarse,
                           std::span<const Pose> poses, std::size_t k, std::size_t few,
                           const RaceConfig& config, const BatchControl& control) {
  RacedViews best;
  std::vector<std::size_t> left(poses.size());
  std::iota(left.begin(), left.end(), std::size_t{0});
  const std::size_t first = coarse != nullptr && poses.size() > few ? poses.size() : 0;
  const std::size_t total = first + std::min(poses.size(), few);
  if (first > 0) {
    std::vector<double> worth(poses.size());
    const std::size_t done = measure(*coarse, poses, config, worth, part_of(control, 0, total));
    best.rays_traced = done * std::uint64_t{coarse->rays_per_pose()};
    if (done < poses.size()) {
      best.complete = false;
      return best;
    }
    if (!config.costs.empty()) {
      const double scale = scale_between(full, poses, worth, config);
      for (std::size_t i = 0; i < worth.size(); ++i) {
        worth[i] = scale * worth[i] - config.costs[i];
      }
    }
    left = largest(worth, few);
    std::sort(left.begin(), left.end());
  }
  std::vector<double> worth(left.size());
  const std::size_t done = measure(full, selected(poses, left), config, worth,
                                   part_of(control, first, first + left.size()));
  best.complete = done == left.size();
  best.rays_traced += done * std::uint64_t{full.rays_per_pose()};
  for (std::size_t j = 0; j < left.size(); ++j) {
    if (!config.costs.empty()) worth[j] -= config.costs[left[j]];
  }
  for (const std::size_t j : largest(worth, k)) {
    // Those that were not reached look like bad poses, which come last.
    if (!best.complete && std::isnan(worth[j])) continue;
    best.indices.push_back(left[j]);
    best.worth.push_back(worth[j]);
  }
  for (std::size_t j = 0; j < left.size(); ++j) {
    if (best.complete || !std::isnan(worth[j])) best.scored_indices.push_back(left[j]);
  }
  return best;
}

}  // namespace viewgain::detail
