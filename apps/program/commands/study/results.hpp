// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "program/cli/json.hpp"
#include "program/commands/study/spec.hpp"

namespace viewgain::app {

/// Shares of the visible surface to which views are counted.
inline constexpr std::array<double, 3> kGoals{0.80, 0.90, 0.95};

/// What a study compares of a run.
struct ResultRow {
  const StudyRun* run = nullptr;
  std::size_t views = 0;
  std::string stop_reason;
  std::vector<double> coverage_by_view;  ///< visible, by the surface; a run that ended early keeps
                                         ///< its last over the rest of the budget
  std::array<std::optional<std::size_t>, kGoals.size()> views_to{};  ///< none: never
  double auc = 0;                                                    ///< mean of coverage_by_view
  double coverage_visible = 0, coverage = 0;
  double rms_error = 0;    ///< of the surface [m]
  double consistency = 0;  ///< of the points
  double outliers = 0;
  double travelled = 0;  ///< [m]
  /// Until a goal was reached; the whole way where it never was [m].
  std::array<double, kGoals.size()> metres_to{};
  std::size_t decisions = 0;    ///< views that were decided on, not taken as an earlier plan says
  double deciding_seconds = 0;  ///< candidates and choice, by view after the first [s]
  std::string isa;              ///< instruction set that the run was made with
  double seconds = 0;

  /// Views to a goal as means count them: one more than the budget where it was never reached.
  [[nodiscard]] double counted_views_to(std::size_t goal) const;
};

/// From a run's run.json; `max_views`: the study's. Throws Json::exception where something is
/// missing in it.
[[nodiscard]] ResultRow row_of(const StudyRun& run, const Json& json, std::size_t max_views);

/// The contents of results.json, a row a run in the spec's order, and of results.csv, the same but
/// for the lists.
[[nodiscard]] Json results_json(const StudySpec& spec, const std::vector<ResultRow>& rows);
[[nodiscard]] std::string results_csv(const Json& results);

/// A study's results for people, as Markdown: for each sensor, voxel and size the policies' means,
/// their paired differences to the spec's `against`, and views by object.
[[nodiscard]] std::string results_markdown(const StudySpec& spec,
                                           const std::vector<ResultRow>& rows);

/// The script that draws a study's plots, plots.py.
[[nodiscard]] const char* plots_script();

/// Runs a study folder's plots.py by python3. Whether it went well; what it says is dropped.
[[nodiscard]] bool draw_plots(const std::filesystem::path& script);

}  // namespace viewgain::app
