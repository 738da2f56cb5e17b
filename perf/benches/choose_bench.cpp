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
#include "viewgain/core/mix64.hpp"
#include "viewgain/core/thread_pool.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kRoomVoxel = 0.02;                          // of the room made in memory [m]
constexpr std::size_t kOfASubset = 100, kOfAnObject = 2000;  // poses
constexpr std::array kShares{0.02, 0.05, 0.1, 0.2, 0.5, 1.0};
constexpr std::array<std::size_t, 3> kBatches{1, 10, 1000};
// What must hold.
constexpr double kFound = 0.95, kMostGivenAway = 0.02;
constexpr double kMostTimeOfFew = 0.5, kMostTimeOfMany = 0.25;
constexpr double kLeastWithin = 0.90, kMostWithin = 0.97;

/// Choices of the best of a set of poses.
struct Races {
  std::size_t sets = 0, found = 0;
  double most_given_away = 0;
  std::vector<double> time_ratios;

  void add(double chosen, double best, double time_ratio) {
    ++sets;
    found += chosen == best ? 1 : 0;
    if (best > 0) most_given_away = std::max(most_given_away, 1 - chosen / best);
    time_ratios.push_back(time_ratio);
  }
  [[nodiscard]] Json json(double most_time) const {
    const double share = static_cast<double>(found) / static_cast<double>(sets);
    const double time = median(time_ratios);
    return {{"sets", sets},
            {"best_found", share},
            {"most_given_away", most_given_away},
            {"time_over_all", time},
            {"pass", share >= kFound && most_given_away <= kMostGivenAway && time <= most_time}};
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
    for (const std::size_t batch : kBatches) list.push_back({share, batch});
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

/// Scores and races, in turns which is first.
void race(const GainEvaluator& evaluator, std::span<const Pose> poses, std::uint64_t seed,
          Races& races) {
  std::vector<ViewGain> all;
  RacedViews raced;
  const auto score = [&] { return seconds_of([&] { all = evaluator.evaluate(poses); }); };
  const auto choose = [&] {
    return seconds_of([&] { raced = evaluator.race(poses, 1, {.seed = seed}); });
  };
  double of_all = 0, of_race = 0;
  if (races.sets % 2 == 0)
    of_all = score(), of_race = choose();
  else
    of_race = choose(), of_all = score();
  races.add(raced.gains.at(0).gain, all[best_indices(all, 1).at(0)].gain, of_race / of_all);
}

std::vector<Pose> subset(const std::vector<Pose>& poses, std::uint64_t seed) {
  std::vector<std::size_t> order(poses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return mix64(mix64(seed) + a) < mix64(mix64(seed) + b);
  });
  std::vector<Pose> some;
  for (std::size_t i = 0; i < std::min(kOfASubset, order.size()); ++i)
    some.push_back(poses[order[i]]);
  return some;
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
      race(evaluator, subset(poses, seed), seed, races);
    }
    std::vector<Estimates> estimates = all_estimates();
    for (Estimates& e : estimates) estimate(evaluator, poses, truth, options.seed, e);
    entries.push_back(entry(options.map.empty() ? "room" : options.map.filename().string(), name,
                            races.json(kMostTimeOfFew), estimates));
  }
}

void on_objects(const ChooseOptions& options, const ExecConfig& exec, Json& entries) {
  const std::vector<Pose> poses = sphere_poses(kOfAnObject, kModelDistance);
  const std::span<const Pose> few = std::span(poses).first(100);
  ModelMapPlan plan;
  plan.most = static_cast<std::size_t>(options.maps);
  Races races;
  std::vector<Estimates> estimates = all_estimates();
  for_each_model_map(plan, exec, [&](const ModelMap& map) {
    const GainEvaluator evaluator(map.scene, sensor_preset("sr4000"),
                                  {.model = parse_gain_model(options.gain)}, exec);
    const std::vector<ViewGain> truth = evaluator.evaluate(few);
    race(evaluator, poses, options.seed, races);
    for (Estimates& e : estimates) estimate(evaluator, few, truth, options.seed + races.sets, e);
  });
  entries.push_back(entry("objects", "sr4000", races.json(kMostTimeOfMany), estimates));
}

void print_table(const Json& json) {
  for (const Json& e : json["scenes"]) {
    const Json& race = e["race"];
    std::printf("%s, %s: race of %zu sets, best found %.3f, most given away %.4f, time %.3f  %s\n",
                e["scene"].get<std::string>().c_str(), e["sensor"].get<std::string>().c_str(),
                race["sets"].get<std::size_t>(), race["best_found"].get<double>(),
                race["most_given_away"].get<double>(), race["time_over_all"].get<double>(),
                race["pass"].get<bool>() ? "pass" : "MISSED");
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
    is_missed = is_missed || !e["race"]["pass"].get<bool>();
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
