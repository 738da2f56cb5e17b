// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The best views of a batch, exactly: all are scored.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "ranking.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

// What poses are chosen by, and as gains where it is the evaluator's own.
struct Scores {
  std::vector<ViewGain> gains;
  std::vector<double> worth;
  std::size_t scored = 0;
};

Scores scores_of(const GainEvaluator& evaluator, std::span<const Pose> T_world_camera,
                 const BestConfig& config, const BatchControl& control) {
  Scores scores;
  scores.worth.resize(T_world_camera.size());
  if (config.measure != nullptr) {
    scores.scored = evaluator.evaluate(T_world_camera, scores.worth, *config.measure, control);
  } else if (config.run_measure != nullptr) {
    scores.scored = evaluator.evaluate(T_world_camera, scores.worth, *config.run_measure, control);
  } else {
    scores.gains.resize(T_world_camera.size());
    scores.scored = evaluator.evaluate(T_world_camera, scores.gains, control);
    for (std::size_t i = 0; i < scores.worth.size(); ++i) scores.worth[i] = scores.gains[i].gain;
  }
  for (std::size_t i = 0; i < config.costs.size(); ++i) scores.worth[i] -= config.costs[i];
  return scores;
}

}  // namespace

namespace detail {

void check_costs(std::span<const double> costs, std::size_t poses) {
  if (!costs.empty() && costs.size() != poses) {
    throw Error(ErrorCode::invalid_argument,
                std::to_string(costs.size()) + " costs for " + std::to_string(poses) + " poses");
  }
  for (const double cost : costs) {
    if (!std::isfinite(cost)) {
      throw Error(ErrorCode::invalid_argument, "a cost is " + short_text(cost) + ", not finite");
    }
  }
}

std::vector<std::size_t> largest(std::span<const double> values, std::size_t k) {
  std::vector<std::size_t> indices(values.size());
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  k = std::min(k, indices.size());
  const auto better = [&](std::size_t a, std::size_t b) {
    const double ga = values[a], gb = values[b];
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

}  // namespace detail

std::vector<std::size_t> best_indices(std::span<const ViewGain> results, std::size_t k) {
  std::vector<double> gains;
  gains.reserve(results.size());
  for (const ViewGain& result : results) gains.push_back(result.gain);
  return detail::largest(gains, k);
}

BestViews GainEvaluator::best(std::span<const Pose> T_world_camera, std::size_t k,
                              const BestConfig& config, const BatchControl& control) const {
  detail::check_costs(config.costs, T_world_camera.size());
  if (config.measure != nullptr && config.run_measure != nullptr) {
    throw Error(ErrorCode::invalid_argument, "views are chosen by one measure, not by two");
  }
  BestViews best;
  if (k == 0 || T_world_camera.empty()) return best;
  const Scores scores = scores_of(*this, T_world_camera, config, control);
  best.complete = scores.scored == T_world_camera.size();
  best.indices = detail::largest(scores.worth, k);
  if (!best.complete) {
    // Those that were not reached look like bad poses, which come last.
    std::erase_if(best.indices, [&](std::size_t i) { return std::isnan(scores.worth[i]); });
  }
  for (const std::size_t i : best.indices) {
    if (!scores.gains.empty()) best.gains.push_back(scores.gains[i]);
    best.worth.push_back(scores.worth[i]);
  }
  return best;
}

}  // namespace viewgain
