// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

/// @file
/// Which views are best, by one rule for the planner, `next`, `follow`, `reconstruct` and studies
/// by a gain. `score` ranks what it is given. Poses are T_world_camera.

namespace viewgain {

/// By what views are ranked.
struct VIEWGAIN_EXPORT RankConfig {
  /// One a pose, subtracted from its gain, in the gain's unit. Empty: none.
  std::span<const double> costs{};
  /// Of the way from the last view, likewise. The combined gain of a square metre of new surface
  /// goes with 1 / voxel², so a cost per metre does, too.
  double cost_per_metre = 0;
  const ViewMeasure* measure = nullptr;     ///< instead of the gain, as in BestConfig
  const RunMeasure* run_measure = nullptr;  ///< likewise
  /// All poses are scored in full. Else, but by the paper's gain, where it is always so, by two
  /// stages: see GainEvaluator::race().
  bool exact = false;
};

/// One of the best.
struct VIEWGAIN_EXPORT RankedView {
  std::size_t index = 0;  ///< of the candidate in the proposal, or of the pose that was given
  Pose T_world_camera;    ///< where the camera would be
  ViewGain gain;          ///< all NaN with a measure
  double worth = 0;       ///< gain or measure, less the cost, in the gain's unit
};

/// The best views.
struct VIEWGAIN_EXPORT Ranking {
  std::vector<RankedView> views;  ///< best first
  bool complete = true;           ///< false: a stop was requested
  /// Those that were scored in full, by index, and their gains: all, or what the second of two
  /// stages took. Empty with a measure.
  std::vector<std::size_t> scored_indices{};
  std::vector<ViewGain> scored_gains{};  ///< of these, in their order
};

/// What each pose costs by `config`, the way from `here` included; empty: nothing costs. Throws
/// Error(invalid_argument) for a cost_per_metre that is negative or not finite.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<double> view_costs(
    std::span<const Pose> T_world_camera, const RankConfig& config,
    const std::optional<Eigen::Vector3d>& here);

/// The k best of the poses, at least one of them wanted, whether they are possible or not. Ties go
/// to the earlier one; bad poses are last, with NaN. `here` is where the camera is, from which
/// cost_per_metre counts; nothing: it does not. Throws Error(invalid_argument) for a cost that is
/// negative or not finite, and as GainEvaluator::best().
[[nodiscard]] VIEWGAIN_EXPORT Ranking rank_views(const GainEvaluator& evaluator,
                                                 std::span<const Pose> T_world_camera,
                                                 std::size_t k, const RankConfig& config,
                                                 const std::optional<Eigen::Vector3d>& here,
                                                 const BatchControl& control = {});

/// Takes the views out that gain nothing, unless a measure of the user's own ranked them.
VIEWGAIN_EXPORT void leave_out_gainless(Ranking& ranking, const RankConfig& config);

}  // namespace viewgain
