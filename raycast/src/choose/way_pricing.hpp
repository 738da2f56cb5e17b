// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "viewgain/raycast/view_tour.hpp"

namespace viewgain::detail {

/// Throws Error(invalid_argument) for costs that are not finite, or not one per pose.
void check_costs(std::span<const double> costs, std::size_t poses);
/// Throws Error(invalid_argument) naming the value for settings that plan_tour() refuses.
void check_tour(const TourConfig& config, std::size_t poses);

/// Costs of poses in a tour that grows stop by stop, and gains minus these costs.
class WayPricing {
 public:
  /// `config` must pass check_tour(). Throws Error(invalid_argument) for an invalid path cost.
  WayPricing(const TourConfig& config, std::size_t poses);

  /// Value by which pose `i` is chosen if it adds `gain`; -infinity if it cannot be a stop.
  [[nodiscard]] double rank(std::size_t i, double gain) const;
  /// The gain minus all costs, in the gain's unit.
  [[nodiscard]] double worth(std::size_t i, double gain) const;
  /// Makes the pose the next stop.
  void choose(std::size_t i);
  /// The tour; stops are indices in the order of choice.
  [[nodiscard]] Tour tour() const;

 private:
  [[nodiscard]] double way(std::size_t from, std::size_t to) const;
  /// Cost between two stops, by their indices in the order of choice.
  [[nodiscard]] double between(std::size_t from, std::size_t to) const {
    return out_[from + 1][stops_[to]];
  }
  void price();

  const TourConfig& config_;
  std::size_t poses_;
  std::vector<std::size_t> stops_;         // in the order of choice
  std::vector<std::size_t> order_;         // indices of stops, in the order of the path
  double cost_ = 0;                        // cost of the path `order_`
  std::vector<std::vector<double>> out_;   // from the start, then from each stop, to each pose
  std::vector<std::vector<double>> back_;  // from each pose to each stop
  std::vector<double> added_;              // per pose: smallest increase of the path cost
  std::vector<std::size_t> place_;         // per pose: where to insert it in `order_`
};

}  // namespace viewgain::detail
