// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"

namespace viewgain {

/// Index that stands for the start of the tour, which is the current camera pose.
inline constexpr std::size_t kTourStart = std::numeric_limits<std::size_t>::max();

/// Cost of the path from one stop to another, at least 0. Infinity means that there is no path. The
/// unit is your choice, for example metres, or seconds that an arm needs. `from` can be kTourStart.
using WayCost = std::function<double(std::size_t from, std::size_t to)>;

/// An order in which to visit stops, each once, without return to the start.
struct VIEWGAIN_EXPORT Tour {
  std::vector<std::size_t> stops;  ///< all stops in order; empty if every order has infinite cost
  /// Total cost from the start through all stops, in the unit of WayCost. Infinity if `stops` is
  /// empty because no order was found.
  double cost = 0;
  bool is_exact = true;  ///< whether the order is known to be optimal

  static constexpr std::size_t kMostExact = 12;  ///< up to this many stops, the order is optimal
};

/// An order of the stops 0..count-1 with a low cost. Up to Tour::kMostExact stops, it is optimal,
/// by dynamic programming (1 ms for 12 stops). For more stops, the result of cheapest insertion is
/// improved by 2-opt and Or-opt moves of up to three stops, in about count³ steps. Costs may depend
/// on the direction. Deterministic. Calls `cost` count² times on the calling thread, and rethrows
/// its exceptions. Throws Error(invalid_argument) if a cost is negative or NaN.
[[nodiscard]] VIEWGAIN_EXPORT Tour order_stops(std::size_t count, const WayCost& cost);

/// A WayCost that returns the straight-line distance between camera centres [m]. Copies the poses.
/// The result may be called from many threads at once.
[[nodiscard]] VIEWGAIN_EXPORT WayCost straight_ways(const Pose& T_world_camera_start,
                                                    std::span<const Pose> T_world_camera);

}  // namespace viewgain
