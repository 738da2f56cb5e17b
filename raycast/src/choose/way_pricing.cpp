// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "choose/way_pricing.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::detail {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

void check_costs(std::span<const double> costs, std::size_t poses) {
  if (!costs.empty() && costs.size() != poses) {
    refuse("one cost per pose is required; costs: " + std::to_string(costs.size()) +
           ", poses: " + std::to_string(poses));
  }
  for (const double cost : costs) {
    if (!std::isfinite(cost)) refuse("a cost is " + short_text(cost) + "; it must be finite");
  }
}

void check_tour(const TourConfig& config, std::size_t poses) {
  check_costs(config.costs, poses);
  if (config.first && *config.first >= poses) {
    refuse("first is pose " + std::to_string(*config.first) +
           "; it must be less than the number of poses, " + std::to_string(poses));
  }
  if (!(config.cost_per_way >= 0 && std::isfinite(config.cost_per_way))) {
    refuse("cost_per_way must be at least 0 and finite, not " + short_text(config.cost_per_way));
  }
  if (!(config.budget >= 0))
    refuse("the budget must be at least 0, not " + short_text(config.budget));
  if (!(config.least_area >= 0)) {
    refuse("least_area must be at least 0, not " + short_text(config.least_area));
  }
  if (!(config.share > 0 && config.share <= 1)) {
    refuse("share must be in (0, 1], not " + short_text(config.share));
  }
}

WayPricing::WayPricing(const TourConfig& config, std::size_t poses)
    : config_(config), poses_(poses), added_(poses, 0.0), place_(poses, 0) {
  if (!config.way) return;
  std::vector<double>& out = out_.emplace_back(poses);
  for (std::size_t to = 0; to < poses; ++to) out[to] = way(kTourStart, to);
  price();
}

double WayPricing::way(std::size_t from, std::size_t to) const {
  const double value = config_.way(from, to);
  if (value >= 0) return value;
  refuse("the cost of the path from " + (from == kTourStart ? "the start" : std::to_string(from)) +
         " to " + std::to_string(to) + " is " + short_text(value) + "; it must be at least 0");
}

double WayPricing::worth(std::size_t i, double gain) const {
  const double own = config_.costs.empty() ? 0 : config_.costs[i];
  return gain - own - (config_.cost_per_way > 0 ? config_.cost_per_way * added_[i] : 0);
}

double WayPricing::rank(std::size_t i, double gain) const {
  if (added_[i] == kInfinity || cost_ + added_[i] > config_.budget) return -kInfinity;
  if (stops_.empty() && i == config_.first) return kInfinity;
  const double value = worth(i, gain);
  if (!config_.per_way || !config_.way || value <= 0) return value;
  return added_[i] > 0 ? value / added_[i] : kInfinity;
}

void WayPricing::choose(std::size_t i) {
  stops_.push_back(i);
  if (!config_.way) return;
  order_.insert(order_.begin() + static_cast<std::ptrdiff_t>(place_[i]), stops_.size() - 1);
  cost_ += added_[i];
  std::vector<double> out(poses_), back(poses_);
  for (std::size_t pose = 0; pose < poses_; ++pose) {
    if (pose == i) continue;
    out[pose] = way(i, pose);
    back[pose] = way(pose, i);
  }
  out_.push_back(std::move(out));
  back_.push_back(std::move(back));
  if (stops_.size() <= Tour::kMostExact) {
    Tour exact = tour();
    order_ = std::move(exact.stops);
    cost_ = exact.cost;
  }
  price();
}

void WayPricing::price() {
  for (std::size_t pose = 0; pose < poses_; ++pose) {
    double least = kInfinity;
    for (std::size_t place = 0; place <= order_.size(); ++place) {
      const std::size_t from = place == 0 ? 0 : order_[place - 1] + 1;  // row of out_
      double added = out_[from][pose];
      if (place < order_.size()) {
        const std::size_t to = order_[place];
        added += back_[to][pose] - out_[from][stops_[to]];
      }
      if (added >= least) continue;
      least = added;
      place_[pose] = place;
    }
    // If detours are shorter than direct paths, a stop could reduce the cost.
    added_[pose] = std::max(least, 0.0);
  }
}

Tour WayPricing::tour() const {
  if (!config_.way) {
    Tour as_chosen;
    as_chosen.stops.resize(stops_.size());
    std::iota(as_chosen.stops.begin(), as_chosen.stops.end(), std::size_t{0});
    return as_chosen;
  }
  Tour tour = order_stops(stops_.size(), [this](std::size_t from, std::size_t to) {
    return from == kTourStart ? out_[0][stops_[to]] : between(from, to);
  });
  if (tour.cost <= cost_ || tour.is_exact) return tour;
  tour.stops = order_;
  tour.cost = cost_;
  return tour;
}

}  // namespace viewgain::detail
