// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "approximate_bench.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "environment.hpp"
#include "measure.hpp"
#include "support/camel_scene.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kViewsOfCamel = 3;
constexpr double kDistance = 0.6;  // of the views from the centre [m]
constexpr std::array kStrides{2, 3, 4, 6, 8, 12};
constexpr std::array kShares{0.02, 0.05, 0.1, 0.2, 0.4};

/// One way to score all poses.
struct Way {
  std::string name;
  const char* kind;  // "full", "stride" or "share"
  double parameter;
  std::function<void()> run;
  std::vector<double> gains;
  std::vector<double> standard_errors;  // empty: it has none
  std::vector<double> seconds;
};

std::size_t index_of_largest(const std::vector<double>& values) {
  return static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
}

Json to_json(const Way& way, const Way& full) {
  const double seconds = median(way.seconds);
  Json json{{"name", way.name},
            {"kind", way.kind},
            {"parameter", way.parameter},
            {"poses_per_second", static_cast<double>(way.gains.size()) / seconds},
            {"speed_over_full", median(full.seconds) / seconds},
            {"rank_correlation", rank_correlation(way.gains, full.gains)}};
  // What is lost if the pose that seems best is taken.
  const double best = full.gains[index_of_largest(full.gains)];
  json["regret"] = best > 0 ? 1 - full.gains[index_of_largest(way.gains)] / best : 0.0;
  json["mean_error"] = nullptr;
  json["within_two_standard_errors"] = nullptr;
  if (way.standard_errors.empty()) return json;
  double error = 0;
  std::size_t within = 0;
  for (std::size_t i = 0; i < way.gains.size(); ++i) {
    const double off = std::abs(way.gains[i] - full.gains[i]);
    error += off / std::max(full.gains[i], 1e-9 * best);
    within += off <= 2 * way.standard_errors[i] ? 1 : 0;
  }
  const auto n = static_cast<double>(way.gains.size());
  json["mean_error"] = error / n;
  json["within_two_standard_errors"] = static_cast<double>(within) / n;
  return json;
}

void print_table(const Json& json) {
  std::printf("%s, %s, %s, %d threads\n\n", json["scene"].get<std::string>().c_str(),
              json["isa"].get<std::string>().c_str(), json["cpu"].get<std::string>().c_str(),
              json["threads"].get<int>());
  std::printf("%-12s %10s %8s %10s %8s %11s %10s\n", "", "poses/s", "speed", "rank corr.", "regret",
              "mean error", "in 2 s.e.");
  for (const Json& w : json["ways"]) {
    std::printf("%-12s %10.0f %8.2f %10.5f %8.5f", w["name"].get<std::string>().c_str(),
                w["poses_per_second"].get<double>(), w["speed_over_full"].get<double>(),
                w["rank_correlation"].get<double>(), w["regret"].get<double>());
    if (!w["mean_error"].is_null()) {
      std::printf(" %11.4f %10.3f", w["mean_error"].get<double>(),
                  w["within_two_standard_errors"].get<double>());
    }
    std::printf("\n");
  }
}

}  // namespace

int run_approximate(const ApproximateOptions& options) {
  const ExecConfig exec{.num_threads = ThreadPool(options.num_threads).num_threads()};
  const auto views = test::camel_views(kViewsOfCamel, options.mesh);
  const auto scene = VoxelScene::build(test::camel_grid(options.voxels, views), {}, exec);
  const Sensor sensor = sensor_preset("sr4000");
  const auto count = static_cast<std::size_t>(options.poses);
  const std::vector<Pose> poses = sphere_poses(count, kDistance);
  std::vector<ViewGain> scored(count);
  std::vector<ApproximateGain> estimated(count);

  std::vector<GainEvaluator> evaluators;
  evaluators.emplace_back(scene, sensor, GainConfig{.model = GainModel::paper}, exec);
  for (const int stride : kStrides) {
    evaluators.emplace_back(scene, sensor,
                            GainConfig{.model = GainModel::paper, .pixel_stride = stride}, exec);
  }
  std::vector<Way> ways;
  const auto add_exact = [&](const std::string& name, const char* kind, int stride,
                             const GainEvaluator& evaluator) {
    ways.push_back({name,
                    kind,
                    static_cast<double>(stride),
                    [&] { (void)evaluator.evaluate(poses, scored); },
                    {},
                    {},
                    {}});
  };
  add_exact("full", "full", 1, evaluators[0]);
  for (std::size_t i = 0; i < kStrides.size(); ++i) {
    add_exact("stride " + std::to_string(kStrides[i]), "stride", kStrides[i], evaluators[i + 1]);
  }
  for (const double share : kShares) {
    const int percent = static_cast<int>(std::lround(100 * share));
    ways.push_back(
        {std::to_string(percent) + " % of rays",
         "share",
         share,
         [&, share] { (void)evaluators[0].approximate(poses, estimated, {.share = share}); },
         {},
         {},
         {}});
  }

  for (int repetition = -1; repetition < options.repetitions; ++repetition) {
    for (Way& way : ways) {
      const double seconds = seconds_of(way.run);
      if (repetition >= 0) {
        way.seconds.push_back(seconds);
        continue;
      }
      const bool is_estimate = std::string_view(way.kind) == "share";
      for (std::size_t i = 0; i < count; ++i) {
        way.gains.push_back(is_estimate ? estimated[i].gain : scored[i].gain);
        if (is_estimate) way.standard_errors.push_back(estimated[i].standard_error);
      }
    }
  }

  Json json;
  json["scene"] = "camel-" + std::to_string(options.voxels);
  add_environment(json, exec.num_threads);
  json["poses"] = count;
  json["repetitions"] = options.repetitions;
  json["ways"] = Json::array();
  for (const Way& way : ways) json["ways"].push_back(to_json(way, ways.front()));
  if (options.json) {
    std::printf("%s\n", json.dump(2).c_str());
  } else {
    print_table(json);
  }
  return 0;
}

}  // namespace viewgain::bench
