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

/// Decision rule of Kriegel et al. (section 5 of the paper): left boundaries first, then right, top
/// and bottom ones. Within a class, our rule takes the longest boundary run first.
///
/// Each boundary run (BoundaryRun) is tried once, with one pose: the nominal pose of the feasible
/// patch nearest to the run's middle. After the surface has changed, a run counts as tried if it
/// has the same class and one of its patches lies within `same_place` of the tried patch. Thread
/// safety: one call at a time. Cost: O(candidates + patches · runs tried).
class VIEWGAIN_EXPORT BoundaryOrder {
 public:
  /// `same_place` [m], unchecked. Half the length of a patch is a good value.
  explicit BoundaryOrder(double same_place) : same_place_(same_place) {}

  /// Index of the chosen candidate, whose run then counts as tried; empty if no untried run has a
  /// feasible nominal pose. Boundary candidates are those with a class; their numbers must index
  /// estimated.candidates.
  [[nodiscard]] std::optional<std::size_t> next(std::span<const Candidate> candidates,
                                                const EstimatedViews& estimated);

 private:
  struct Try {
    BoundaryClass boundary_class;  ///< class of the boundary
    Eigen::Vector3d place;         ///< origin of the patch, world [m]
  };
  [[nodiscard]] std::vector<bool> tried_runs(const EstimatedViews& estimated) const;

  double same_place_;
  std::vector<Try> tried_;
};

/// Scores candidates with a registered gain (register_gains()) on the current map.
///
/// Thread safety: one call at a time. Deterministic for any number of threads. Cost:
/// GainFamily::evaluator(), about 400 rays per pose, and all rays of 32 poses (of all poses if
/// `all` is set).
class VIEWGAIN_EXPORT RegisteredChoice {
 public:
  /// Number of candidates scored with all rays.
  static constexpr std::size_t kInFull = 32;

  /// The model must outlive this object.
  RegisteredChoice(const SurfaceModel& model, const Sensor& sensor, std::string gain,
                   const ExecConfig& exec);

  /// Gain of each pose, in the gain's unit. Unless `all` is set, scores only 32 poses with all
  /// rays: the best according to about 400 rays each. The gains of other poses are then NaN. Throws
  /// whatever GainFamily::evaluator() throws.
  [[nodiscard]] std::vector<double> gains(std::span<const Pose> T_world_camera, bool all) const;

 private:
  const SurfaceModel& model_;
  Sensor sensor_;
  std::string gain_;
  ExecConfig exec_;
};

/// The reference object, which a real planner does not know.
struct VIEWGAIN_EXPORT KnownObject {
  std::shared_ptr<const SurfaceScene> mesh;  ///< reference mesh
  std::shared_ptr<const Truth> truth;        ///< samples and their coverage
  SimulationConfig
      simulation{};  ///< settings of the simulation, including surroundings; noise is ignored
};

/// Chooses views with knowledge of the object, as an upper benchmark for planners. It looks only
/// one view ahead, so another sequence of views can still be better.
///
/// Thread safety: one call at a time. Deterministic for any number of threads.
class VIEWGAIN_EXPORT OracleChoice {
 public:
  /// Number of simulated candidates.
  static constexpr std::size_t kSimulated = 8;

  /// The model must outlive this object. Throws Error(invalid_argument) without a mesh or samples.
  OracleChoice(const SurfaceModel& model, const Sensor& sensor, const KnownObject& object,
               const ExecConfig& exec);

  /// Index of the candidate after whose frame the map's points cover the most samples. Simulates
  /// one noise-free frame into a copy of the map for each of the 8 candidates that see the most
  /// uncovered samples of the mesh, unoccluded and at an angle of incidence below 72°. Ties go to
  /// the lower index. Requires at least one candidate (unchecked). Throws whatever covered_after()
  /// throws. Cost: some seconds for a thousand candidates.
  [[nodiscard]] std::size_t next(std::span<const Candidate> candidates) const;

  /// Number of uncovered samples that each candidate sees, weighted by 1 / (1 + σ_ax(t) / V) for a
  /// sample at range t, where V is the voxel size. Cost: up to two rays per sample and candidate.
  [[nodiscard]] std::vector<double> uncovered_in_view(std::span<const Candidate> candidates) const;
  /// Number of samples that the map's points cover after a frame from the pose. Throws whatever
  /// SimulatedSensor::acquire() throws. Cost: a simulated frame and a copy of the map.
  [[nodiscard]] std::size_t covered_after(const Pose& T_world_camera) const;

