// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "program/cli/flags/pose_source.hpp"
#include "program/commands/score/score_options.hpp"
#include "viewgain/raycast/gain_family.hpp"
#include "viewgain/support/columns/table.hpp"

namespace viewgain::app {

/// The registered gains of --gain NAME[,NAME...]; nothing where it names one of score's own. Throws
/// Error(invalid_argument) for names of both kinds, several of its own, or flags that do not go
/// with them.
[[nodiscard]] std::optional<std::vector<std::string>> registered_gains_of(
    const ScoreOptions& options);

/// Candidates by registered gains, ranked by the first, and what was asked for.
struct RegisteredScores {
  const BeliefGrid& grid;
  const Sensor& sensor;
  const PoseSource& source;
  const VoxelScene& scene;
  const std::vector<std::string>& names;
  std::size_t rays_per_pose = 0;
  int threads = 0;
  std::vector<std::size_t> numbers;            ///< of each candidate among the poses given
  std::map<std::string, std::size_t> dropped;  ///< the others: reason -> count
  std::vector<double> gains{};                 ///< as FamilyEvaluator::evaluate
  std::vector<ViewGain::Status> statuses{};
  double seconds = 0;

  /// Candidates, best first: ties to the lower number, NaN last; at most `top`.
  [[nodiscard]] std::vector<std::size_t> best(std::size_t top) const;
  /// The rows of the file of `score --out`: index, a column for each gain, status.
  [[nodiscard]] Table table() const;
  /// One JSON object; apps/docs/reference/json.md names the keys.
  void print_json(std::size_t top) const;
  /// For people.
  void print_table(std::size_t top) const;
};

}  // namespace viewgain::app
