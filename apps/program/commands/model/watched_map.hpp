// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "program/cli/flags/frame_folder.hpp"
#include "program/cli/flags/next_views.hpp"
#include "program/commands/frames/frame_tally.hpp"
#include "program/commands/model/model_options.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/formats/frame_watch.hpp"
#include "viewgain/planner/register_frame.hpp"
#include "viewgain/planner/view_planner.hpp"
#include "viewgain/planner_mesh/candidate_generation.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain::app {

/// A folder that one process at a time writes into. The lock ends with the process, however that
/// ends; where the file system has no locks there is none.
class FolderLock {
 public:
  /// Makes the folder where it is missing. Throws Error(io) if that cannot be done, and
  /// Error(invalid_argument) if another process has the lock.
  explicit FolderLock(const std::filesystem::path& folder);
  /// Removes the folder if it was made and nothing is in it.
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::filesystem::path folder_;
  bool is_made_ = false;
  int lock_ = -1;
};

/// What an earlier call has left of a map: which frames are in it and which sensor took them.
struct SavedFrames {
  std::set<std::string> frames{};  ///< as frame_identity() has them
  std::optional<Sensor> sensor{};
};

/// Of WatchedMap::save(); nothing where there is no file. Throws Error(format), naming the file,
/// for a map that does not say which frames all its views are of, and as load_map().
[[nodiscard]] std::optional<SavedFrames> saved_frames(const std::filesystem::path& state,
                                                      const ExecConfig& exec);

/// Settings of the map, without those that depend on the sensor, and of the planner. Throw Error,
/// naming the flag.
[[nodiscard]] ScorerConfig map_config_of(const ModelOptions& options);
[[nodiscard]] PlannerConfig planner_config_of(const ModelOptions& options);

/// What is looked for in the frames' folder. Throws Error, naming the flag or the file.
[[nodiscard]] FrameWatch watch_of(const FrameFolderOptions& options,
                                  const std::optional<SavedFrames>& saved);

/// The views that a robot was asked for, and which frames may be its answer: those that were not
/// in the folder when it was asked. Names are those of depth images, identities as frame_identity()
/// has them.
class AskedViews {
 public:
  explicit AskedViews(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// What an earlier call has left in next.json, whose map has these frames. A file that viewgain
  /// did not write is ignored.
  void recall(const std::filesystem::path& next_json, const std::set<std::string>& identities);

  /// These are asked for now, best first; the map has these frames.
  void ask(std::vector<Pose> views, const std::set<std::string>& identities);

  /// A frame has come: the views that it may be the answer to, which are asked for no longer; none
  /// for a frame that was there before.
  [[nodiscard]] std::vector<Pose> answered_by(const std::string& name);

  /// The frame is left out; false if that was known.
  bool leave_out(const std::string& name) { return left_out_.insert(name).second; }
  /// The image is not used and does not count as a view.
  void ignore(const std::string& name) { ignored_.insert(name); }
  /// The frame is in the map after all.
  void take(const std::string& name) { left_out_.erase(name); }

  /// Keys of next.json: asked (no frame waited then), left_out (names).
  [[nodiscard]] Json json() const {
    return {{"asked", is_asked_},
            {"left_out", std::vector<std::string>(left_out_.begin(), left_out_.end())}};
  }

 private:
  [[nodiscard]] std::set<std::string> judged(const std::set<std::string>& identities) const;

  std::filesystem::path folder_;
  std::vector<Pose> asked_;
  std::set<std::string> known_;     // images that were there
  std::set<std::string> left_out_;  // of bad frames
  std::set<std::string> ignored_;
  bool is_asked_ = false;
};

/// A map that frames are put into as they come, the next best views on it, and the file that keeps
/// both. Generation and decision of Algorithm 1; the planner knows where the camera is.
class WatchedMap final : public ViewpointGeneration, public DecisionMaking {
 public:
  /// An empty one or, with `saved`, the one of the file state.vdb. `options` must outlive it.
  /// Throws Error as ViewPlanner's constructor and load(), and Error(invalid_argument) if the saved
  /// frames are another sensor's than `sensor`.
  WatchedMap(const ModelOptions& options, const Sensor& sensor, const ScorerConfig& map,
             const PlannerConfig& config, const std::optional<SavedFrames>& saved);

  /// Where candidates come from; to be said once.
  void propose_by(const GenerationConfig& config);

  /// Likely fault of the frames so far, reported once; checked after 6, 12, 24, ... frames, and at
  /// the end.
  [[nodiscard]] std::string suspicion(bool is_last);
  /// Whether the frames of this call fit one another.
  [[nodiscard]] Json consistency_json() const {
    return to_json(planner_.scorer().consistency(), numbers_);
  }

  /// What registering the frame against the map comes to; nothing without sigmas.
  [[nodiscard]] std::optional<FrameRegistration> register_in(const WatchedFrame& frame) const;

  /// At its own pose, or at the one that registering it came to.
  AddedView add(const WatchedFrame& frame, const std::optional<FrameRegistration>& registration);

  /// A frame is left out; `T_world_camera`: where it was taken, if that is known.
  void drop(FrameVerdict verdict, const std::optional<Pose>& T_world_camera);

  /// A frame came after these views were asked for, best first. If it matches none of them, the
  /// best one counts as not reached and is not proposed again.
  void answer(std::span<const Pose> asked, const std::optional<Pose>& T_world_camera);

  /// ViewPlanner::propose(); nothing while no frame could be used.
  Proposal generate(const Pose&) override;
  /// ViewPlanner::rank() of the last generate().
  std::optional<Decision> decide(const Pose&, std::span<const Candidate>) override;
  /// What these came to: the best candidates, each by what it adds to those before it; or a plan's.
  [[nodiscard]] const NextViews& next() const { return next_; }

  /// Why to end, as ViewPlanner::should_stop().
  [[nodiscard]] std::optional<StopReason> should_stop() const { return planner_.should_stop(); }

  /// Writes the file: map and planner, all at once.
  void save() const;

  [[nodiscard]] const FrameCounts& frames() const { return planner_.frames(); }
  [[nodiscard]] const BeliefGrid& grid() const { return planner_.scorer().grid(); }
  [[nodiscard]] const Sensor& sensor() const { return planner_.scorer().sensor(); }

 private:
  const ModelOptions& options_;
  std::filesystem::path state_;
  ViewPlanner planner_;
  const Proposal* proposal_ = nullptr;  // the planner's last
  NextViews next_;
  std::optional<PoseSigma> sigma_;    // of the poses, if frames are registered
  std::vector<std::size_t> numbers_;  // of the frames that went in
  std::size_t due_ = 6;               // frames, when they are next held against one another
  std::size_t count_ = 0;             // of the frames that came
  bool is_suspected_ = false;
};

}  // namespace viewgain::app
