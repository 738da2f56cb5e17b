// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "choose_bench.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numeric>

#include "environment.hpp"
#include "measure.hpp"
#include "model_maps.hpp"
#include "support/room_scene.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/hash64.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kRoomVoxel = 0.02;                         // of the room made in memory [m]
constexpr std::size_t kOfASubset = 100, kOfAnObject = 100;  // poses
constexpr int kTimedSubsets = 6;
constexpr std::array kShares{0.02, 0.05, 0.1, 0.2, 0.5, 1.0};
constexpr std::array<std::size_t, 3> kBatches{1, 10, 1000};
// What must hold.
constexpr double kFound = 0.95, kMostGivenAway = 0.02;
constexpr double kMostTime = 0.5;
constexpr double kLeastWithin = 0.90, kMostWithin = 0.97;

/// Choices of the best of a set of poses.
struct Races {
  std::size_t sets = 0, found = 0;
  double most_given_away = 0;
  std::vector<double> time_ratios;  // to scoring all

  void add(double chosen, double best) {
    ++sets;
    found += chosen == best ? 1 : 0;
    if (best > 0) most_given_away = std::max(most_given_away, 1 - chosen / best);
  }
  [[nodiscard]] Json json() const {
    const double share = static_cast<double>(found) / static_cast<double>(sets);
    const double time = median(time_ratios);
    return {{"sets", sets},
            {"best_found", share},
            {"most_given_away", most_given_away},
            {"time_over_all", time},
            {"pass", share >= kFound && most_given_away <= kMostGivenAway && time <= kMostTime}};
  }
};

/// Estimates of one share of the rays, in batches of some size.
struct Estimates {
  double share = 0;
  std::size_t batch = 0, count = 0, within = 0;
  double error = 0, off = 0;  // sums of relative ones

  void add(const ApproximateGain& estimate, double truth) {
    if (std::isnan(truth)) return;
    ++count;
    const double difference = estimate.gain - truth;
    within += std::abs(difference) <= 2 * estimate.standard_error ? 1 : 0;
    if (truth > 0) error += std::abs(difference) / truth, off += difference / truth;
  }
  [[nodiscard]] Json json() const {
    const auto n = static_cast<double>(count);
    const double part = static_cast<double>(within) / n;
    return {{"share", share},
            {"batch", batch},
            {"estimates", count},
            {"within_two_standard_errors", part},
            {"mean_error", error / n},
            {"bias", off / n},
            {"pass", share == 1 ? part == 1 : part >= kLeastWithin && part <= kMostWithin}};
  }
};

std::vector<Estimates> all_estimates() {
  std::vector<Estimates> list;
  for (const double share : kShares) {
    // At a share of 1 there is no estimate, and batches need not be told apart.
    for (const std::size_t batch : kBatches) {
      if (share < 1 || batch == kBatches.back()) list.push_back({share, batch});
    }
  }
  return list;
}

/// Every batch has a seed of its own.
void estimate(const GainEvaluator& evaluator, std::span<const Pose> poses,
              std::span<const ViewGain> truth, std::uint64_t seed, Estimates& estimates) {
  for (std::size_t first = 0; first < poses.size(); first += estimates.batch) {
    const auto some = poses.subspan(first, std::min(estimates.batch, poses.size() - first));
    std::vector<ApproximateGain> gains(some.size());
    evaluator.approximate(some, gains, {.share = estimates.share, .seed = mix64(seed) + first});
    for (std::size_t i = 0; i < some.size(); ++i) estimates.add(gains[i], truth[first + i].gain);
  }
}

std::vector<std::size_t> subset(std::size_t poses, std::uint64_t seed) {
  std::vector<std::size_t> order(poses);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return mix64(mix64(seed) + a) < mix64(mix64(seed) + b);
  });
  order.resize(std::min(kOfASubset, order.size()));
  return order;
}

Json entry(const std::string& scene, const std::string& sensor, Json races,
           const std::vector<Estimates>& estimates) {
  Json list = Json::array();
  for (const Estimates& e : estimates) list.push_back(e.json());
  return {{"scene", scene}, {"sensor", sensor}, {"race", std::move(races)}, {"approximate", list}};
}

