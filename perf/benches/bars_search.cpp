// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later

// The best of many poses by racing, by each gain, against scoring them all by the paper's gain.
#include <algorithm>
#include <array>
#include <cstdio>
#include <numeric>

#include "bars.hpp"
#include "measure.hpp"
#include "model_maps.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::bench {
namespace {

constexpr double kRightShare = 0.95;  // of the maps
constexpr double kMostRegret = 0.01;  // of a choice that is right

/// What the choices by one model took and gave away, a map an entry.
struct Choices {
  std::vector<double> time_ratios, regrets;

  void add(double time_ratio, double chosen, double best) {
    time_ratios.push_back(time_ratio);
    regrets.push_back(best > 0 ? (best - chosen) / best : 0);
  }
  [[nodiscard]] std::size_t within(double regret) const {
    return static_cast<std::size_t>(
        std::count_if(regrets.begin(), regrets.end(), [&](double r) { return r <= regret; }));
  }
  /// Valid if on all but some maps no more is given away than `regret`, and nowhere over `most`.
  [[nodiscard]] Figure figure(const char* name, double regret, double most) const {
    const auto maps = static_cast<double>(regrets.size());
    const double worst = *std::max_element(regrets.begin(), regrets.end());
    char text[200];
    std::snprintf(text, sizeof text,
                  "%zu maps: within 1 %% of the best gain in %zu, the best view in %zu; mean loss "
                  "%.5f, largest %.5f; relative time p05 %.3f, p95 %.3f",
                  regrets.size(), within(kMostRegret), within(0),
                  std::accumulate(regrets.begin(), regrets.end(), 0.0) / maps, worst,
                  quantile(time_ratios, 0.05), quantile(time_ratios, 0.95));
    const bool is_right = static_cast<double>(within(regret)) >= kRightShare * maps;
    return {name, median(time_ratios), is_right && worst <= most, text};
  }
};

}  // namespace

std::vector<Figure> search_figures(const BarsOptions& options) {
  const ExecConfig exec{.num_threads = options.num_threads};
  const std::vector<Pose> poses =
      sphere_poses(static_cast<std::size_t>(options.candidates), kModelDistance);
  const std::span<const Pose> few = std::span(poses).first(std::min<std::size_t>(poses.size(), 16));
  const Sensor sensor = sensor_preset("sr4000");
  ModelMapPlan plan;
  plan.voxels = options.voxels;
  plan.most = static_cast<std::size_t>(options.maps);
  constexpr std::array kModels{GainModel::paper, GainModel::surface, GainModel::combined};
  std::array<Choices, kModels.size()> choices;
  for_each_model_map(plan, exec, [&](const ModelMap& map) {
    const GainEvaluator paper(map.scene, sensor, {.model = GainModel::paper}, exec);
    // What each thread keeps from pose to pose, and what the scene makes once, is there beforehand.
    (void)paper.evaluate(few);
    std::vector<ViewGain> by_paper;
    const double all_by_paper = seconds_of([&] { by_paper = paper.evaluate(poses); });
    // The combined gain of a view has the surface gain in it: one pass tells the best by both.
    std::array<double, kModels.size()> best{};
    const GainEvaluator combined(map.scene, sensor, {.model = GainModel::combined}, exec);
    const std::vector<ViewGain> by_both = combined.evaluate(poses);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      best[0] = std::max(best[0], by_paper[i].gain);
      best[1] = std::max(best[1], by_both[i].area);
      best[2] = std::max(best[2], by_both[i].gain);
    }
    for (std::size_t i = 0; i < kModels.size(); ++i) {
      const GainEvaluator evaluator(map.scene, sensor, {.model = kModels[i]}, exec);
      (void)evaluator.evaluate(few);
      BestViews raced;
      const double seconds = seconds_of([&] { raced = evaluator.race(poses, 1); });
      choices[i].add(seconds / all_by_paper, raced.gains.at(0).gain, best[i]);
    }
  });
  if (choices[0].regrets.empty()) return {};
  return {choices[0].figure("race_over_exhaustive", 0, kMostRegret),
          choices[1].figure("stages_over_paper", kMostRegret, 1),
          choices[2].figure("stages_over_paper_combined", kMostRegret, 1)};
}

}  // namespace viewgain::bench
