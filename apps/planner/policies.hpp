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

struct PolicyConfig {
  Policy policy = Policy::gain;
  GainModel model = GainModel::paper;  ///< of Policy::gain
  Criterion criterion = Criterion::log_diagonal;
  std::optional<double> support_plane{};  ///< height [m], at which rays end
  TravelCost travel{};
  KnownObject object{};  ///< of Policy::oracle
  std::uint64_t seed = 1;
};

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
