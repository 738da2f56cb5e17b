// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "program/cli/app.hpp"
#include "program/cli/flags/frame_folder.hpp"
#include "program/cli/flags/sensing.hpp"
#include "program/commands/frames/frame_tally.hpp"
#include "program/commands/proposal/view_proposal.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/raycast/view_scorer.hpp"

namespace viewgain::app {

/// Settings for making a map from a folder of frames.
struct FrameMapOptions {
  FrameFolderOptions folder;
  double voxel = 0;
  std::string workspace;
  std::string jump_edge_filter = "5";
  ScaleOptions scales;
};

/// Adds FRAMES_DIR, --sensor, --voxel, --workspace, --jump-edge-filter, --scales, --fine and the
/// flags of a folder.
void add_frame_map_options(App& app, FrameMapOptions& options);

/// Settings of the map without workspace, hazard and gain. Throws Error, naming the flag.
[[nodiscard]] ScorerConfig scorer_config(const FrameMapOptions& options,
                                         const ProposalOptions& proposal);

/// The workspace for what the frames see, without pixels that --jump-edge-filter removes. Reads all
/// frames. Throws Error(invalid_argument) if none has a reading.
[[nodiscard]] Box seen_workspace(const FrameFolder& folder, const ScorerConfig& config,
                                 double voxel, bool quiet, const ExecConfig& exec);

/// A map into which the frames of a folder are integrated, in order.
class FrameMap {
 public:
  /// Throws Error, naming the flag or the file, like FrameFolder, parse_box(), hazard_source(),
  /// obstacles_of() and ViewScorer. Without --workspace, reads all frames for their bounds, and
  /// throws if none has a reading.
  FrameMap(const FrameMapOptions& options, const ProposalOptions& proposal, bool quiet,
           const ExecConfig& exec);

  /// Adds a frame at the folder's pose, or at another pose with the uncertainty `pose_sigma`.
  /// Counts the frame by MapUpdate::verdict.
  MapUpdate add(std::size_t index);
  MapUpdate add(std::size_t index, const Pose& T_world_camera, const PoseSigma& pose_sigma = {});
  /// Leaves out a frame for another reason.
  void drop(std::size_t index, const FrameFault& fault) {
    count(index, folder_.T_world_camera(index), fault);
  }

  /// Throws like FrameTally::require_any().
  void require_frames() {
    consistency_ = scorer_.consistency();
    tally_.require_any(folder_, scorer_.grid(), consistency_);
  }
  /// Whether the frames agree, for JSON; after require_frames().
  [[nodiscard]] Json consistency_json() const { return to_json(consistency_, tally_.numbers()); }

  [[nodiscard]] const FrameCounts& counts() const noexcept { return tally_.counts(); }
  /// Poses of frames that could not be used, according to the folder.
  [[nodiscard]] const std::vector<Pose>& tried() const noexcept { return tried_; }
  /// Pose of the last frame, even if it could not be used; empty without a pose.
  [[nodiscard]] const std::optional<Pose>& last_pose() const noexcept { return last_pose_; }
  [[nodiscard]] const FrameFolder& folder() const noexcept { return folder_; }
  [[nodiscard]] const ScorerConfig& config() const noexcept { return config_; }
  [[nodiscard]] const ViewScorer& scorer() const noexcept { return scorer_; }
  [[nodiscard]] std::uint64_t masked_pixels() const noexcept { return masked_pixels_; }

 private:
  void count(std::size_t index, const Pose& T_world_camera, const FrameFault& fault);

  FrameFolder folder_;
  ScorerConfig config_;
  ViewScorer scorer_;
  FrameTally tally_;
  FrameConsistency consistency_;
  std::vector<Pose> tried_;
  std::optional<Pose> last_pose_;
  std::uint64_t masked_pixels_ = 0;
};

}  // namespace viewgain::app
