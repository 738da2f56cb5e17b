// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/columns/parts.hpp"

namespace viewgain {

/// What decides a job's scores beside its map, sensor and poses.
struct ScoreSettings {
  GainConfig config{};  ///< of the evaluator
  std::string gain{gain_model_name(
      kDefaultGain)};  ///< the model's name, or several of the literature with commas
  std::optional<double> support_plane{};  ///< height z, world [m]
  /// What else was given that changes scores, by the name of its flag.
  std::map<std::string, std::vector<std::string>> further{};
};

/// What all parts of a job say of themselves, whoever makes them: rows and scored are left to do.
/// Settings that were not given are left out. `map`: its content hash.
[[nodiscard]] VIEWGAIN_EXPORT PartHead head_of_job(const std::string& map, const Sensor& sensor,
                                                   const ScoreSettings& settings,
                                                   std::string_view isa, std::uint64_t poses,
                                                   const std::string& poses_hash);

/// Index and all of a ViewGain that the model has.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Column> gain_columns(GainModel model);
/// With kPoseColumns behind them, so that a row stands by itself.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Column> with_pose_columns(std::vector<Column> columns);

}  // namespace viewgain
