// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain::app {

/// What `score --report` shows.
struct ScorePage {
  std::string title, criterion;
  const GainEvaluator& evaluator;
  const Sensor& sensor;
  std::span<const Pose> poses;     ///< all that were given
  std::vector<double> gains;       ///< of all of them; NaN: not scored
  std::vector<double> areas;       ///< likewise, or none
  std::vector<std::size_t> exact;  ///< poses whose gain is by all rays and no estimate
  /// The ranking: what its columns are called; a row a pose, best first, the pose's index in it.
  Json columns, rows;
  std::vector<std::size_t> shown;  ///< poses whose rays and voxels the page has
  Json settings, summary;

  /// The page's data; README.md, "Data". Traces the poses of `shown`.
  [[nodiscard]] Json json() const;
};

}  // namespace viewgain::app
