// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "program/cli/json.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/planner/register_frame.hpp"
#include "viewgain/planner_mesh/policies.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"

namespace viewgain::app {

/// How far a surface and its points are from the truth, by the keys of run.json; `visible` is the
/// key of the share of visible samples.
[[nodiscard]] Json quality_json(const QualityFigures& quality, const char* visible);

/// What a run came to, for run.json, --json and people. apps/docs/reference/json.md names the keys.
class RunReport {
 public:
  /// `tolerance`: of coverage [m].
  RunReport(const PolicyConfig& policy, double tolerance);

  /// To be called once a view, in order. `seconds` are the totals so far.
  void add_view(const ViewRecord& record, const QualityFigures& quality,
                const StageSeconds& seconds);

  /// One line about the last view.
  [[nodiscard]] std::string progress_line() const;

  /// What registration did to each view, in the end; empty without it.
  void set_registrations(std::vector<FrameRegistration> registrations);

  /// The keys of `reconstruct --json`.
  [[nodiscard]] Json json(StopReason reason) const;

  /// The same for people.
  [[nodiscard]] std::string text(StopReason reason) const;

 private:
  /// The latest one that was asked for; a run that ends by its budget asks for none after its last
  /// view.
  [[nodiscard]] const Proposal& last_proposal() const;
  struct Entry {
    ViewRecord record;
    QualityFigures quality;
    StageSeconds seconds;  ///< of this view alone
  };
  [[nodiscard]] Json entry_json(std::size_t index) const;

  std::string_view ranked_by_;  ///< the gain; empty: the policy ranks by another thing
  std::string_view gain_unit_, entropy_unit_;
  double tolerance_;  ///< of coverage [m]
  std::vector<Entry> views_;
  std::vector<FrameRegistration> registrations_;
  StageSeconds totals_;
};

}  // namespace viewgain::app
