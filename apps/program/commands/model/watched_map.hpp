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

/// Locks a folder, so that one process at a time writes to it. The lock ends with the process. File
/// systems without locks are not locked.
class FolderLock {
 public:
  /// Creates the folder if it is missing. Throws Error(io) if that fails, and
  /// Error(invalid_argument) if another process has the lock.
  explicit FolderLock(const std::filesystem::path& folder);
  /// Removes the folder if it was created here and is empty.
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::filesystem::path folder_;
  bool is_made_ = false;
  int lock_ = -1;
};

/// The frames in a map that an earlier call saved, and their sensor.
struct SavedFrames {
  std::set<std::string> frames{};  ///< from frame_identity()
  std::optional<Sensor> sensor{};
};

/// Reads a file of WatchedMap::save(); empty if there is no file. Throws Error(format), naming the
/// file, if the map does not state the frame of each view. Also throws whatever load_map() throws.
[[nodiscard]] std::optional<SavedFrames> saved_frames(const std::filesystem::path& state,
                                                      const ExecConfig& exec);

/// Settings of the map, without those that depend on the sensor, and of the planner. Throws Error,
/// naming the flag.
[[nodiscard]] ScorerConfig map_config_of(const ModelOptions& options);
[[nodiscard]] PlannerConfig planner_config_of(const ModelOptions& options);

/// A watch on the frames' folder. Throws Error, naming the flag or the file.
[[nodiscard]] FrameWatch watch_of(const FrameFolderOptions& options,
                                  const std::optional<SavedFrames>& saved);

/// The views that a robot was asked for, and which frames can be the answer: those that were not in
/// the folder at that time. Names are those of depth images, identities from frame_identity().
class AskedViews {
 public:
  explicit AskedViews(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Reads next.json of an earlier call, whose map has these frames. Ignores a file that viewgain
  /// did not write.
  void recall(const std::filesystem::path& next_json, const std::set<std::string>& identities);

  /// Asks for these views, best first. The map has these frames.
  void ask(std::vector<Pose> views, const std::set<std::string>& identities);

  /// A frame has arrived: returns the views that it can be the answer to, and ends the request.
  /// Empty for a frame that existed before.
  [[nodiscard]] std::vector<Pose> answered_by(const std::string& name);

  /// Leaves out the frame; false if it was left out already.
  bool leave_out(const std::string& name) { return left_out_.insert(name).second; }
  /// Ignores the image, which does not count as a view.
  void ignore(const std::string& name) { ignored_.insert(name); }
  /// Records that the frame is in the map after all.
  void take(const std::string& name) { left_out_.erase(name); }

  /// Keys of next.json: asked (no frame was waiting then), left_out (names).
  [[nodiscard]] Json json() const {
    return {{"asked", is_asked_},
            {"left_out", std::vector<std::string>(left_out_.begin(), left_out_.end())}};
  }

 private:
  [[nodiscard]] std::set<std::string> judged(const std::set<std::string>& identities) const;

  std::filesystem::path folder_;
  std::vector<Pose> asked_;
  std::set<std::string> known_;     // existing images
  std::set<std::string> left_out_;  // names of bad frames
  std::set<std::string> ignored_;
  bool is_asked_ = false;
};

/// A map into which frames go as they arrive, its next-best views, and the file that stores both.
/// Generation and decision of Algorithm 1; the planner keeps the camera's pose.
class WatchedMap final : public ViewpointGeneration, public DecisionMaking {
 public:
  /// An empty map or, with `saved`, the map of the file state.vdb. `options` must outlive this
  /// object. Throws Error(invalid_argument) if another sensor than `sensor` took the saved frames.
  /// Also throws whatever ViewPlanner's constructor and load() throw.
  WatchedMap(const ModelOptions& options, const Sensor& sensor, const ScorerConfig& map,
             const PlannerConfig& config, const std::optional<SavedFrames>& saved);

  /// Sets the sources of candidates; call it once.
  void propose_by(const GenerationConfig& config);

  /// Likely fault of the frames so far, reported once; checked after 6, 12, 24, ... frames, and at
  /// the end.
  [[nodiscard]] std::string suspicion(bool is_last);
  /// Whether the frames of this call agree.
  [[nodiscard]] Json consistency_json() const {
    return to_json(planner_.scorer().consistency(), numbers_);
  }

  /// Registers the frame with the map; empty without sigmas.
  [[nodiscard]] std::optional<FrameRegistration> register_in(const WatchedFrame& frame) const;

  /// Adds a frame at its own pose, or at the registered one.
  AddedView add(const WatchedFrame& frame, const std::optional<FrameRegistration>& registration);

  /// Leaves out a frame; `T_world_camera`: its pose, if known.
  void drop(FrameVerdict verdict, const std::optional<Pose>& T_world_camera);

  /// Handles a frame that arrived after these views were asked for, best first. If it matches none
  /// of them, the best one counts as not reached and is not proposed again.
  void answer(std::span<const Pose> asked, const std::optional<Pose>& T_world_camera);

  /// ViewPlanner::propose(); empty while no frame could be used.
  Proposal generate(const Pose&) override;
  /// ViewPlanner::rank() of the last generate().
  std::optional<Decision> decide(const Pose&, std::span<const Candidate>) override;
  /// The best candidates by marginal gain, or the views of a plan.
  [[nodiscard]] const NextViews& next() const { return next_; }

  /// Reason to stop, from ViewPlanner::should_stop().
  [[nodiscard]] std::optional<StopReason> should_stop() const { return planner_.should_stop(); }

  /// Writes the file with map and planner, atomically.
  void save() const;

  [[nodiscard]] const FrameCounts& frames() const { return planner_.frames(); }
  [[nodiscard]] const BeliefGrid& grid() const { return planner_.scorer().grid(); }
  [[nodiscard]] const Sensor& sensor() const { return planner_.scorer().sensor(); }

 private:
  const ModelOptions& options_;
  std::filesystem::path state_;
  ViewPlanner planner_;
  const Proposal* proposal_ = nullptr;  // the planner's last proposal
  NextViews next_;
  std::optional<PoseSigma> sigma_;    // of the poses, if frames are registered
  std::vector<std::size_t> numbers_;  // of the integrated frames
  std::size_t due_ = 6;               // number of frames at the next consistency check
  std::size_t count_ = 0;             // number of arrived frames
  bool is_suspected_ = false;
};

}  // namespace viewgain::app
