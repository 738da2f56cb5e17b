// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "program/cli/app.hpp"
#include "program/cli/flags/frame_folder.hpp"
#include "program/commands/proposal/view_proposal.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/planner/map_model.hpp"

namespace viewgain::app {

/// How a folder of frames becomes a map on the way to something else.
struct FrameMapOptions {
  FrameFolderOptions folder;
  double voxel = 0;
  std::string workspace;
  std::string jump_edge_filter = "5";
  bool refine = true;
};

/// Is this a folder, and so no map and no mesh?
[[nodiscard]] bool is_frame_folder(const std::filesystem::path& path);

/// FRAMES_DIR, --sensor, --voxel, --workspace, --jump-edge-filter and those of a folder.
void add_frame_map_options(App& app, FrameMapOptions& options);

/// The map as frames of a folder go into it, in the folder's order.
class FrameMap {
 public:
  /// Throws Error, naming the flag or the file, as FrameFolder, parse_box(), hazard_source(),
  /// obstacles_of() and MapModel. Without --workspace all frames are read for
  /// their bounds; throws if none has a reading.
  FrameMap(const FrameMapOptions& options, const ProposalOptions& proposal, bool quiet,
           const ExecConfig& exec);

  /// At the pose that the folder says, or at another that may be off by `pose_sigma`. Throws as
  /// FrameFolder::load() and MapModel::update().
  MapUpdate add(std::size_t index) { return add(index, folder_.T_world_camera(index)); }
  MapUpdate add(std::size_t index, const Pose& T_world_camera, const PoseSigma& pose_sigma = {});

  /// Throws Error(invalid_argument), naming the folder and the scale, if frames were added and none
  /// had a reading in the workspace: that comes of a wrong scale, sensor or workspace.
  void require_readings() const;

  [[nodiscard]] const FrameFolder& folder() const noexcept { return folder_; }
  [[nodiscard]] const MapModelConfig& config() const noexcept { return config_; }
  [[nodiscard]] const MapModel& model() const noexcept { return model_; }
  [[nodiscard]] std::uint64_t masked_pixels() const noexcept { return masked_pixels_; }

 private:
  FrameFolder folder_;
  MapModelConfig config_;
  MapModel model_;
  std::uint64_t masked_pixels_ = 0;
  std::uint64_t readings_ = 0, readings_used_ = 0;
};

}  // namespace viewgain::app
