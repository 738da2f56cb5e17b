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
  std::vector<std::size_t> indices;  ///< of the poses
  std::vector<ViewGain> gains;       ///< of those
};

/// Gains from a share of the rays.
struct Estimates {
  std::vector<ApproximateGain> gains;  ///< of all candidates
  std::vector<std::size_t> indices;    ///< of the pose of each gain
  std::vector<std::size_t> best;       ///< of the gains, best first
};

/// What scoring came to, by the way that was asked for.
struct Scores {
  ScoredViews scored{};                  ///< with all their rays, in input order or in the set's
  ScoredViews best{};                    ///< best first, or the set
  std::optional<double> set_gain{};      ///< of views that are good together: of all
  double set_gain_by_best_alone = 0;     ///< ViewSet::gain_by_best_alone
  std::optional<Estimates> estimates{};  ///< instead of both
  std::uint64_t rays_traced = 0;
  std::size_t estimated = 0;                     ///< poses that a race scored by some rays
  std::size_t candidates = 0;                    ///< poses that were not dropped
  std::map<std::string, std::size_t> dropped{};  ///< the others: reason -> count

  /// Index of the best pose; nothing if none was to be printed.
  [[nodiscard]] std::optional<std::size_t> winner() const;
};

/// The rows of the file of `score --out`; apps/docs/reference/json.md names the columns.
[[nodiscard]] Table table_of(const Scores& scores, GainModel model);

/// Rows that begin with index and gain, each with its pose behind it and, where poses have costs,
/// its worth before its gain, so that this ranks.
[[nodiscard]] Table with_poses(const Table& table, const PoseSource& source);

/// What was asked and what came out, for the two ways of printing.
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
