// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "viewgain/raycast/view_tour.hpp"

namespace viewgain::detail {

/// Throws Error(invalid_argument) if there are costs and they are not one a pose, or not finite.
void check_costs(std::span<const double> costs, std::size_t poses);
/// Throws Error(invalid_argument), naming the value, for what plan_tour() refuses of these.
void check_tour(const TourConfig& config, std::size_t poses);

/// What poses cost in a tour that grows stop by stop, and what that makes of their gains.
class WayPricing {
 public:
  /// Of what check_tour() accepts. Throws Error(invalid_argument) for a bad way.
  WayPricing(const TourConfig& config, std::size_t poses);

  /// What pose `i` is chosen by if it adds `gain`; -infinity: it cannot be a stop.
  [[nodiscard]] double rank(std::size_t i, double gain) const;
  /// The gain less all costs, in its unit.
  [[nodiscard]] double worth(std::size_t i, double gain) const;
  /// The pose is the next of the stops.
  void choose(std::size_t i);
  /// Through the stops by their places in the order of choice.
  [[nodiscard]] Tour tour() const;

 private:
  [[nodiscard]] double way(std::size_t from, std::size_t to) const;
  /// Between stops by their places.
  [[nodiscard]] double between(std::size_t from, std::size_t to) const {
    return out_[from + 1][stops_[to]];
  }
  void price();

  const TourConfig& config_;
  std::size_t poses_;
  std::vector<std::size_t> stops_;         // in the order of choice
  std::vector<std::size_t> order_;         // their places, as they are driven to
  double cost_ = 0;                        // of the ways of `order_`
  std::vector<std::vector<double>> out_;   // from the start, then from each stop, to each pose
  std::vector<std::vector<double>> back_;  // from each pose to each stop
  std::vector<double> added_;              // to the way by each pose, where it adds least
  std::vector<std::size_t> place_;         // where that is in `order_`
};

}  // namespace viewgain::detail
