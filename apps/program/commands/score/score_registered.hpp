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

/// The registered gains of --gain NAME[,NAME...]; empty if it names a GainModel. Throws
/// Error(invalid_argument) for names of both kinds, several models, or incompatible flags.
[[nodiscard]] std::optional<std::vector<std::string>> registered_gains_of(
    const ScoreOptions& options);

/// Scores of candidates with registered gains, ranked by the first gain.
struct RegisteredScores {
  const BeliefGrid& grid;
  const Sensor& sensor;
  const PoseSource& source;
  const VoxelScene& scene;
  const std::vector<std::string>& names;
  std::size_t rays_per_pose = 0;
  int threads = 0;
  std::vector<std::size_t> numbers;            ///< index of each candidate in the given poses
  std::map<std::string, std::size_t> dropped;  ///< the others: reason -> count
  std::vector<double> gains{};                 ///< as from FamilyEvaluator::evaluate()
  std::vector<ViewGain::Status> statuses{};
  double seconds = 0;

  /// Candidates, best first: ties to the lower number, NaN last; at most `top`.
  [[nodiscard]] std::vector<std::size_t> best(std::size_t top) const;
  /// Rows of the file of `score --out`: index, one column per gain, status.
  [[nodiscard]] Table table() const;
  /// Prints one JSON object; apps/docs/reference/json.md lists the keys.
  void print_json(std::size_t top) const;
  /// Prints a table for a terminal.
  void print_table(std::size_t top) const;
};

}  // namespace viewgain::app
