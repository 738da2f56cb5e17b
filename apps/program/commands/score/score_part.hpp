// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "program/cli/flags/pose_source.hpp"
#include "program/commands/score/score_options.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/columns/table.hpp"

namespace viewgain::app {

/// The poses that --shard asks for. A part is complete by itself: what compares all poses
/// is left to who puts parts together. Throws Error(invalid_argument), naming the flag, for flags
/// that do not go with a part.
[[nodiscard]] Shard shard_of(const ScoreOptions& options);

/// Writes --out: each row with its pose and, where poses have costs, its worth before its gain, so
/// that this ranks. Parts and .npy files say what they are: flags that change a gain, files among
/// them by their contents; a CSV file of all poses holds the columns alone. `config`: what the
/// flags say of the gain, or of the literature's. `isa`: that scored. Throws Error(io).
void write_scores(const ScoreOptions& options, const GainConfig& config, const Table& table,
                  const BeliefGrid& grid, const Sensor& sensor, const PoseSource& source,
                  std::string_view isa);

}  // namespace viewgain::app
