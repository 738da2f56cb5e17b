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

/// State of the stopping rules during a run. A value type, so that a run can be saved.
struct VIEWGAIN_EXPORT StopMemory {
  std::size_t views = 0;             ///< number of views taken
  std::size_t idle_views = 0;        ///< number of consecutive idle views up to now
  double entropy_removed = 0;        ///< state after the last view [nat, or m² for trace]
  std::uint64_t unknown_voxels = 0;  ///< likewise
  std::size_t decisions = 0;         ///< number of decisions
  /// Gain per voxel of the first decision with a gain above 0 [nat, m² for trace]. NaN: none yet,
  /// or the limit is absolute.
  double first_gain_per_voxel = std::numeric_limits<double>::quiet_NaN();
  /// Decision::best_area divided by the surface, for the last three decisions; decision i is at i %
  /// 3.
  std::array<double, 3> area_shares{};
  /// Prediction for the next view [m²].
  double promised_area = std::numeric_limits<double>::quiet_NaN();
  double promised_gain = std::numeric_limits<double>::quiet_NaN();  ///< likewise [nat, m²]
  std::size_t broken_promises = 0;                                  ///< the last ones in a row
};

/// The stopping rules of PlanningConfig, step by step, as in active_view_planning(), for other
/// loops. Thread safety: one call at a time. Members other than the constructor check nothing;
/// calls take constant time.
class VIEWGAIN_EXPORT StopRules {
 public:
  /// `memory`: state of a run to continue. Throws Error(invalid_argument) if max_views is 0 or a
  /// limit is not finite.
  explicit StopRules(const PlanningConfig& config, const StopMemory& memory = {});

  /// After a view went into the model: the first of coverage, max_views, idle and promises that
  /// applies.
  [[nodiscard]] std::optional<StopReason> after_view(const ModelProgress& progress);

  /// After a choice among the remaining candidates: no_candidates or unreachable if none was
  /// chosen, else gain, area or cost. `surface_area` [m²]: that of ModelProgress.
  [[nodiscard]] std::optional<StopReason> after_decision(
      const std::optional<DecisionMaking::Decision>& decision, const Proposal& proposal,
      double surface_area);

  /// The state of the rules.
  [[nodiscard]] const StopMemory& memory() const noexcept { return memory_; }

 private:
  [[nodiscard]] bool brought_nothing(const ModelProgress& now) const;
  void hold_against_promise(const ModelProgress& now);
  [[nodiscard]] bool stops_for_gain(double gain_per_voxel);
  [[nodiscard]] bool stops_for_area(double share);

  PlanningConfig config_;
  StopMemory memory_;
};

/// unreachable if candidates were dropped as unreachable, otherwise no_candidates. Checks nothing;
/// takes constant time.
[[nodiscard]] VIEWGAIN_EXPORT StopReason nowhere_to_go(const Proposal& proposal);

}  // namespace viewgain
