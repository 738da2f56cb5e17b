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
/// The paper's Algorithm 1, stated once over four interfaces in its words. Replace any of them.
///
/// active_view_planning() calls the parts one at a time, on its own thread. What the parts throw
/// passes through it. A call costs what the part that was put in takes.

namespace viewgain {

/// S_i: what the sensor delivered from x_i.
struct VIEWGAIN_EXPORT Measurements {
  Pose T_world_camera;             ///< where they were taken from
  std::vector<DepthFrame> frames;  ///< one or several, in the order in which they were taken
  PoseSigma pose_sigma{};          ///< by which the pose may be off; adds to the sensor's own
};

/// DATAACQUISITION: moves the sensor to x_i and measures.
class VIEWGAIN_EXPORT DataAcquisition {
 public:
  virtual ~DataAcquisition() = default;
  /// `view` counts from 0.
  virtual Measurements acquire(const Pose& T_world_camera, std::size_t view) = 0;
};

/// Wall time by stage [s].
using StageSeconds = std::map<std::string, double>;

/// How far the representations are, for the stopping rules.
struct VIEWGAIN_EXPORT ModelProgress {
  double entropy_removed = 0;        ///< of the whole map [nat, or m² for trace]
  std::uint64_t unknown_voxels = 0;  ///< of the workspace
  std::optional<double> coverage{};  ///< in [0, 1], where a ground truth is known
  double surface_area = 0;           ///< of the model's surface [m²]
  /// New surface that the last view showed, to be held against Decision::area [m²]; NaN: not known.
  double new_area = std::numeric_limits<double>::quiet_NaN();
  StageSeconds seconds{};  ///< what the update's stages took; may be empty
};

/// UPDATEREPRESENTATIONS: the model and the occupancy grid (the paper's M and O).
class VIEWGAIN_EXPORT RepresentationUpdate {
 public:
  virtual ~RepresentationUpdate() = default;
  /// Puts them into the model; says how far it is.
  virtual ModelProgress update(const Measurements& measurements) = 0;
};

/// A pose that could be the next view.
struct VIEWGAIN_EXPORT Candidate {
  Pose T_world_camera;                            ///< where the camera would be
  std::string generator;                          ///< who proposed it
  std::optional<BoundaryClass> boundary_class{};  ///< of the boundary that it looks beyond, if any
  std::optional<std::size_t> number{};            ///< the generator's own number for it, if any
};

/// c_m: the feasible candidates, and how many were dropped and why.
struct VIEWGAIN_EXPORT Proposal {
  std::vector<Candidate> candidates;           ///< feasible ones, in the order of the generators
  std::map<std::string, std::size_t> dropped;  ///< reason -> count
};

/// The reason in Proposal::dropped that means "outside the reachable region".
inline constexpr std::string_view kUnreachable = "unreachable";

/// VIEWPOINTSGENERATION.
class VIEWGAIN_EXPORT ViewpointGeneration {
 public:
  virtual ~ViewpointGeneration() = default;
  /// Proposes what may come after the view from `T_world_camera`.
  virtual Proposal generate(const Pose& T_world_camera) = 0;
};

/// DECISIONMAKER: picks x_{i+1}. Returns nothing if none of the candidates will do.
class VIEWGAIN_EXPORT DecisionMaking {
 public:
  /// The choice among the candidates.
  struct Decision {
    std::size_t candidate = 0;  ///< index of the chosen one
    double gain =
        std::numeric_limits<double>::quiet_NaN();  ///< its expected gain [nat, m² for trace]
    /// Its expected gain per touched voxel [nat, m² for trace], held against
    /// PlanningConfig::stop_gain; NaN: this policy has none and never stops for it.
    double gain_per_voxel = std::numeric_limits<double>::quiet_NaN();
    /// The new surface that it is expected to show [m²]; NaN: not known.
    double area = std::numeric_limits<double>::quiet_NaN();
    /// The most that any of the candidates that were looked at closely is expected to show [m²],
    /// held against PlanningConfig::stop_area; NaN: not known, and never stops for it.
    double best_area = std::numeric_limits<double>::quiet_NaN();
    /// Its gain less what it costs to go there, in the gain's unit; NaN: nothing has a cost, and it
    /// never stops for it.
    double worth = std::numeric_limits<double>::quiet_NaN();
  };

