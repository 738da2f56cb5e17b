// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "boundary_order.hpp"
#include "candidate_generation.hpp"
#include "model.hpp"
#include "oracle_choice.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::app {

/// How the next view is chosen among the feasible candidates.
enum class Policy : std::uint8_t {
  gain,       ///< the largest expected gain
  kriegel,    ///< boundaries in the order left, right, top, bottom, each once: see BoundaryOrder
  sequence,   ///< a fixed set in its order: turntable of eight, then from above
  random,     ///< uniform over the feasible poses
  frontier,   ///< the most unknown voxels in view
  fibonacci,  ///< a fixed set in its order: evenly round the object
  proximity,  ///< the most unknown voxels near known surface on its rays: see ProximityMeasure
  oracle,     ///< knows the object, an upper reference: see OracleChoice
};
[[nodiscard]] const std::vector<std::string>& policy_names();
/// Throws Error(invalid_argument) that lists the valid names.
[[nodiscard]] Policy parse_policy(std::string_view name);

/// What moving costs; at most one of the two.
struct TravelCost {
  double per_metre = 0;  ///< gain - per_metre · distance [the gain's unit per m]
  /// gain / (seconds_per_view + distance / speed), where a speed is given [m/s].
  std::optional<double> speed{};
  double seconds_per_view = 1.0;  ///< [s]
};

/// Default of PlanningConfig::stop_gain for the paper's gain: about what is left when the
/// information of a touched voxel cannot be doubled any more (3/2 ln 2 = 1.04 nat). DESIGN.md's
/// 0.15 nat never came on the camel: each view meets voxels of the noise shell, and unknown ones
/// behind it, for the first time.
inline constexpr double kStopGain = 1.2;  // [nat]

/// Default of PlanningConfig::stop_area for the surface and the combined gain, of the surface so
/// far; perf/README.md says where the camel stops by it.
inline constexpr double kStopArea = 1.6e-3;

struct PolicyConfig {
  Policy policy = Policy::gain;
  GainModel model = GainModel::combined;  ///< of Policy::gain
  Criterion criterion = Criterion::log_diagonal;
  std::optional<double> support_plane{};  ///< height [m], at which rays end
  TravelCost travel{};
  KnownObject object{};  ///< of Policy::oracle
  std::uint64_t seed = 1;
};

/// Sets the rules of gain and area by which a run of this policy stops; what is not given has its
/// default: kStopGain, by the criterion trace 0.01 of the first decision's gain; kStopArea where
/// the policy expects area (gain by the surface or the combined gain), else never. Throws
/// Error(invalid_argument) for a gain below 0, an area outside [0, 1), an area or a gain above 0
/// with a policy that does not go by it, and for the combined gain with the criterion trace.
void set_stop_rules(PlanningConfig& planning, const PolicyConfig& policy,
                    std::optional<double> stop_gain, std::optional<double> stop_area);

/// DECISIONMAKER of Algorithm 1 for all policies.
class PolicyDecision : public DecisionMaking {
 public:
  /// Throws Error(invalid_argument) for an oracle without an object.
  PolicyDecision(const Model& model, const CandidateGeneration& generation, const Sensor& sensor,
                 const PolicyConfig& config, const LoopExec& exec);

  /// Nothing if there are no candidates, and for kriegel if none of them is left to try.
  std::optional<Decision> decide(const Pose& T_world_camera,
                                 std::span<const Candidate> candidates) override;

 private:
  [[nodiscard]] std::optional<std::size_t> choose(const Pose& T_world_camera,
                                                  std::span<const Candidate> candidates,
                                                  const std::vector<ViewGain>& gains);
  [[nodiscard]] std::optional<std::size_t> choose_by_boundary(
      std::span<const Candidate> candidates);

  /// Gains of the candidates; by the surface and the combined gain NaN for those that few rays
  /// showed to be no match for others.
  [[nodiscard]] std::vector<ViewGain> score(const Pose& T_world_camera,
                                            std::span<const Candidate> candidates) const;
  [[nodiscard]] std::size_t most_proximity(std::span<const Candidate> candidates);
  /// The new surface to be expected of a view [m²], where the policy's own gain does not say.
  [[nodiscard]] double expected_area(const Pose& T_world_camera);

  const Model& model_;
  const CandidateGeneration& generation_;
  Sensor sensor_;
  PolicyConfig config_;
  LoopExec exec_;
  std::optional<GainEvaluator> evaluator_;       ///< of the last decision's scene
  std::optional<GainEvaluator> area_evaluator_;  ///< likewise, by the surface gain
  std::optional<GainEvaluator> coarse_;          ///< likewise, of few rays
  BoundaryOrder order_;
  std::optional<OracleChoice> oracle_;
};

}  // namespace viewgain::app
