// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "program/cli/flags/pose_source.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/columns/table.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain::app {

/// Some of the poses, each with its gain.
struct ScoredViews {
  std::vector<std::size_t> indices;  ///< indices of the poses
  std::vector<ViewGain> gains;       ///< gains of these poses
};

/// Gains from a fraction of the rays.
struct Estimates {
  std::vector<ApproximateGain> gains;  ///< estimates for all candidates
  std::vector<std::size_t> indices;    ///< index of the pose of each gain
  std::vector<std::size_t> best;       ///< indices of the gains, best first
};

/// Results of scoring in the requested way.
struct Scores {
  ScoredViews scored{};              ///< scored with all rays, in input order or in the set's order
  ScoredViews best{};                ///< best first, or the set
  std::optional<double> set_gain{};  ///< gain of the whole set
  double set_gain_by_best_alone = 0;     ///< ViewSet::gain_by_best_alone
  std::optional<Estimates> estimates{};  ///< estimates, instead of both
  std::uint64_t rays_traced = 0;
  std::size_t estimated = 0;   ///< number of poses that a race scored with some rays
  std::size_t candidates = 0;  ///< number of poses that were not dropped
  std::map<std::string, std::size_t> dropped{};  ///< dropped poses: reason -> count

  /// Index of the best pose, if it is printed.
  [[nodiscard]] std::optional<std::size_t> winner() const;
};

/// Rows of the file of `score --out`; apps/docs/reference/json.md lists the columns.
[[nodiscard]] Table table_of(const Scores& scores, GainModel model);

/// Rows that begin with index and gain, extended by the pose. If poses have costs, gain minus cost
/// is inserted before the gain, so that it determines the ranking.
[[nodiscard]] Table with_poses(const Table& table, const PoseSource& source);

/// Request and results, for printing.
struct ScoreReport {
  GainModel model;
  const std::string& criterion;
  const BeliefGrid& grid;
  const Sensor& sensor;
  const PoseSource& source;
  const GainEvaluator& evaluator;
  const Scores& scores;
  double seconds = 0;

  /// One JSON object; apps/docs/reference/json.md names the keys.
  void print_json() const;
  /// For people.
  void print_table() const;
  /// The data of report.html.
  [[nodiscard]] Json page(const std::string& title) const;

 private:
  [[nodiscard]] Json summary() const;
};

}  // namespace viewgain::app
