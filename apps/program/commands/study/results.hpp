// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "program/commands/study/spec.hpp"
#include "viewgain/support/json.hpp"

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

/// Mean, and its standard error; NaN of none, the error NaN of one. Values that are not finite do
/// not count.
struct MeanWithError {
  double mean, error;
  std::size_t count;
};
/// `clusters`, a number a value, says which belong together, as runs on one object do. The error is
/// the cluster-robust one, CR1: its square is G / (G - 1) times the sum over the G clusters of
/// their squared sums of deviations, by the squared count (Cameron and Miller, A Practitioner's
/// Guide to Cluster-Robust Inference, Journal of Human Resources 50, 2015). Where all are of
/// one cluster, or none is given, values count as independent; where of several one alone has
/// finite values there is no error: NaN.
[[nodiscard]] MeanWithError mean_of(std::span<const double> values,
                                    std::span<const std::size_t> clusters = {});

/// Half the 95 % interval of the mean, by Student's t, for other seeds on the same objects: from
/// the variance within clusters, one for all. Not finite ones do not count; NaN where none has two.
[[nodiscard]] double interval_of(std::span<const double> values,
                                 std::span<const std::size_t> clusters);

/// The middle value, or the mean of the middle two; infinities may be among them. NaN of none.
[[nodiscard]] double median_of(std::vector<double> values);

/// How probable differences would be that are at least as one-sided if either sign were as likely
/// as the other: of the numbers of signs alone (two-sided sign test), and of the ranks of the sizes
/// (two-sided Wilcoxon signed-rank test, equal sizes at mean places). Zeros and what is not finite
/// do not count; 1 of none. Exact, given the places, for up to 100 differences (the first: 1,000);
/// beyond by the normal distribution, its variance that of the places as tied.
[[nodiscard]] double sign_test(std::span<const double> differences);
[[nodiscard]] double signed_rank_test(std::span<const double> differences);

}  // namespace viewgain::app
