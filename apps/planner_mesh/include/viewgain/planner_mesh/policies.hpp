// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/planner/rank_views.hpp"
#include "viewgain/planner_mesh/boundary_order.hpp"
#include "viewgain/planner_mesh/candidate_generation.hpp"
#include "viewgain/planner_mesh/classic_choice.hpp"
#include "viewgain/planner_mesh/oracle_choice.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain {

/// How the next view is chosen among the feasible candidates.
enum class Policy : std::uint8_t {
  gain,       ///< the largest expected gain
  kriegel,    ///< boundaries in the order left, right, top, bottom, each once: see BoundaryOrder
  sequence,   ///< a fixed set in its order: turntable of eight, then from above
  random,     ///< uniform over the feasible poses
  frontier,   ///< the most unknown voxels in view
  fibonacci,  ///< a fixed set in its order: evenly round the object
  oracle,     ///< knows the object, an upper reference: see OracleChoice
};
/// Names of the policies, in their order.
[[nodiscard]] VIEWGAIN_EXPORT const std::vector<std::string>& policy_names();
/// Throws Error(invalid_argument) that lists the valid names.
[[nodiscard]] VIEWGAIN_EXPORT Policy parse_policy(std::string_view name);

/// How the next view is chosen.
struct VIEWGAIN_EXPORT PolicyConfig {
  Policy policy = Policy::gain;                   ///< which one
  GainModel model = kDefaultGain;                 ///< of Policy::gain
  std::optional<ClassicGain> classic{};           ///< of Policy::gain, instead of `model`
  Criterion criterion = Criterion::log_diagonal;  ///< of the paper's gain
  double cost_per_metre = 0;                      ///< gain - this * way [the gain's unit per m]
  PlanAhead ahead{};                              ///< of Policy::gain by `model`
  KnownObject object{};                           ///< of Policy::oracle
  std::uint64_t seed = 1;                         ///< of random choices
};

/// set_stop_rules() of the policy: that of its gain, and where it does not choose by a gain, or by
/// a classic one, neither gain nor area ends a run. `stop_gain` [nat, m² for trace], `stop_area` a
/// share of the surface. Throws Error(invalid_argument), too, for an area or a gain above 0 with
/// such a policy.
VIEWGAIN_EXPORT void set_stop_rules(PlanningConfig& planning, const PolicyConfig& policy,
                                    std::optional<double> stop_gain,
                                    std::optional<double> stop_area);

/// DECISIONMAKER of Algorithm 1 for all policies, and its VIEWPOINTSGENERATION, which proposes what
/// is left of a plan, or else what the generation does. Thread safety: one call at a time. Cost: by
/// a gain or by counts that of scoring the candidates with GainEvaluator, a classic gain
/// ClassicChoice, the oracle OracleChoice; by an order or at random O(candidates).
class VIEWGAIN_EXPORT PolicyDecision : public DecisionMaking, public ViewpointGeneration {
 public:
  /// Model and generation must outlive it. Throws Error(invalid_argument) for an oracle without an
  /// object, a plan ahead by another policy, and as PlanAhead::check().
  PolicyDecision(const SurfaceModel& model, CandidateGeneration& generation, const Sensor& sensor,
                 const PolicyConfig& config, const ExecConfig& exec);

  /// The views of a plan that are still to be taken, are possible and promise enough, by kPlanned;
  /// where there are none, those of the generation.
  Proposal generate(const Pose& T_world_camera) override;

  /// The index of one of the candidates in their order. Nothing if there are no candidates, and for
  /// kriegel if none of them is left to try.
  std::optional<Decision> decide(const Pose& T_world_camera,
                                 std::span<const Candidate> candidates) override;

 private:
  /// The evaluator by the policy's gain of the model's scene.
  const GainEvaluator& evaluator();
  /// By a gain of viewgain's own, which alone may end a run.
  [[nodiscard]] std::optional<Decision> decide_by_gain(const Pose& T_world_camera,
                                                       std::span<const Candidate> candidates);
  [[nodiscard]] bool is_by_gain() const noexcept {
    return config_.policy == Policy::gain && !config_.classic;
  }
  [[nodiscard]] std::optional<std::size_t> choose(const Pose& T_world_camera,
                                                  std::span<const Candidate> candidates,
                                                  const std::vector<ViewGain>& gains);
  [[nodiscard]] std::optional<std::size_t> choose_by_boundary(
      std::span<const Candidate> candidates);

  /// By a classic gain. Where the way there counts, all have their gain.
  [[nodiscard]] std::vector<ViewGain> score_classic(std::span<const Candidate> candidates);
  /// The new surface to be expected of a view [m²], where the policy's own gain does not say.
  [[nodiscard]] double expected_area(const Pose& T_world_camera);

  const SurfaceModel& model_;
  CandidateGeneration& generation_;
  Sensor sensor_;
  PolicyConfig config_;
  ExecConfig exec_;
  std::optional<GainEvaluator> evaluator_;       ///< of the last decision's scene
  std::optional<GainEvaluator> area_evaluator_;  ///< likewise, by the surface gain
  BoundaryOrder order_;
  std::optional<OracleChoice> oracle_;
  std::optional<ClassicChoice> classic_;
  std::vector<Pose> planned_;  ///< still to be taken, in the plan's order
  bool is_of_plan_ = false;    ///< the last proposal
};

}  // namespace viewgain
