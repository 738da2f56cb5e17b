// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Orders of stops against all permutations.
#include "viewgain/core/tour.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "core/expect_error.hpp"
#include "viewgain/core/generators.hpp"

namespace viewgain {
namespace {

constexpr double kNoWay = std::numeric_limits<double>::infinity();

double cost_of(const std::vector<std::size_t>& stops, const WayCost& cost) {
  double sum = 0;
  std::size_t from = kTourStart;
  for (const std::size_t to : stops) {
    sum += cost(from, to);
    from = to;
  }
  return sum;
}

std::vector<std::size_t> in_turn(std::size_t count) {
  std::vector<std::size_t> stops(count);
  std::iota(stops.begin(), stops.end(), std::size_t{0});
  return stops;
}

// Costs of all ways by table, of which a share leads nowhere; the start's are the last row.
WayCost random_costs(std::size_t count, double share_without, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> table;
  for (std::size_t i = 0; i < (count + 1) * count; ++i) {
    table.push_back(uniform(random) < share_without ? kNoWay : uniform(random));
  }
  return [table, count](std::size_t from, std::size_t to) {
    return table[std::min(from, count) * count + to];
  };
}

TEST(Tour, CostsAsLittleAsTheBestPermutation) {
  std::mt19937_64 random(5);
  int cases = 0, impossible = 0;
  for (std::size_t count = 1; count <= 7; ++count) {
    for (const double share_without : {0.0, 0.3, 0.8}) {
      for (int repeat = 0; repeat < 6; ++repeat, ++cases) {
        const WayCost cost = random_costs(count, share_without, random);
        double least = kNoWay;
        std::vector<std::size_t> order = in_turn(count);
        do {
          least = std::min(least, cost_of(order, cost));
        } while (std::next_permutation(order.begin(), order.end()));
        const Tour tour = order_stops(count, cost);
        EXPECT_TRUE(tour.is_exact);
        if (least == kNoWay) {
          EXPECT_TRUE(tour.stops.empty());
          EXPECT_EQ(tour.cost, kNoWay);
          ++impossible;
          continue;
        }
        EXPECT_NEAR(tour.cost, least, 1e-12);
        EXPECT_NEAR(cost_of(tour.stops, cost), least, 1e-12);
        std::vector<std::size_t> sorted = tour.stops;
        std::sort(sorted.begin(), sorted.end());
        EXPECT_EQ(sorted, in_turn(count));
      }
    }
  }
  EXPECT_EQ(cases, 7 * 3 * 6);
  EXPECT_GT(impossible, 10);
  EXPECT_LT(impossible, 60);
}

// Stops on a line, from its end on: the way is the line, whatever the order in which they are
// given.
TEST(Tour, FollowsALine) {
  std::mt19937_64 random(6);
  int exact = 0;
  for (const std::size_t count : {2U, 9U, 12U, 13U, 25U, 40U}) {
    std::vector<std::size_t> places = in_turn(count);
    std::shuffle(places.begin(), places.end(), random);
    std::vector<Pose> poses;
    for (const std::size_t place : places) {
      poses.push_back(look_at({double(place) + 1, 0, 0}, {0, 50, 0}));
    }
    const Tour tour = order_stops(count, straight_ways(look_at({0, 0, 0}, {0, 50, 0}), poses));
    EXPECT_NEAR(tour.cost, double(count), 1e-9);
    ASSERT_EQ(tour.stops.size(), count);
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(places[tour.stops[i]], i);
    EXPECT_EQ(tour.is_exact, count <= Tour::kMostExact);
    exact += tour.is_exact ? 1 : 0;
  }
  EXPECT_EQ(exact, 3);
}

// On a circle the cheapest order goes round; the search beyond 12 stops comes near.
TEST(Tour, GoesRoundACircle) {
  std::mt19937_64 random(7);
  int cases = 0;
  for (const std::size_t count : {14U, 20U, 30U}) {
    for (int repeat = 0; repeat < 4; ++repeat, ++cases) {
      std::vector<std::size_t> places = in_turn(count);
      std::shuffle(places.begin(), places.end(), random);
      const auto pose_at = [&](std::size_t place) {
        const double angle = 2 * 3.14159265358979 * double(place) / double(count + 1);
        return look_at({std::cos(angle), std::sin(angle), 0.5}, {0, 0, 0});
      };
      std::vector<Pose> poses;
      for (const std::size_t place : places) poses.push_back(pose_at(place + 1));
      const Tour tour = order_stops(count, straight_ways(pose_at(0), poses));
      const double round = double(count) * 2 * std::sin(3.14159265358979 / double(count + 1));
      EXPECT_GE(tour.cost, round * (1 - 1e-9));
      EXPECT_LE(tour.cost, 1.1 * round);
      EXPECT_FALSE(tour.is_exact);
    }
  }
  EXPECT_EQ(cases, 12);
}

TEST(Tour, BeyondTwelveStopsNoPartIsBetterTurned) {
  constexpr std::ptrdiff_t kCount = 24;
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> place(-1, 1);
  for (int repeat = 0; repeat < 20; ++repeat) {
    std::vector<Pose> poses;
    for (std::ptrdiff_t i = 0; i < kCount; ++i) {
      poses.emplace_back(Eigen::Matrix3d::Identity(),
                         Eigen::Vector3d(place(random), place(random), 0));
    }
    const WayCost cost = straight_ways(Pose(), poses);
    const Tour tour = order_stops(kCount, cost);
    for (std::ptrdiff_t begin = 0; begin < kCount; ++begin) {
      for (std::ptrdiff_t end = begin + 2; end <= kCount; ++end) {
        std::vector<std::size_t> turned = tour.stops;
        std::reverse(turned.begin() + begin, turned.begin() + end);
        EXPECT_GE(cost_of(turned, cost), tour.cost * (1 - 1e-9));
      }
    }
  }
}

TEST(Tour, BeyondTwelveStopsAvoidsWaysThatAreNone) {
  constexpr std::size_t kCount = 15;
  // Vetoes that leave many orders.
  const Tour some = order_stops(kCount, [](std::size_t from, std::size_t to) {
    return from != kTourStart && (from + to) % 7 == 0 ? kNoWay : 1.0;
  });
  EXPECT_EQ(some.cost, double(kCount));
  const Tour none = order_stops(kCount, [](std::size_t, std::size_t) { return kNoWay; });
  EXPECT_TRUE(none.stops.empty());
  EXPECT_EQ(none.cost, kNoWay);
}

TEST(Tour, TakesNoStopsAndRefusesBadCosts) {
  const Tour none = order_stops(0, [](std::size_t, std::size_t) { return 1.0; });
  EXPECT_TRUE(none.stops.empty());
  EXPECT_EQ(none.cost, 0);
  for (const double bad : {-1.0, std::nan("")}) {
    test::expect_error(ErrorCode::invalid_argument, "the cost of the path from 1 to 2 is", [&] {
      (void)order_stops(
          3, [&](std::size_t from, std::size_t to) { return from == 1 && to == 2 ? bad : 1.0; });
    });
    test::expect_error(ErrorCode::invalid_argument, "from the start to 0", [&] {
      (void)order_stops(1, [&](std::size_t, std::size_t) { return bad; });
    });
  }
}

}  // namespace
}  // namespace viewgain
