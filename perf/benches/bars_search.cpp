// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later

// The best of many poses: by racing against scoring them all.
#include <algorithm>
#include <cstdio>
#include <numeric>

#include "bars.hpp"
#include "measure.hpp"
#include "model_maps.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::bench {
namespace {

constexpr double kRightShare = 0.95;
constexpr double kMostRegret = 0.01;

/// Racing for the best pose, over all maps.
struct Searches {
  std::vector<double> time_ratios;  ///< to scoring all, one a map
  std::vector<double> regrets;      ///< share of the best gain that the choice gives away
  std::size_t right = 0;            ///< the same index

  [[nodiscard]] double right_share() const {
    return static_cast<double>(right) / static_cast<double>(time_ratios.size());
  }
  [[nodiscard]] double most_regret() const {
    return *std::max_element(regrets.begin(), regrets.end());
  }
  void add(double time_ratio, std::size_t chosen, std::size_t best,
           const std::vector<ViewGain>& gains) {
    time_ratios.push_back(time_ratio);
    right += chosen == best ? 1 : 0;
    const double lost = gains[best].gain - gains[chosen].gain;
    regrets.push_back(gains[best].gain > 0 ? lost / gains[best].gain : 0);
  }
  [[nodiscard]] std::string note() const {
    char text[160];
    std::snprintf(
        text, sizeof text,
        "%zu maps, the best in %zu, regret mean %.5f most %.5f, time p05 %.3f p95 %.3f",
        time_ratios.size(), right,
        std::accumulate(regrets.begin(), regrets.end(), 0.0) / static_cast<double>(regrets.size()),
        most_regret(), quantile(time_ratios, 0.05), quantile(time_ratios, 0.95));
    return text;
  }
};

struct Search {
  std::size_t chosen = 0;
  double seconds = 0;
};

/// Scores and races on one map, each once; odd maps in the other order.
void search(const GainEvaluator& evaluator, std::span<const Pose> poses, bool is_odd,
            Searches& raced) {
  std::vector<ViewGain> gains;
  // What each thread keeps from pose to pose is made before anything is timed.
  (void)evaluator.evaluate(poses.first(std::min<std::size_t>(poses.size(), 16)));
  const auto score_all = [&] {
    gains = evaluator.evaluate(poses);
    return best_indices(gains, 1).front();
  };
  const auto race = [&] { return evaluator.race(poses, 1).indices.at(0); };
  const auto timed = [](const auto& call) {
    Search result;
    result.seconds = seconds_of([&] { result.chosen = call(); });
    return result;
  };
  Search all, by_racing;
  if (is_odd) by_racing = timed(race), all = timed(score_all);
  if (!is_odd) all = timed(score_all), by_racing = timed(race);
  raced.add(by_racing.seconds / all.seconds, by_racing.chosen, all.chosen, gains);
}

}  // namespace

std::vector<Figure> search_figures(const BarsOptions& options) {
  const ExecConfig exec{.num_threads = options.num_threads};
  const std::vector<Pose> poses =
      sphere_poses(static_cast<std::size_t>(options.candidates), kModelDistance);
  const Sensor sensor = sensor_preset("sr4000");
  ModelMapPlan plan;
  plan.voxels = options.voxels;
  plan.most = static_cast<std::size_t>(options.maps);
  Searches raced;
  bool is_odd = false;
  for_each_model_map(plan, exec, [&](const ModelMap& map) {
    const GainEvaluator evaluator(map.scene, sensor, {.model = GainModel::paper}, exec);
    search(evaluator, poses, is_odd, raced);
    is_odd = !is_odd;
  });
  std::vector<Figure> figures;
  if (!raced.time_ratios.empty()) {
    const bool is_valid = raced.right_share() >= kRightShare && raced.most_regret() <= kMostRegret;
    figures.push_back({"race_over_exhaustive", median(raced.time_ratios), is_valid, raced.note()});
  }
  return figures;
}

}  // namespace viewgain::bench
