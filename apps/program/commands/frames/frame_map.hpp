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

/// How a folder of frames becomes a map on the way to something else.
struct FrameMapOptions {
  FrameFolderOptions folder;
  double voxel = 0;
  std::string workspace;
  std::string jump_edge_filter = "5";
  ScaleOptions scales;
};

/// FRAMES_DIR, --sensor, --voxel, --workspace, --jump-edge-filter, --scales, --fine and those of a
/// folder.
void add_frame_map_options(App& app, FrameMapOptions& options);

/// Settings of the map but for workspace, hazard and gain. Throws Error, naming the flag.
[[nodiscard]] ScorerConfig scorer_config(const FrameMapOptions& options,
                                         const ProposalOptions& proposal);

/// The workspace for what the frames see, but for the pixels that --jump-edge-filter takes; reads
/// all of them. Throws Error(invalid_argument) if none has a reading.
[[nodiscard]] Box seen_workspace(const FrameFolder& folder, const ScorerConfig& config,
                                 double voxel, bool quiet);

/// The map as frames of a folder go into it, in the folder's order.
class FrameMap {
 public:
  /// Throws Error, naming the flag or the file, as FrameFolder, parse_box(), hazard_source(),
  /// obstacles_of() and ViewScorer. Without --workspace all frames are read for
  /// their bounds; throws if none has a reading.
  FrameMap(const FrameMapOptions& options, const ProposalOptions& proposal, bool quiet,
           const ExecConfig& exec);

  /// At the pose that the folder says, or at another that may be off by `pose_sigma`; what became
  /// of the frame is in MapUpdate::verdict and counted.
  MapUpdate add(std::size_t index);
  MapUpdate add(std::size_t index, const Pose& T_world_camera, const PoseSigma& pose_sigma = {});
  /// The frame is left out for another reason.
  void drop(std::size_t index, const FrameFault& fault) {
    count(index, folder_.T_world_camera(index), fault);
  }

  /// Throws as FrameTally::require_any().
  void require_frames() {
    consistency_ = scorer_.consistency();
    tally_.require_any(folder_, scorer_.grid(), consistency_);
  }
  /// Whether the frames fit one another, for JSON; after require_frames().
  [[nodiscard]] Json consistency_json() const { return to_json(consistency_, tally_.numbers()); }

  [[nodiscard]] const FrameCounts& counts() const noexcept { return tally_.counts(); }
  /// Where frames were taken that brought nothing, as the folder says.
  [[nodiscard]] const std::vector<Pose>& tried() const noexcept { return tried_; }
  /// Where the last frame was taken, whether it could be used or not; nothing: no pose yet.
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