  virtual ~DecisionMaking() = default;
  /// One of the candidates, by its place in their order, or nothing. `T_world_camera`: where the
  /// camera is now.
  virtual std::optional<Decision> decide(const Pose& T_world_camera,
                                         std::span<const Candidate> candidates) = 0;
};

/// Default of PlanningConfig::stop_gain [nat]: about what is left when the information of a touched
/// voxel cannot be doubled any more (3/2 ln 2 = 1.04 nat). With 0.15 nat no run on the camel ended:
/// each view meets voxels of the noise shell, and unknown ones behind it, for the first time.
inline constexpr double kStopGain = 1.2;  // [nat]
/// The same for the criterion trace, as a share of the first decision's.
inline constexpr double kStopGainShare = 0.01;

/// Default of PlanningConfig::stop_area, a share of the surface so far; perf/results/loop.md says
/// where the camel stops by it.
inline constexpr double kStopArea = 4e-3;

/// A view that brings less than this share of what was promised breaks the promise.
inline constexpr double kKeptShare = 0.2;

/// When to stop.
struct VIEWGAIN_EXPORT PlanningConfig {
  std::size_t max_views = 20;  ///< budget, the first one included
  /// Stop when the best candidate's gain per touched voxel is under this [nat, m² for trace].
  double stop_gain = kStopGain;
  /// stop_gain is a share of the first decision's gain per voxel instead (for trace:
  /// kStopGainShare).
  bool stop_gain_is_relative = false;
  /// Stop when the most that any candidate is expected to show (Decision::best_area), as a share of
  /// the model's surface (ModelProgress::surface_area), is under this on the mean of the last three
  /// decisions: a single one is often high or low by chance. 0: never.
  double stop_area = kStopArea;
  std::size_t idle_views = 3;  ///< stop after so many views in a row that brought nothing; 0: never
  /// Nothing: the view adds less than this share to entropy_removed and takes less than this share
  /// off the unknown voxels (or nothing at all). The first view is never idle.
  double idle_fraction = 1e-3;
  /// Stop after so many views in a row that brought less than kKeptShare of what was promised; 0:
  /// never. Promised is the chosen view's Decision::area, against which ModelProgress::new_area is
  /// held; where one of them is not known, and there is a gain per voxel, its gain, against which
  /// the growth of ModelProgress::entropy_removed is held. Other views neither count nor break the
  /// row.
  std::size_t broken_promises = 3;
  std::optional<double> stop_coverage{};  ///< stop at this coverage, in [0, 1]
  /// Asked after each step but the acquisition: what was measured goes into the model. Ends with
  /// `interrupted`.
  std::stop_token stop{};
};

/// Why a run ended.
enum class StopReason : std::uint8_t {
  gain,           ///< the best candidate promises too little
  area,           ///< no candidate promises enough new surface
  cost,           ///< going to the best candidate costs more than it promises
  no_candidates,  ///< nothing is left to look at
  unreachable,    ///< candidates are left, all of them out of reach
  idle,           ///< views in a row brought nothing new
  promises,       ///< views in a row brought far less than was promised
  max_views,
  coverage,
  interrupted,
};
/// Its name, as JSON has it; "interrupted" for a number that is none of them: never throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view stop_reason_name(StopReason reason);

/// One turn of the loop: the view taken, and the choice of the one after it.
struct VIEWGAIN_EXPORT ViewRecord {
  std::size_t index = 0;                 ///< from 0
  Pose T_world_camera;                   ///< where the measurements say it was taken
  std::optional<Candidate> chosen_as{};  ///< what this view was as a candidate; none for x_0
  /// When it was chosen [nat, m² for trace].
  double predicted_gain = std::numeric_limits<double>::quiet_NaN();
  double realised_gain = 0;  ///< what it added to entropy_removed [nat, m² for trace]
  double predicted_area = std::numeric_limits<double>::quiet_NaN();  ///< Decision::area [m²]
  ModelProgress progress;                                            ///< after it
  double travelled = 0;  ///< distance between camera centres so far [m]
  Proposal proposal{};   ///< for the next view; empty if the run ended before it was asked for
  /// The next view; empty if there was none. With StopReason::gain, area and cost it is the one
  /// that promised too little and is not taken.
  std::optional<DecisionMaking::Decision> decision{};
  /// What the turn's steps took: acquire; the update's own stages, or, where it names none, update;
  /// candidates; score.
  StageSeconds seconds{};
};

/// How a run went.
struct VIEWGAIN_EXPORT PlanningResult {
  StopReason reason = StopReason::max_views;  ///< why it ended
  std::vector<ViewRecord> views;              ///< in their order
};

/// The paper's Algorithm 1 from x_0, a T_world_camera. Calls the parts in turn on the calling
/// thread and `observer`, if given, once a view, when its record is complete. Exceptions of the
/// parts pass through. Throws Error(invalid_argument) if max_views is 0, a limit is not finite, or
/// a decision names a candidate that is not there.
///
/// Order of the rules after each view: interrupted; coverage; max_views; idle; promises; then, with
/// the candidates, no_candidates or unreachable (none left, or the decision maker took none, and
/// some were dropped as unreachable); gain; area; cost.
[[nodiscard]] VIEWGAIN_EXPORT PlanningResult active_view_planning(
    const Pose& x_0, DataAcquisition& acquisition, RepresentationUpdate& representation,
    ViewpointGeneration& generation, DecisionMaking& decision, const PlanningConfig& config = {},
    const std::function<void(const ViewRecord&)>& observer = {});

}  // namespace viewgain
