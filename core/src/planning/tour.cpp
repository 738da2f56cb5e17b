// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/tour.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

constexpr double kNoWay = std::numeric_limits<double>::infinity();
// Smaller improvements, relative to the cost, are rounding errors.
constexpr double kRounding = 1e-12;
constexpr std::size_t kMostMoved = 3;  // stops per Or-opt move

// The costs of all paths; the start is stop `count`.
class Costs {
 public:
  Costs(std::size_t count, const WayCost& cost) : count_(count), costs_((count + 1) * count) {
    for (std::size_t from = 0; from <= count; ++from) {
      for (std::size_t to = 0; to < count; ++to) {
        if (from == to) continue;
        const double value = cost(from == count ? kTourStart : from, to);
        if (!(value >= 0)) {
          refuse("the cost of the path from " +
                 (from == count ? "the start" : std::to_string(from)) + " to " +
                 std::to_string(to) + " is " + std::to_string(value) + "; it must be at least 0");
        }
        costs_[from * count + to] = value;
      }
    }
  }
  [[nodiscard]] double operator()(std::size_t from, std::size_t to) const {
    return costs_[from * count_ + to];
  }
  [[nodiscard]] double of(const std::vector<std::size_t>& stops) const {
    double sum = 0;
    std::size_t from = count_;
    for (const std::size_t to : stops) sum += (*this)(std::exchange(from, to), to);
    return sum;
  }

 private:
  std::size_t count_;
  std::vector<double> costs_;
};

// Held and Karp: for each subset and each of its stops, the cheapest path through the subset that
// ends there.
std::vector<std::size_t> exact_order(std::size_t count, const Costs& costs) {
  const std::size_t subsets = std::size_t{1} << count;
  std::vector<double> least(subsets * count, kNoWay);
  std::vector<std::uint8_t> before(subsets * count, 0);
  for (std::size_t i = 0; i < count; ++i)
    least[(std::size_t{1} << i) * count + i] = costs(count, i);
  for (std::size_t subset = 1; subset < subsets; ++subset) {
    for (std::size_t last = 0; last < count; ++last) {
      const double so_far = least[subset * count + last];
      if (so_far == kNoWay) continue;
      for (std::size_t next = 0; next < count; ++next) {
        if ((subset >> next & 1U) != 0) continue;
        const std::size_t with = (subset | std::size_t{1} << next) * count + next;
        const double sum = so_far + costs(last, next);
        if (sum >= least[with]) continue;
        least[with] = sum;
        before[with] = static_cast<std::uint8_t>(last);
      }
    }
  }
  const auto ends = least.end() - static_cast<std::ptrdiff_t>(count);
  std::size_t last = static_cast<std::size_t>(std::min_element(ends, least.end()) - ends);
  std::vector<std::size_t> stops;
  if (ends[static_cast<std::ptrdiff_t>(last)] == kNoWay) return stops;
  for (std::size_t subset = subsets - 1; subset != 0;) {
    stops.push_back(last);
    const std::size_t previous = before[subset * count + last];
    subset ^= std::size_t{1} << last;
    last = previous;
  }
  std::reverse(stops.begin(), stops.end());
  return stops;
}

// Inserts the stops one by one at the cheapest place.
std::vector<std::size_t> inserted_order(std::size_t count, const Costs& costs) {
  std::vector<std::size_t> stops;
  for (std::size_t stop = 0; stop < count; ++stop) {
    std::vector<std::size_t> best;
    double least = kNoWay;
    for (std::size_t place = 0; place <= stops.size(); ++place) {
      std::vector<std::size_t> with = stops;
      with.insert(with.begin() + static_cast<std::ptrdiff_t>(place), stop);
      const double sum = costs.of(with);
      if (!best.empty() && sum >= least) continue;
      least = sum;
      best = std::move(with);
    }
    stops = std::move(best);
  }
  return stops;
}

// Compares orders by the number of infinite costs first, then by the sum of the others.
std::pair<std::size_t, double> rank_of(const std::vector<std::size_t>& stops, std::size_t count,
                                       const Costs& costs) {
  std::pair<std::size_t, double> rank{0, 0.0};
  std::size_t from = count;
  for (const std::size_t to : stops) {
    const double way = costs(std::exchange(from, to), to);
    if (way == kNoWay) {
      ++rank.first;
    } else {
      rank.second += way;
    }
  }
  return rank;
}

void improve(std::vector<std::size_t>& stops, const Costs& costs) {
  const std::size_t count = stops.size();
  auto now = rank_of(stops, count, costs);
  std::vector<std::size_t> other;
  bool is_better = true;
  const auto keep_if_better = [&] {
    const auto rank = rank_of(other, count, costs);
    if (rank.first > now.first ||
        (rank.first == now.first && !(rank.second < now.second * (1 - kRounding)))) {
      return;
    }
    now = rank;
    stops = other;
    is_better = true;
  };
  const auto at = [&](std::size_t i) { return other.begin() + static_cast<std::ptrdiff_t>(i); };
  while (is_better) {
    is_better = false;
    for (std::size_t begin = 0; begin < count; ++begin) {
      for (std::size_t end = begin + 2; end <= count; ++end) {
        other = stops;
        std::reverse(at(begin), at(end));
        keep_if_better();
      }
      for (std::size_t moved = 1; moved <= kMostMoved && begin + moved <= count; ++moved) {
        for (std::size_t to = 0; to <= count; ++to) {
          if (to >= begin && to <= begin + moved) continue;
          other = stops;
          if (to < begin) {
            std::rotate(at(to), at(begin), at(begin + moved));
          } else {
            std::rotate(at(begin), at(begin + moved), at(to));
          }
          keep_if_better();
        }
      }
    }
  }
}

}  // namespace

Tour order_stops(std::size_t count, const WayCost& cost) {
  Tour tour;
  if (count == 0) return tour;
  const Costs costs(count, cost);
  tour.is_exact = count <= Tour::kMostExact;
  if (tour.is_exact) {
    tour.stops = exact_order(count, costs);
  } else {
    tour.stops = inserted_order(count, costs);
    improve(tour.stops, costs);
    if (costs.of(tour.stops) == kNoWay) tour.stops.clear();
  }
  tour.cost = tour.stops.empty() ? kNoWay : costs.of(tour.stops);
  return tour;
}

WayCost straight_ways(const Pose& T_world_camera_start, std::span<const Pose> T_world_camera) {
  std::vector<Eigen::Vector3d> centers;
  for (const Pose& pose : T_world_camera) centers.push_back(pose.translation());
  return [start = Eigen::Vector3d(T_world_camera_start.translation()),
          centers = std::move(centers)](std::size_t from, std::size_t to) {
    return (centers.at(to) - (from == kTourStart ? start : centers.at(from))).norm();
  };
}

}  // namespace viewgain