 private:
  const SurfaceModel& model_;
  Sensor sensor_;
  KnownObject object_;
  ExecConfig exec_;
  SimulatedSensor camera_;
};

/// How to choose the next view among the feasible candidates.
enum class Policy : std::uint8_t {
  gain,       ///< largest expected gain
  kriegel,    ///< boundaries in the order left, right, top, bottom, each once; see BoundaryOrder
  sequence,   ///< a fixed set in order: eight around the object, then one from above
  random,     ///< uniformly random among the feasible poses
  frontier,   ///< most unknown voxels in view
  fibonacci,  ///< a fixed set in order: evenly spread around the object
  oracle,     ///< knows the object; an upper benchmark; see OracleChoice
};
/// Names of the policies, in enumeration order.
[[nodiscard]] VIEWGAIN_EXPORT const std::vector<std::string>& policy_names();
/// Parses a name. Throws Error(invalid_argument) listing the valid names.
[[nodiscard]] VIEWGAIN_EXPORT Policy parse_policy(std::string_view name);

/// Settings of a policy.
struct VIEWGAIN_EXPORT PolicyConfig {
  Policy policy = Policy::gain;    ///< the policy
  GainModel model = kDefaultGain;  ///< gain of Policy::gain
  std::string registered{};        ///< registered gain of Policy::gain that replaces `model`
  Criterion criterion = Criterion::log_diagonal;  ///< criterion of the paper's gain
  double cost_per_metre = 0;  ///< subtracted per metre of path [the gain's unit per m]
  PlanAhead ahead{};          ///< planning ahead, only for Policy::gain with `model`
  KnownObject object{};       ///< the object that Policy::oracle knows
  std::uint64_t seed = 1;     ///< seed of random choices
};

/// set_stop_rules() for the gain of a policy. Policies without a gain, or with a registered gain,
/// do not stop on gain or area. For these policies, throws Error(invalid_argument) if a value is
/// above 0. `stop_gain` [nat, m² for trace]; `stop_area` is a fraction of the surface.
VIEWGAIN_EXPORT void set_stop_rules(PlanningConfig& planning, const PolicyConfig& policy,
                                    std::optional<double> stop_gain,
                                    std::optional<double> stop_area);

/// DECISIONMAKER of Algorithm 1 for all policies. It is also the VIEWPOINTSGENERATION, because it
/// proposes the rest of a plan before the candidates of the generation. Thread safety: one call at
/// a time. Cost: that of GainEvaluator, RegisteredChoice or OracleChoice, depending on the policy;
/// otherwise O(candidates).
class VIEWGAIN_EXPORT PolicyDecision : public DecisionMaking, public ViewpointGeneration {
 public:
  /// Model and generation must outlive this object. Throws Error(invalid_argument) for an oracle
  /// without an object, or if a policy other than `gain` plans ahead. Also throws whatever
  /// PlanAhead::check() throws.
  PolicyDecision(const SurfaceModel& model, CandidateGeneration& generation, const Sensor& sensor,
                 const PolicyConfig& config, const ExecConfig& exec);

  /// The remaining views of a plan that are still feasible and worth taking (generator kPlanned).
  /// If there are none, the candidates of the generation.
  Proposal generate(const Pose& T_world_camera) override;

  /// The chosen candidate. Empty if there are no candidates, or if the policy kriegel has tried all
  /// boundary runs.
  std::optional<Decision> decide(const Pose& T_world_camera,
                                 std::span<const Candidate> candidates) override;

 private:
  /// Evaluator of the policy's gain on the model's scene.
  const GainEvaluator& evaluator();
  /// Decision by a GainModel; only such decisions can stop a run.
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

  /// Decision with a registered gain. If paths have a cost, all candidates get their full gain.
  [[nodiscard]] std::vector<ViewGain> score_registered(std::span<const Candidate> candidates);
  /// Expected new surface of a view [m²] if the policy's own gain does not provide it.
  [[nodiscard]] double expected_area(const Pose& T_world_camera);

  const SurfaceModel& model_;
  CandidateGeneration& generation_;
  Sensor sensor_;
  PolicyConfig config_;
  ExecConfig exec_;
  std::optional<GainEvaluator> evaluator_;  ///< for the scene of the last decision
  /// Evaluator of the surface gain on the same scene.
  std::optional<GainEvaluator> area_evaluator_;
  BoundaryOrder order_;
  std::optional<OracleChoice> oracle_;
  std::optional<RegisteredChoice> registered_;
  std::vector<Pose> planned_;  ///< remaining views, in the order of the plan
  bool is_of_plan_ = false;    ///< whether the last proposal consists of planned views
};

}  // namespace viewgain
