// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/boundary_class.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"

/// @file
/// Algorithm 1 of the paper: one loop over four interfaces, which are named as in the paper.
///
/// active_view_planning() calls the parts one at a time on the calling thread and rethrows their
/// exceptions. The parts determine the cost of a call.

namespace viewgain {

/// S_i: the sensor's measurements from x_i.
struct VIEWGAIN_EXPORT Measurements {
  Pose T_world_camera;             ///< camera pose of the measurements
  std::vector<DepthFrame> frames;  ///< one or several, in acquisition order
  PoseSigma pose_sigma{};          ///< uncertainty of this pose, in addition to Sensor::pose_sigma
};

/// DATAACQUISITION: moves the sensor to x_i and measures.
class VIEWGAIN_EXPORT DataAcquisition {
 public:
  virtual ~DataAcquisition() = default;
  /// `view` counts from 0.
  virtual Measurements acquire(const Pose& T_world_camera, std::size_t view) = 0;
};

/// Wall-clock time per stage [s].
using StageSeconds = std::map<std::string, double>;

/// State of map and model, for the stopping rules.
struct VIEWGAIN_EXPORT ModelProgress {
  double entropy_removed = 0;        ///< of the whole map [nat, or m² for trace]
  std::uint64_t unknown_voxels = 0;  ///< of the workspace
  std::optional<double> coverage{};  ///< in [0, 1], if a reference mesh is known
  double surface_area = 0;           ///< of the model's surface [m²]
  /// New surface shown by the last view, compared with Decision::area [m²]; NaN: unknown.
  double new_area = std::numeric_limits<double>::quiet_NaN();
  StageSeconds seconds{};  ///< duration of the stages of the update; may be empty
};

/// UPDATEREPRESENTATIONS: the model and the occupancy grid (M and O in the paper).
class VIEWGAIN_EXPORT RepresentationUpdate {
 public:
  virtual ~RepresentationUpdate() = default;
  /// Adds the measurements to the model and returns its state.
  virtual ModelProgress update(const Measurements& measurements) = 0;
};

/// A candidate for the next view.
struct VIEWGAIN_EXPORT Candidate {
  Pose T_world_camera;    ///< camera pose
  std::string generator;  ///< name of the generator
  std::optional<BoundaryClass>
      boundary_class{};  ///< class of the surface boundary that it looks beyond, if any
  std::optional<std::size_t> number{};  ///< the generator's number of the candidate, if any
};

/// c_m: the feasible candidates, and the number of dropped ones by reason.
struct VIEWGAIN_EXPORT Proposal {
  std::vector<Candidate> candidates;           ///< feasible ones, in the order of the generators
  std::map<std::string, std::size_t> dropped;  ///< number by reason
};

/// Reason in Proposal::dropped for poses outside the reachable region.
inline constexpr std::string_view kUnreachable = "unreachable";

/// VIEWPOINTSGENERATION.
class VIEWGAIN_EXPORT ViewpointGeneration {
 public:
  virtual ~ViewpointGeneration() = default;
  /// Proposes candidates for the view after the one from `T_world_camera`.
  virtual Proposal generate(const Pose& T_world_camera) = 0;
};

/// DECISIONMAKER: chooses x_{i+1}, or nothing if no candidate is suitable.
class VIEWGAIN_EXPORT DecisionMaking {
 public:
  /// The chosen candidate.
  struct Decision {
    std::size_t candidate = 0;  ///< its index
    /// Its expected gain [nat, m² for trace].
    double gain = std::numeric_limits<double>::quiet_NaN();
    /// Expected gain per touched voxel [nat, m² for trace], compared with
    /// PlanningConfig::stop_gain. NaN: the policy has no such gain, and this rule never stops the
    /// run.
    double gain_per_voxel = std::numeric_limits<double>::quiet_NaN();
    /// Expected new surface [m²]; NaN: unknown.
    double area = std::numeric_limits<double>::quiet_NaN();
    /// Largest expected new surface among the candidates evaluated in full [m²], compared with
    /// PlanningConfig::stop_area. NaN: unknown, and this rule never stops the run.
    double best_area = std::numeric_limits<double>::quiet_NaN();
    /// Gain minus path cost, in the gain's unit. NaN: there is no cost, and this rule never stops
    /// the run.
    double worth = std::numeric_limits<double>::quiet_NaN();
  };

