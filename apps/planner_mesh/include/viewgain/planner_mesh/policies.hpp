// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/mesh/viewpoint_estimator.hpp"
#include "viewgain/planner/rank_views.hpp"
#include "viewgain/planner_mesh/candidate_generation.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/planner_mesh/truth.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/raycast/gain_family.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"
#include "viewgain/raycast/surface_scene.hpp"

namespace viewgain {

/// The choice of Kriegel et al. (the paper's section 5): through the left boundaries first, then
/// the right, top and bottom ones, and within a class the longest run first, which is ours.
///
/// A run offers one pose: the nominal one of the patch that is nearest to its middle, of those that
/// are feasible. It is tried once: a later run of the same class counts as the same if the origin
/// of one of its patches lies within `same_place` of that of the patch that was tried. Thread
/// safety: one call at a time. Cost: O(candidates + patches · runs tried).
class VIEWGAIN_EXPORT BoundaryOrder {
 public:
  /// `same_place` [m]: half the length of a patch finds a run that was cut anew; it is not checked.
  explicit BoundaryOrder(double same_place) : same_place_(same_place) {}

  /// The index of the candidate to take, in their order, which is tried thereby; nothing if none of
  /// the runs that have not been tried has a feasible nominal pose. Boundary candidates are those
  /// with a class; their numbers must index estimated.candidates.
  [[nodiscard]] std::optional<std::size_t> next(std::span<const Candidate> candidates,
                                                const EstimatedViews& estimated);

 private:
  struct Try {
    BoundaryClass boundary_class;  ///< of the boundary
    Eigen::Vector3d place;         ///< origin of the patch, world [m]
  };
  [[nodiscard]] std::vector<bool> tried_runs(const EstimatedViews& estimated) const;

  double same_place_;
  std::vector<Try> tried_;
};

/// Candidates by a registered gain (register_gains()), on the map as it is at each call.
///
/// Thread safety: one call at a time. Deterministic, for any number of threads. Cost:
/// GainFamily::evaluator(), about 400 rays a pose, and all rays of 32 poses or of all.
class VIEWGAIN_EXPORT RegisteredChoice {
 public:
  /// Candidates that are scored with all rays.
  static constexpr std::size_t kInFull = 32;

  /// The model must outlive it.
  RegisteredChoice(const SurfaceModel& model, const Sensor& sensor, std::string gain,
                   const ExecConfig& exec);

  /// The gain of each pose, in the gain's unit, in their order. Unless `all` are asked for, those
  /// that about 400 rays each do not rank among the first 32, ties to the lower index, have NaN.
  /// Throws as GainFamily::evaluator().
  [[nodiscard]] std::vector<double> gains(std::span<const Pose> T_world_camera, bool all) const;

 private:
  const SurfaceModel& model_;
  Sensor sensor_;
  std::string gain_;
  ExecConfig exec_;
};

/// The object as nobody knows it who has yet to model it.
struct VIEWGAIN_EXPORT KnownObject {
  std::shared_ptr<const SurfaceScene> mesh;  ///< the object
  std::shared_ptr<const Truth> truth;        ///< how much of it is covered
  SimulationConfig simulation{};             ///< of its surroundings; noise is left out
};

/// The choice of one who knows the object: an upper reference for planners, and no planner. Looks
/// one view ahead, so that a sequence of views may still be better.
///
/// Thread safety: one call at a time. Deterministic, for any number of threads. Members that throw
/// say so.
class VIEWGAIN_EXPORT OracleChoice {
 public:
  /// Candidates that are simulated.
  static constexpr std::size_t kSimulated = 8;

  /// The model must outlive it. Throws Error(invalid_argument) without a mesh or truth.
  OracleChoice(const SurfaceModel& model, const Sensor& sensor, const KnownObject& object,
               const ExecConfig& exec);

  /// Of the candidates, whose order matters for ties only, the 8 that see most samples of the mesh
  /// that the surface does not cover yet, unoccluded and at under 72°, are simulated without noise,
  /// one frame each into a copy of the map; the index of the one after which the map's points cover
  /// most samples. Ties go to the lower index, in the ranking too. There must be a candidate, which
  /// is not checked; throws as covered_after(). Takes some seconds for a thousand candidates.
  [[nodiscard]] std::size_t next(std::span<const Candidate> candidates) const;

  /// How many of the samples that the surface does not cover yet each candidate sees, in their
  /// order; a sample at range t counts 1 / (1 + σ_ax(t) / V). Costs up to two rays a sample and
  /// candidate.
  [[nodiscard]] std::vector<double> uncovered_in_view(std::span<const Candidate> candidates) const;
  /// How many samples the map's points cover after a frame from there. Throws as
  /// SimulatedSensor::acquire(). Costs a simulated frame and a copy of the map.
  [[nodiscard]] std::size_t covered_after(const Pose& T_world_camera) const;

 private:
  const SurfaceModel& model_;
  Sensor sensor_;
  KnownObject object_;
  ExecConfig exec_;
  SimulatedSensor camera_;
};

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
  std::string registered{};                       ///< gain of Policy::gain, instead of `model`
  Criterion criterion = Criterion::log_diagonal;  ///< of the paper's gain
  double cost_per_metre = 0;                      ///< gain - this * way [the gain's unit per m]
  PlanAhead ahead{};                              ///< of Policy::gain by `model`
  KnownObject object{};                           ///< of Policy::oracle
  std::uint64_t seed = 1;                         ///< of random choices
};

/// set_stop_rules() of the policy: that of its gain, and where it does not choose by a gain, or by
/// a registered one, neither gain nor area ends a run. `stop_gain` [nat, m² for trace], `stop_area`
/// a share of the surface. Throws Error(invalid_argument), too, for an area or a gain above 0 with
/// such a policy.
VIEWGAIN_EXPORT void set_stop_rules(PlanningConfig& planning, const PolicyConfig& policy,
                                    std::optional<double> stop_gain,
                                    std::optional<double> stop_area);

/// DECISIONMAKER of Algorithm 1 for all policies, and its VIEWPOINTSGENERATION, which proposes what
/// is left of a plan, or else what the generation does. Thread safety: one call at a time. Cost: by
/// a gain or by counts that of scoring the candidates with GainEvaluator, a registered gain
/// RegisteredChoice, the oracle OracleChoice; by an order or at random O(candidates).
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
    return config_.policy == Policy::gain && config_.registered.empty();
  }
  [[nodiscard]] std::optional<std::size_t> choose(const Pose& T_world_camera,
                                                  std::span<const Candidate> candidates,
                                                  const std::vector<ViewGain>& gains);
  [[nodiscard]] std::optional<std::size_t> choose_by_boundary(
      std::span<const Candidate> candidates);

  /// By a registered gain. Where the way there counts, all have their gain.
  [[nodiscard]] std::vector<ViewGain> score_registered(std::span<const Candidate> candidates);
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
  std::optional<RegisteredChoice> registered_;
  std::vector<Pose> planned_;  ///< still to be taken, in the plan's order
  bool is_of_plan_ = false;    ///< the last proposal
};

}  // namespace viewgain
