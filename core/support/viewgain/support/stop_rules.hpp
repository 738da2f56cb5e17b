// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "viewgain/core/export.hpp"
#include "viewgain/core/planning.hpp"

namespace viewgain {

/// What the stopping rules remember of a run. A value type, so that a run can be saved.
struct VIEWGAIN_EXPORT StopMemory {
  std::size_t views = 0;             ///< taken
  std::size_t idle_views = 0;        ///< the last ones in a row, which brought nothing
  double entropy_removed = 0;        ///< after the last view [nat, or m² for trace]
  std::uint64_t unknown_voxels = 0;  ///< likewise
  std::size_t decisions = 0;         ///< how many there were
  /// Of the first decision that had one above 0 [nat, m² for trace]; NaN: none yet, or the limit is
  /// no share.
  double first_gain_per_voxel = std::numeric_limits<double>::quiet_NaN();
  /// Decision::best_area as a share of the surface in the last three decisions, in the order i % 3
  /// of decision i.
  std::array<double, 3> area_shares{};
  double promised_area = std::numeric_limits<double>::quiet_NaN();  ///< of the view to come [m²]
  double promised_gain = std::numeric_limits<double>::quiet_NaN();  ///< likewise [nat, m²]
  std::size_t broken_promises = 0;                                  ///< the last ones in a row
};

/// The stopping rules of PlanningConfig, step by step: what active_view_planning() asks, for loops
/// that are not its own. Thread safety: one call at a time. Members other than the constructor
/// check nothing; calls cost constant time.
class VIEWGAIN_EXPORT StopRules {
 public:
  /// `memory`: of a run that goes on. Throws Error(invalid_argument) if max_views is 0 or a limit
  /// is not finite.
  explicit StopRules(const PlanningConfig& config, const StopMemory& memory = {});

  /// After a view went into the model: coverage, max_views, idle or promises, the first that
  /// holds.
  [[nodiscard]] std::optional<StopReason> after_view(const ModelProgress& progress);

  /// After a choice among the candidates that are left: no_candidates or unreachable if none was
  /// made, else gain, area or cost. `surface_area` [m²]: as ModelProgress has it.
  [[nodiscard]] std::optional<StopReason> after_decision(
      const std::optional<DecisionMaking::Decision>& decision, const Proposal& proposal,
      double surface_area);

  /// What the rules have to remember.
  [[nodiscard]] const StopMemory& memory() const noexcept { return memory_; }

 private:
  [[nodiscard]] bool brought_nothing(const ModelProgress& now) const;
  void hold_against_promise(const ModelProgress& now);
  [[nodiscard]] bool stops_for_gain(double gain_per_voxel);
  [[nodiscard]] bool stops_for_area(double share);

  PlanningConfig config_;
  StopMemory memory_;
};

/// no_candidates, or unreachable if candidates were dropped for that. Checks nothing; takes
/// constant time.
[[nodiscard]] VIEWGAIN_EXPORT StopReason nowhere_to_go(const Proposal& proposal);

}  // namespace viewgain