  virtual ~DecisionMaking() = default;
  /// Returns one of the candidates by index, or nothing. `T_world_camera` is the current camera
  /// pose.
  virtual std::optional<Decision> decide(const Pose& T_world_camera,
                                         std::span<const Candidate> candidates) = 0;
};

/// Default of PlanningConfig::stop_gain [nat]. A view that doubles the information of a voxel gains
/// 3/2 ln 2 = 1.04 nat there. See perf/results/loop.md.
inline constexpr double kStopGain = 1.2;  // [nat]
/// Default of stop_gain for the criterion trace, relative to the gain of the first decision.
inline constexpr double kStopGainShare = 0.01;

/// Default of PlanningConfig::stop_area, a fraction of the surface so far (perf/results/loop.md).
inline constexpr double kStopArea = 4e-3;

/// A view that gains less than this fraction of its prediction counts for
/// PlanningConfig::broken_promises.
inline constexpr double kKeptShare = 0.2;

/// Stopping rules.
struct VIEWGAIN_EXPORT PlanningConfig {
  std::size_t max_views = 20;  ///< view budget, including the first view
  /// Stops when the best candidate's gain per touched voxel is below this [nat, m² for trace].
  double stop_gain = kStopGain;
  /// Whether stop_gain is relative to the gain per voxel of the first decision, as kStopGainShare
  /// is.
  bool stop_gain_is_relative = false;
  /// Stops when Decision::best_area divided by ModelProgress::surface_area is below this value, on
  /// average over the last three decisions. 0: never.
  double stop_area = kStopArea;
  std::size_t idle_views = 3;  ///< stops after this many idle views in a row; 0: never
  /// A view is idle if it changes entropy_removed and the number of unknown voxels by less than
  /// this fraction, or not at all. The first view is never idle.
  double idle_fraction = 1e-3;
  /// Stops after this many views in a row that gained less than kKeptShare of their prediction; 0:
  /// never. Compares Decision::area with ModelProgress::new_area. If one of them is unknown and
  /// there is a gain per voxel, compares the gain with the increase of
  /// ModelProgress::entropy_removed. Views that cannot be compared are skipped.
  std::size_t broken_promises = 3;
  std::optional<double> stop_coverage{};  ///< stops at this coverage, in [0, 1]
  /// Polled after each step except the acquisition, since measurements always go into the model.
  /// Ends the run with `interrupted`.
  std::stop_token stop{};
};

/// Why a run ended.
enum class StopReason : std::uint8_t {
  gain,           ///< the expected gain of the best candidate is too small
  area,           ///< no candidate is expected to show enough new surface
  cost,           ///< reaching the best candidate costs more than its gain
  no_candidates,  ///< no candidates are left
  unreachable,    ///< all remaining candidates are out of reach
  idle,           ///< several views in a row changed almost nothing
  promises,       ///< several views in a row gained far less than predicted
  max_views,
  coverage,
  interrupted,
};
/// Name as used in JSON; "interrupted" for an invalid value. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view stop_reason_name(StopReason reason);

/// One iteration of the loop: the view taken and the choice of the next one.
struct VIEWGAIN_EXPORT ViewRecord {
  std::size_t index = 0;                 ///< from 0
  Pose T_world_camera;                   ///< camera pose according to the measurements
  std::optional<Candidate> chosen_as{};  ///< this view as a candidate; empty for x_0
  /// Predicted gain when it was chosen [nat, m² for trace].
  double predicted_gain = std::numeric_limits<double>::quiet_NaN();
  double realised_gain = 0;  ///< increase of entropy_removed [nat, m² for trace]
  double predicted_area = std::numeric_limits<double>::quiet_NaN();  ///< Decision::area [m²]
  ModelProgress progress;                                            ///< state after the view
  double travelled = 0;  ///< path length between camera centres so far [m]
  Proposal proposal{};   ///< candidates for the next view; empty if the run ended before
  /// The choice of the next view, or empty. With StopReason::gain, area and cost it is the rejected
  /// choice.
  std::optional<DecisionMaking::Decision> decision{};
  /// Duration of the steps acquire, update, candidates and score. If the update reports stages,
  /// they replace update.
  StageSeconds seconds{};
};

/// Result of a run.
struct VIEWGAIN_EXPORT PlanningResult {
  StopReason reason = StopReason::max_views;  ///< why it ended
  std::vector<ViewRecord> views;              ///< in order
};

/// Runs Algorithm 1 of the paper from x_0, a T_world_camera. Calls the parts on the calling thread,
/// and calls `observer`, if given, after each complete record. Rethrows exceptions of the parts.
/// Throws Error(invalid_argument) if max_views is 0, a limit is not finite, or a decision refers to
/// a missing candidate.
///
/// After each view the rules apply in this order: interrupted, coverage, max_views, idle and
/// promises. If no candidate is then chosen, the reason is unreachable if some were dropped as
/// unreachable, otherwise no_candidates. For a chosen candidate gain, area and cost follow.
[[nodiscard]] VIEWGAIN_EXPORT PlanningResult active_view_planning(
    const Pose& x_0, DataAcquisition& acquisition, RepresentationUpdate& representation,
    ViewpointGeneration& generation, DecisionMaking& decision, const PlanningConfig& config = {},
    const std::function<void(const ViewRecord&)>& observer = {});

}  // namespace viewgain
