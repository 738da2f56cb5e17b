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

/// Stands for where the camera is, in the place of a stop.
inline constexpr std::size_t kTourStart = std::numeric_limits<std::size_t>::max();

/// What the way between two stops costs, in a unit of the user's own: metres, seconds of an arm.
/// `from` may be kTourStart. At least 0; infinity: there is no way.
using WayCost = std::function<double(std::size_t from, std::size_t to)>;

/// Stops in the order in which they are driven to, once each, without coming back.
struct VIEWGAIN_EXPORT Tour {
  std::vector<std::size_t> stops;  ///< all of them, or none where no order avoids infinite ways
  /// Of the way from the start through all of them, in the unit of WayCost; infinity: no order was
  /// found.
  double cost = 0;
  bool is_exact = true;  ///< no other order costs less

  static constexpr std::size_t kMostExact = 12;  ///< stops
};

/// The order of the stops 0..count-1 that costs least: exactly, by dynamic programming over their
/// subsets, up to Tour::kMostExact of them, beyond by cheapest insertion, then by turning pieces
/// (2-opt) and moving up to three stops at once (Or-opt) for as long as that costs less. Costs may
/// differ by direction. The same costs give the same order. The way between stops is the motion
/// planner's: ask it in `cost`. Throws Error(invalid_argument) for a cost that is negative or NaN,
/// naming the way; what `cost` throws passes through. `cost` is called count² times, in the
/// caller's thread; exact orders take count² 2^count steps (1 ms for 12), others some count³.
[[nodiscard]] VIEWGAIN_EXPORT Tour order_stops(std::size_t count, const WayCost& cost);

/// The metres of the straight ways between the cameras' centres. Takes copies; the result may be
/// called by many threads at once.
[[nodiscard]] VIEWGAIN_EXPORT WayCost straight_ways(const Pose& T_world_camera_start,
                                                    std::span<const Pose> T_world_camera);

}  // namespace viewgain
