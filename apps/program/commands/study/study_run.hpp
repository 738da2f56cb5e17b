// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <stop_token>
#include <vector>

#include "program/commands/study/spec.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain::app {

/// What a run leaves in the study's folder.
struct StudyResult {
  Json run;                      ///< run.json: configuration, figures, those of each view, seconds
  std::vector<Pose> candidates;  ///< T_world_camera, evenly taken from the proposals
  std::vector<double> candidate_views;  ///< after how many views each was proposed
};

/// Checks a run's flags and files without running it. Throws Error, naming the run.
void check_run(const StudySpec& spec, const StudyRun& run);

/// Makes one run. Nothing if a stop was requested before it was done. The
/// same for any number of threads, but for what stands under `seconds`. Throws Error, naming the
/// run.
[[nodiscard]] std::optional<StudyResult> make_run(const StudySpec& spec, const StudyRun& run,
                                                  const ExecConfig& exec,
                                                  const std::stop_token& stop);

}  // namespace viewgain::app
