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
/// Algorithm 1 of the paper (Foix et al. 2012): a loop that takes a view, updates the model,
/// generates candidates and chooses the next view. Four interfaces, named as in the paper, do these
/// steps. x_i is the camera pose of view i. A run is one execution of the loop.
///
/// Gains are in nats. With Criterion::trace, or by the surface gain, they are in m².
/// Entropies are in nats; with Criterion::trace they are in m².

namespace viewgain {

/// The sensor's measurements from x_i (S_i in the paper).
struct VIEWGAIN_EXPORT Measurements {
  Pose T_world_camera;             ///< camera pose of the measurements
  std::vector<DepthFrame> frames;  ///< one or several, in acquisition order
  PoseSigma pose_sigma{};          ///< uncertainty of this pose, in addition to Sensor::pose_sigma
};

/// DATAACQUISITION of the paper: moves the sensor to x_i and measures.
class VIEWGAIN_EXPORT DataAcquisition {
 public:
  virtual ~DataAcquisition() = default;
  /// Moves to the pose and measures. `view` is the number of the view, from 0.
  virtual Measurements acquire(const Pose& T_world_camera, std::size_t view) = 0;
};

/// Wall-clock time per stage [s].
using StageSeconds = std::map<std::string, double>;

/// State of map and model after a view, for the stopping rules.
struct VIEWGAIN_EXPORT ModelProgress {
  double entropy_removed = 0;        ///< entropy removed from the whole map so far [nat or m²]
  std::uint64_t unknown_voxels = 0;  ///< number of unknown voxels in the workspace
  std::optional<double> coverage{};  ///< in [0, 1], if a reference mesh is known
  double surface_area = 0;           ///< area of the model's surface [m²]
  /// New surface that the last view showed [m²]; NaN: unknown. Compared with Decision::area.
  double new_area = std::numeric_limits<double>::quiet_NaN();
  StageSeconds seconds{};  ///< duration of each stage of the update; may be empty
};

/// UPDATEREPRESENTATIONS of the paper: updates the model and the occupancy grid (M and O).
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
      boundary_class{};                 ///< class of the surface boundary at which it looks, if any
  std::optional<std::size_t> number{};  ///< number that the generator gave it, if any
};

/// The feasible candidates (c_m in the paper), and the number of dropped candidates.
struct VIEWGAIN_EXPORT Proposal {
  std::vector<Candidate> candidates;  ///< feasible candidates, in the order of the generators
  std::map<std::string, std::size_t> dropped;  ///< number of dropped candidates per reason
};

/// Reason in Proposal::dropped for poses outside the reachable region.
inline constexpr std::string_view kUnreachable = "unreachable";

/// VIEWPOINTSGENERATION of the paper: proposes candidates.
class VIEWGAIN_EXPORT ViewpointGeneration {
 public:
  virtual ~ViewpointGeneration() = default;
  /// Proposes candidates for the next view. `T_world_camera` is the pose of the last view.
  virtual Proposal generate(const Pose& T_world_camera) = 0;
};

/// DECISIONMAKER of the paper: chooses x_{i+1}, or nothing if no candidate is suitable.
class VIEWGAIN_EXPORT DecisionMaking {
 public:
  /// The chosen candidate, and the numbers that the stopping rules use. If a number is NaN, its
  /// rule does not stop the run.
  struct Decision {
    std::size_t candidate = 0;  ///< index of the candidate
    /// Its expected gain [nat or m²].
    double gain = std::numeric_limits<double>::quiet_NaN();
    /// Its expected gain, divided by the number of voxels in which its rays end [nat or m²].
    /// Compared with PlanningConfig::stop_gain.
    double gain_per_voxel = std::numeric_limits<double>::quiet_NaN();
    /// Its expected new surface [m²]; NaN: unknown.
    double area = std::numeric_limits<double>::quiet_NaN();
    /// Largest expected new surface among the candidates that were evaluated with all their rays
    /// [m²]. Compared with PlanningConfig::stop_area.
    double best_area = std::numeric_limits<double>::quiet_NaN();
    /// Gain minus path cost, in the gain's unit. NaN: there is no cost.
    double worth = std::numeric_limits<double>::quiet_NaN();
  };

  virtual ~DecisionMaking() = default;
  /// Chooses one of the candidates, or nothing. `T_world_camera` is the current camera pose.
  virtual std::optional<Decision> decide(const Pose& T_world_camera,
                                         std::span<const Candidate> candidates) = 0;
};

/// Default of PlanningConfig::stop_gain [nat] (perf/results/loop.md). For comparison: doubling the
/// information of one voxel is a gain of 3/2 ln 2 = 1.04 nat.
inline constexpr double kStopGain = 1.2;  // [nat]
/// Default of PlanningConfig::stop_gain with Criterion::trace, as a fraction of the first
/// decision's gain_per_voxel.
inline constexpr double kStopGainShare = 0.01;