void in_a_room(const ChooseOptions& options, const ExecConfig& exec, Json& entries) {
  const BeliefGrid grid = options.map.empty()
                              ? test::room_grid(kRoomVoxel, sensor_preset("kinect_v1"), 8, exec)
                              : load_vdb(options.map);
  const auto scene = VoxelScene::build(grid, {}, exec);
  const std::vector<Pose> poses =
      test::poses_in(scene->snapshot(), static_cast<std::size_t>(options.poses), options.seed);
  for (const char* name : {"kinect_v1", "d435", "sr4000"}) {
    const GainEvaluator evaluator(scene, sensor_preset(name),
                                  {.model = parse_gain_model(options.gain)}, exec);
    const std::vector<ViewGain> truth = evaluator.evaluate(poses);
    Races races;
    for (int i = 0; i < options.subsets; ++i) {
      const std::uint64_t seed = mix64(options.seed) + static_cast<std::uint64_t>(i);
      std::vector<Pose> some;
      double best = 0;
      for (const std::size_t j : subset(poses.size(), seed)) {
        some.push_back(poses[j]);
        best = std::max(best, truth[j].gain);
      }
      BestViews raced;
      const double of_race = seconds_of([&] { raced = evaluator.race(some, 1, {.seed = seed}); });
      races.add(raced.gains.at(0).gain, best);
      if (i < kTimedSubsets) {
        races.time_ratios.push_back(of_race / seconds_of([&] { (void)evaluator.evaluate(some); }));
      }
    }
    std::vector<Estimates> estimates = all_estimates();
    for (Estimates& e : estimates) estimate(evaluator, poses, truth, options.seed, e);
    entries.push_back(entry(options.map.empty() ? "room" : options.map.filename().string(), name,
                            races.json(), estimates));
  }
}

/// Estimates alone: `bars` has the races.
void on_objects(const ChooseOptions& options, const ExecConfig& exec, Json& entries) {
  const std::vector<Pose> poses = sphere_poses(kOfAnObject, kModelDistance);
  ModelMapPlan plan;
  plan.most = static_cast<std::size_t>(options.maps);
  // Of maps that estimates were tuned on, and of the others.
  std::array<std::vector<Estimates>, 2> estimates{all_estimates(), all_estimates()};
  std::array<int, 2> maps{};
  for_each_model_map(plan, exec, [&](const ModelMap& map) {
    const std::size_t part = maps[0] < options.tuned_maps ? 0 : 1;
    ++maps[part];
    const GainEvaluator evaluator(map.scene, sensor_preset("sr4000"),
                                  {.model = parse_gain_model(options.gain)}, exec);
    const std::vector<ViewGain> truth = evaluator.evaluate(poses);
    const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(maps[0] + maps[1]);
    for (Estimates& e : estimates[part]) estimate(evaluator, poses, truth, seed, e);
  });
  for (const std::size_t part : {0, 1}) {
    if (maps[part] == 0) continue;
    entries.push_back(
        entry(part == 0 ? "objects tuned on" : "objects", "sr4000", nullptr, estimates[part]));
  }
}

void print_table(const Json& json) {
  for (const Json& e : json["scenes"]) {
    const Json& race = e["race"];
    std::printf("%s, %s", e["scene"].get<std::string>().c_str(),
                e["sensor"].get<std::string>().c_str());
    if (!race.is_null()) {
      std::printf(
          ": %zu races; the best view was found in a share of %.3f, largest loss of gain %.4f, "
          "time relative to all rays %.3f  %s",
          race["sets"].get<std::size_t>(), race["best_found"].get<double>(),
          race["most_given_away"].get<double>(), race["time_over_all"].get<double>(),
          race["pass"].get<bool>() ? "pass" : "MISSED");
    }
    std::printf("\n");
    std::printf("  %6s %6s %9s %11s %8s\n", "share", "batch", "in 2 s.e.", "mean error", "bias");
    for (const Json& a : e["approximate"]) {
      std::printf("  %6g %6zu %9.3f %11.4f %8.4f  %s\n", a["share"].get<double>(),
                  a["batch"].get<std::size_t>(), a["within_two_standard_errors"].get<double>(),
                  a["mean_error"].get<double>(), a["bias"].get<double>(),
                  a["pass"].get<bool>() ? "pass" : "MISSED");
    }
  }
}

}  // namespace

int run_choose(const ChooseOptions& options) {
  const ExecConfig exec{.num_threads = ThreadPool(options.num_threads).num_threads()};
  Json json;
  add_environment(json, exec.num_threads);
  json["gain"] = options.gain;
  json["scenes"] = Json::array();
  if (options.maps > 0) {
    on_objects(options, exec, json["scenes"]);
  } else {
    in_a_room(options, exec, json["scenes"]);
  }
  bool is_missed = false;
  for (const Json& e : json["scenes"]) {
    const Json& race = e["race"];
    is_missed = is_missed || (!race.is_null() && !race["pass"].get<bool>());
    for (const Json& a : e["approximate"]) is_missed = is_missed || !a["pass"].get<bool>();
  }
  if (options.json) {
    std::printf("%s\n", json.dump(2).c_str());
  } else {
    print_table(json);
  }
  return is_missed ? 1 : 0;
}

}  // namespace viewgain::bench
