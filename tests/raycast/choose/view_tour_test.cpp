// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// plan_tour() against plain greed, by the values that best_set() gives to sets.
#include "viewgain/raycast/view_tour.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <stop_token>

#include "core/expect_error.hpp"
#include "raycast/scene_makers.hpp"

namespace viewgain {
namespace {

using test::expect_error;

constexpr double kNoWay = std::numeric_limits<double>::infinity();
constexpr std::size_t kPoses = 14;

struct Made {
  test::Random random;
  test::RandomMap map = test::random_map(test::MapFamily::tiles_8, random);
  Sensor sensor = test::random_sensor(map.grid, random);
  std::shared_ptr<const VoxelScene> scene = VoxelScene::build(map.grid);
  std::vector<Pose> poses;

  explicit Made(std::uint64_t seed) : random(seed) {
    poses = test::random_poses(map, kPoses, random);
  }
};

// Ways by table, of which a share leads nowhere; the start's are the last row.
WayCost random_ways(double share_without, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> table;
  for (std::size_t i = 0; i < (kPoses + 1) * kPoses; ++i) {
    table.push_back(uniform(random) < share_without ? kNoWay : 0.2 + uniform(random));
  }
  return [table](std::size_t from, std::size_t to) {
    return table[std::min(from, kPoses) * kPoses + to];
  };
}

Tour through(const std::vector<std::size_t>& stops, const WayCost& way) {
  return order_stops(stops.size(), [&](std::size_t from, std::size_t to) {
    return way(from == kTourStart ? kTourStart : stops[from], stops[to]);
  });
}

// The least that a stop adds to the way of the best order, by trying all places.
double added_way(const std::vector<std::size_t>& chosen, std::size_t stop, const WayCost& way) {
  if (chosen.empty()) return way(kTourStart, stop);
  const Tour tour = through(chosen, way);
  double least = kNoWay;
  for (std::size_t place = 0; place <= chosen.size(); ++place) {
    std::vector<std::size_t> with;
    for (const std::size_t at : tour.stops) with.push_back(chosen[at]);
    with.insert(with.begin() + static_cast<std::ptrdiff_t>(place), stop);
    double sum = 0;
    std::size_t from = kTourStart;
    for (const std::size_t to : with) sum += way(std::exchange(from, to), to);
    least = std::min(least, sum);
  }
  return std::max(least - tour.cost, 0.0);
}

struct Choice {
  std::vector<std::size_t> stops;
  std::vector<double> worth;
};

Choice by_plain_greed(const GainEvaluator& evaluator, const Made& made, const TourConfig& config) {
  const auto value_of = [&](const std::vector<std::size_t>& set) {
    std::vector<Pose> poses;
    for (const std::size_t i : set) poses.push_back(made.poses[i]);
    return evaluator.best_set(poses, poses.size()).gain;
  };
  Choice choice;
  while (choice.stops.size() < config.max_stops) {
    const double before = choice.stops.empty() ? 0 : value_of(choice.stops);
    const double so_far = choice.stops.empty() ? 0 : through(choice.stops, config.way).cost;
    double most = -kNoWay, worth_of_best = 0;
    std::size_t best = kPoses;
    for (std::size_t i = 0; i < kPoses; ++i) {
      if (std::count(choice.stops.begin(), choice.stops.end(), i) > 0) continue;
      std::vector<std::size_t> with = choice.stops;
      with.push_back(i);
      const double gain = value_of(with) - before;
      const double way = added_way(choice.stops, i, config.way);
      if (!(gain > 1e-12) || !(so_far + way <= config.budget) || way == kNoWay) continue;
      const double worth = gain - config.cost_per_way * way;
      const double rank = config.per_way && worth > 0 ? worth / way : worth;
      if (rank <= most) continue;
      most = rank, worth_of_best = worth, best = i;
    }
    if (best == kPoses || (!choice.stops.empty() && worth_of_best <= 0)) break;
    choice.stops.push_back(best);
    choice.worth.push_back(worth_of_best);
  }
  return choice;
}

TEST(ViewTour, IsPlainGreedsWithinItsBudget) {
  int cases = 0, longer = 0, ended_early = 0, with_vetoes = 0;
  for (std::uint64_t seed = 300; seed < 303; ++seed) {
    const Made made(seed);
    for (const GainModel model : {GainModel::surface, GainModel::paper}) {
      const GainEvaluator evaluator(made.scene, made.sensor, {.model = model});
      const double gain = evaluator.best_set(made.poses, 1).gain;
      if (!(gain > 0)) continue;
      for (const double share_without : {0.0, 0.5}) {
        const WayCost way = random_ways(share_without, seed);
        for (const TourConfig& config :
             {TourConfig{.max_stops = 4, .way = way, .cost_per_way = 0.3 * gain},
              TourConfig{.max_stops = 5, .way = way, .budget = 1.5},
              TourConfig{.way = way, .budget = 1.2, .per_way = true}}) {
          const ViewTour tour = plan_tour(evaluator, made.poses, config);
          const Choice expected = by_plain_greed(evaluator, made, config);
          ASSERT_EQ(tour.set.indices, expected.stops) << seed;
          for (std::size_t i = 0; i < expected.worth.size(); ++i) {
            EXPECT_NEAR(tour.worth[i], expected.worth[i], 1e-6 * gain);
          }
          EXPECT_NEAR(tour.tour.cost, through(expected.stops, way).cost, 1e-12);
          EXPECT_LE(tour.tour.cost, config.budget);
          EXPECT_EQ(tour.tour.stops.size(), expected.stops.size());
          ++cases;
          longer += expected.stops.size() >= 3 ? 1 : 0;
          ended_early += expected.stops.size() < std::min(config.max_stops, kPoses) ? 1 : 0;
          with_vetoes += share_without > 0 && !expected.stops.empty() ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GE(cases, 30);
  EXPECT_GE(longer, 10);
  EXPECT_GE(ended_early, 10);
  EXPECT_GE(with_vetoes, 10);
}

class Tours : public testing::TestWithParam<GainModel> {};

TEST_P(Tours, WithoutWaysAreBestSetsAndThreadsChangeNothing) {
  const Made made(310);
  const GainEvaluator one(made.scene, made.sensor, {.model = GetParam()}, {.num_threads = 1});
  const GainEvaluator three(made.scene, made.sensor, {.model = GetParam()}, {.num_threads = 3});
  const ViewSet set = one.best_set(made.poses, 4);
  const ViewTour free = plan_tour(one, made.poses, {.max_stops = 4});
  EXPECT_EQ(free.set.indices, set.indices);
  EXPECT_EQ(free.set.gain, set.gain);
  EXPECT_EQ(free.tour.stops, (std::vector<std::size_t>{0, 1, 2, 3}));
  EXPECT_EQ(free.tour.cost, 0);
  const std::vector<ViewGain> alone = one.evaluate(made.poses);
  ASSERT_EQ(free.alone.size(), kPoses);
  for (std::size_t i = 0; i < kPoses; ++i) EXPECT_EQ(free.alone[i].gain, alone[i].gain);

  const TourConfig config{
      .max_stops = 5, .way = random_ways(0.2, 1), .cost_per_way = 0.1 * set.gain};
  const ViewTour some = plan_tour(one, made.poses, config),
                 same = plan_tour(three, made.poses, config);
  EXPECT_GE(some.set.indices.size(), 2U);
  EXPECT_EQ(some.set.indices, same.set.indices);
  EXPECT_EQ(some.worth, same.worth);
  EXPECT_EQ(some.tour.stops, same.tour.stops);
  EXPECT_EQ(some.tour.cost, same.tour.cost);
}

INSTANTIATE_TEST_SUITE_P(Gains, Tours,
                         testing::Values(GainModel::paper, GainModel::surface, GainModel::combined),
                         [](const auto& gain) { return std::string(gain_model_name(gain.param)); });

TEST(ViewTour, FewRaysChooseNearlyAsWell) {
  int maps = 0;
  double least = 1, sum = 0;
  for (std::uint64_t seed = 320; seed < 332; ++seed) {
    const Made made(seed);
    const GainEvaluator evaluator(made.scene, made.sensor, {.model = GainModel::surface});
    const ViewTour all = plan_tour(evaluator, made.poses, {.max_stops = 3});
    if (all.set.indices.size() < 3) continue;
    const ViewTour some = plan_tour(evaluator, made.poses, {.max_stops = 3, .share = 0.25});
    std::vector<Pose> chosen;
    for (const std::size_t i : some.set.indices) chosen.push_back(made.poses[i]);
    const double share = evaluator.best_set(chosen, chosen.size()).gain / all.set.gain;
    least = std::min(least, share);
    sum += share;
    ++maps;
  }
  RecordProperty("least", std::to_string(least));
  RecordProperty("mean", std::to_string(sum / maps));
  EXPECT_GE(maps, 9);
  EXPECT_GE(least, 0.8);
  EXPECT_GE(sum / maps, 0.95);
}

TEST(ViewTour, AGivenFirstStopIsFirstAndTheOthersAddToIt) {
  const Made made(313);
  const GainEvaluator evaluator(made.scene, made.sensor, {.model = GainModel::surface});
  const std::vector<double> dear(kPoses, 0.2 * evaluator.best_set(made.poses, 1).gain);
  int given = 0;
  for (std::size_t first = 0; first < kPoses; ++first) {
    TourConfig config{.max_stops = 3, .first = first, .costs = dear};
    const ViewTour tour = plan_tour(evaluator, made.poses, config);
    ASSERT_FALSE(tour.set.indices.empty());
    EXPECT_EQ(tour.set.indices[0], first);
    EXPECT_DOUBLE_EQ(tour.worth[0], tour.set.marginal[0].gain - dear[first]);
    for (std::size_t j = 1; j < tour.worth.size(); ++j) {
      EXPECT_GT(tour.worth[j], 0);
      if (j > 1) {
        EXPECT_LE(tour.worth[j], tour.worth[j - 1]);
      }
    }
    // In haste it is among the few that are looked at.
    config.max_candidates = 4;
    EXPECT_EQ(plan_tour(evaluator, made.poses, config).set.indices[0], first);
    ++given;
  }
  EXPECT_EQ(given, int(kPoses));
}

TEST(ViewTour, LimitsAndOddRequestsAreTaken) {
  const Made made(311);
  const GainEvaluator evaluator(made.scene, made.sensor, {.model = GainModel::surface});
  const ViewSet set = evaluator.best_set(made.poses, kPoses);
  // Until a view adds less than the third one did.
  const double least = std::nextafter(set.marginal[2].area, 1.0);
  EXPECT_EQ(plan_tour(evaluator, made.poses, {.least_area = least}).set.indices.size(), 2U);
  // The first whatever it costs, no second that is not worth it.
  const std::vector<double> dear(kPoses, 10 * set.gain);
  const ViewTour one = plan_tour(evaluator, made.poses, {.costs = dear});
  EXPECT_EQ(one.set.indices, std::vector<std::size_t>{set.indices[0]});
  EXPECT_LT(one.worth[0], 0);
  const WayCost nowhere = [](std::size_t, std::size_t) { return kNoWay; };
  EXPECT_TRUE(plan_tour(evaluator, made.poses, {.way = nowhere}).set.indices.empty());
  EXPECT_TRUE(plan_tour(evaluator, made.poses, {.max_stops = 0}).set.indices.empty());
  EXPECT_TRUE(plan_tour(evaluator, {}, {}).tour.stops.empty());
  // In haste five of all poses are looked at, none of them twice as its double.
  std::vector<Pose> doubled = made.poses;
  doubled.insert(doubled.end(), made.poses.begin(), made.poses.end());
  const ViewTour hasty = plan_tour(evaluator, doubled, {.max_candidates = 5});
  std::vector<std::size_t> looked_at;
  for (std::size_t i = 0; i < doubled.size(); ++i) {
    if (!std::isnan(hasty.alone[i].gain)) looked_at.push_back(i % kPoses);
  }
  std::sort(looked_at.begin(), looked_at.end());
  EXPECT_EQ(std::unique(looked_at.begin(), looked_at.end()), looked_at.end());
  EXPECT_EQ(looked_at.size(), 5U);
  EXPECT_GE(hasty.set.indices.size(), 2U);
  for (const std::size_t i : hasty.set.indices) EXPECT_GT(hasty.alone[i].gain, 0);
  // More stops than are ordered exactly.
  const Made many(312);
  const WayCost ways = random_ways(0, 2);
  const GainEvaluator other(many.scene, many.sensor, {.model = GainModel::surface});
  const ViewTour tour = plan_tour(other, many.poses, {.way = ways});
  double sum = 0;
  std::size_t from = kTourStart;
  for (const std::size_t place : tour.tour.stops) {
    sum += ways(std::exchange(from, tour.set.indices[place]), tour.set.indices[place]);
  }
  EXPECT_NEAR(tour.tour.cost, sum, 1e-12);
  EXPECT_EQ(tour.tour.stops.size(), tour.set.indices.size());

  std::stop_source source;
  source.request_stop();
  const ViewTour stopped = plan_tour(evaluator, made.poses, {}, {.stop = source.get_token()});
  EXPECT_FALSE(stopped.set.complete);
  EXPECT_TRUE(stopped.tour.stops.empty());
}

TEST(ViewTour, RefusesWhatCannotBe) {
  const Made made(311);
  const GainEvaluator evaluator(made.scene, made.sensor, {.model = GainModel::surface});
  const auto refuses = [&](const TourConfig& config, const char* part) {
    expect_error(ErrorCode::invalid_argument, part,
                 [&] { (void)plan_tour(evaluator, made.poses, config); });
  };
  const std::vector<double> few(3, 1.0), bad(kPoses, std::nan(""));
  refuses({.costs = few}, "costs: 3, poses: 14");
  refuses({.costs = bad}, "nan");
  refuses({.cost_per_way = -1}, "cost_per_way must be at least 0 and finite, not -1");
  refuses({.budget = -1}, "budget");
  refuses({.least_area = std::nan("")}, "least_area");
  refuses({.first = kPoses}, "first is pose 14; it must be less than the number of poses, 14");
  refuses({.share = 0}, "share must be in (0, 1], not 0");
  refuses({.share = 1.5}, "share must be in (0, 1], not 1.5");
  refuses({.way = [](std::size_t, std::size_t) { return -1.0; }}, "from the start to 0 is -1");
  // What the user's own callback throws comes through.
  const WayCost broken = [](std::size_t, std::size_t) -> double {
    throw std::runtime_error("arm");
  };
  EXPECT_THROW((void)plan_tour(evaluator, made.poses, {.way = broken}), std::runtime_error);
}

}  // namespace
}  // namespace viewgain