/// Default of PlanningConfig::stop_area, which is a fraction (perf/results/loop.md).
inline constexpr double kStopArea = 4e-3;

/// A view counts for PlanningConfig::broken_promises if it gains less than this fraction of its
/// prediction.
inline constexpr double kKeptShare = 0.2;

/// Stopping rules.
struct VIEWGAIN_EXPORT PlanningConfig {
  std::size_t max_views = 20;  ///< view budget, including the first view
  /// Stops when Decision::gain_per_voxel is below this value [nat or m²].
  double stop_gain = kStopGain;
  /// Whether stop_gain is a fraction of the gain_per_voxel of the first decision.
  bool stop_gain_is_relative = false;
  /// Stops when Decision::best_area / ModelProgress::surface_area, averaged over the last three
  /// decisions, is below this value. 0: never.
  double stop_area = kStopArea;
  std::size_t idle_views = 3;  ///< stops after this many consecutive idle views; 0: never
  /// A view is idle if it changes both entropy_removed and the number of unknown voxels by less
  /// than this fraction, or not at all. The first view is never idle.
  double idle_fraction = 1e-3;
  /// Stops after this many consecutive views that gained less than kKeptShare of their prediction;
  /// 0: never. The prediction is Decision::area, and it is compared with ModelProgress::new_area.
  /// If one of these areas is unknown but gain_per_voxel is known, Decision::gain is compared with
  /// the increase of ModelProgress::entropy_removed. Views without either comparison are skipped.
  std::size_t broken_promises = 3;
  std::optional<double> stop_coverage{};  ///< stops at this ModelProgress::coverage, in [0, 1]
  /// A stop request ends the run with StopReason::interrupted. Checked after each step except the
  /// acquisition, so that acquired measurements always go into the model.
  std::stop_token stop{};
};

/// Why a run ended.
enum class StopReason : std::uint8_t {
  gain,           ///< the expected gain of the chosen candidate is too small
  area,           ///< no candidate is expected to show enough new surface
  cost,           ///< the path to the chosen candidate costs more than its gain
  no_candidates,  ///< no candidates are left
  unreachable,    ///< all remaining candidates are out of reach
  idle,           ///< several consecutive views changed almost nothing
  promises,       ///< several consecutive views gained far less than predicted
  max_views,
  coverage,
  interrupted,
};
/// Name of the reason, as used in JSON; "interrupted" for an invalid value. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view stop_reason_name(StopReason reason);

/// One iteration of the loop: a view, and the choice of the next one.
struct VIEWGAIN_EXPORT ViewRecord {
  std::size_t index = 0;                 ///< from 0
  Pose T_world_camera;                   ///< camera pose that the measurements report
  std::optional<Candidate> chosen_as{};  ///< the candidate that became this view; empty for x_0
  /// Predicted gain when the view was chosen [nat or m²].
  double predicted_gain = std::numeric_limits<double>::quiet_NaN();
  double realised_gain = 0;  ///< increase of entropy_removed [nat or m²]
  double predicted_area = std::numeric_limits<double>::quiet_NaN();  ///< Decision::area [m²]
  ModelProgress progress;                                            ///< state after the view
  double travelled = 0;  ///< length of the path along the camera centres so far [m]
  Proposal proposal{};   ///< candidates for the next view; empty if none were generated
  /// The choice of the next view, or empty. If the run ended with StopReason::gain, area or cost,
  /// it is the rejected choice.
  std::optional<DecisionMaking::Decision> decision{};
  /// Duration of the steps "acquire", "update", "candidates" and "score". If ModelProgress::seconds
  /// reports stages, they replace "update".
  StageSeconds seconds{};
};

/// Result of a run.
struct VIEWGAIN_EXPORT PlanningResult {
  StopReason reason = StopReason::max_views;  ///< why the run ended
  std::vector<ViewRecord> views;              ///< all views, in order
};

/// Runs the loop. `x_0` is the T_world_camera of the first view. Calls the four interfaces one at a
/// time on the calling thread, and rethrows their exceptions. If `observer` is given, calls it with
/// each ViewRecord when the record is complete. Throws Error(invalid_argument) if max_views is 0, a
/// limit is not finite, or a decision refers to a missing candidate.
///
/// After each view, the rules are checked in this order: interrupted, coverage, max_views, idle and
/// promises. Then a candidate is chosen, and gain, area and cost are checked. If no candidate can
/// be chosen, the run ends with unreachable if any was dropped for this reason, otherwise with
/// no_candidates.
[[nodiscard]] VIEWGAIN_EXPORT PlanningResult active_view_planning(
    const Pose& x_0, DataAcquisition& acquisition, RepresentationUpdate& representation,
    ViewpointGeneration& generation, DecisionMaking& decision, const PlanningConfig& config = {},
    const std::function<void(const ViewRecord&)>& observer = {});

}  // namespace viewgain
