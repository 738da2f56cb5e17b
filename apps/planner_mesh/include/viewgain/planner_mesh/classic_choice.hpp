// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/literature/classic_gains.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"

namespace viewgain {

/// Candidates by a gain of the literature, on the map as it is at each call.
///
/// Thread safety: one call at a time. Deterministic, for any number of threads. Cost:
/// ClassicMap::build(), about 400 rays a pose, and all rays of 32 poses or of all.
class VIEWGAIN_EXPORT ClassicChoice {
 public:
  /// Candidates that are scored with all rays.
  static constexpr std::size_t kInFull = 32;

  /// The model must outlive it.
  ClassicChoice(const SurfaceModel& model, const Sensor& sensor, ClassicGain gain,
                const ExecConfig& exec);

  /// The gain of each pose, in the gain's unit, in their order. Unless `all` are asked for, those
  /// that about 400 rays each do not rank among the first 32, ties to the lower index, have NaN.
  /// Throws as ClassicMap::build() and ClassicGainEvaluator.
  [[nodiscard]] std::vector<double> gains(std::span<const Pose> T_world_camera, bool all);

 private:
  const SurfaceModel& model_;
  Sensor sensor_;
  ClassicGain gain_;
  ExecConfig exec_;
  std::optional<ClassicGainEvaluator> full_, coarse_;  ///< of the last call's map
};

}  // namespace viewgain
