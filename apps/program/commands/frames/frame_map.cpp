// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/frames/frame_map.hpp"

#include <utility>

#include "program/cli/flags/common_options.hpp"
#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/flags/set_up_warnings.hpp"
#include "program/cli/help.hpp"
#include "program/cli/progress.hpp"
#include "program/cli/values.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/jump_edge_filter.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain::app {
namespace {

ScorerConfig config_of(const FrameFolder& folder, const FrameMapOptions& options,
                       const ProposalOptions& proposal, bool quiet, const ExecConfig& exec) {
  ScorerConfig config = scorer_config(options, proposal);
  config.workspace = options.workspace.empty()
                         ? seen_workspace(folder, config, options.voxel, quiet, exec)
                         : parse_box("--workspace", options.workspace);
  const BeliefGrid empty(config.grid());
  warn_of_few_voxels(empty);
  config.hazard = hazard_source(proposal.hazard, empty);
  config.gain.model = GainModel::paper;  // no view is scored before all frames are integrated
  return config;
}

}  // namespace

ScorerConfig scorer_config(const FrameMapOptions& options, const ProposalOptions& proposal) {
  check_positive("--voxel", options.voxel);
  ScorerConfig config;
  config.voxel_size = options.voxel;
  config.jump_edges = parse_jump_edge_filter(options.jump_edge_filter);
  config.obstacles = obstacles_of(proposal.obstacles);
  config.support_plane = proposal.support_plane;
  options.scales.set(config);
  config.learn_hazard = true;
  return config;
}

Box seen_workspace(const FrameFolder& folder, const ScorerConfig& config, double voxel, bool quiet,
                   const ExecConfig& exec) {
  std::optional<JumpEdgeFilter> filter;
  if (config.jump_edges) filter.emplace(folder.sensor().camera, *config.jump_edges, exec);
  Progress progress("bounds of frame", quiet);
  FrameTally tally(true);
  const auto bounds = [&](std::size_t i) {
    FrameReading reading = folder.load(i);
    progress.update(i + 1, folder.size());
    if (reading.fault.verdict != FrameVerdict::used) {
      tally.add(folder.frames().images[i], reading.fault);
      return std::optional<Box>();
    }
    if (filter) filter->apply(reading.frame);
    return reading_bounds(folder.sensor(), reading.frame, folder.T_world_camera(i), {},
                          config.support_plane);
  };
  const std::optional<Box> seen = workspace_around(folder.size(), voxel, bounds);
  if (!seen) refuse_without_readings(folder, tally);
  try {
    (void)BeliefGrid({.voxel_size = voxel, .workspace = *seen});
  } catch (const Error& error) {  // too many voxels
    const std::string suspicion = suspicion_of(folder);
    throw Error(error.code(),
                folder.name() + ": " + error.what() + (suspicion.empty() ? "" : "; " + suspicion));
  }
  return *seen;
}

void add_frame_map_options(App& app, FrameMapOptions& options) {
  app.add_option("FRAMES_DIR", options.folder.folder,
                 "folder of depth images with poses (see viewgain integrate --help)")
      ->required();
  app.add_option("--sensor", options.folder.sensor, kSensorHelp + " (default: from the folder)");
  app.add_option("--voxel", options.voxel, "voxel size [m]")->required();
  app.add_option("--workspace", options.workspace,
                 "x0,y0,z0,x1,y1,z1: box to map [m] (default: all that the frames see)");
  begin_group(app, "Frames");
  app.add_option("--jump-edge-filter", options.jump_edge_filter, kJumpEdgeHelp);
  add_scale_options(app, options.scales);
  add_frame_folder_options(app, options.folder);
}

FrameMap::FrameMap(const FrameMapOptions& options, const ProposalOptions& proposal, bool quiet,
                   const ExecConfig& exec)
    : folder_(options.folder),
      config_(config_of(folder_, options, proposal, quiet, exec)),
      scorer_(with_body(folder_.sensor(), proposal), config_, exec),
      tally_(quiet) {
  warn_of_set_up(proposal, config_.obstacles, scorer_.grid(), scorer_.sensor(), true);
}

MapUpdate FrameMap::add(std::size_t index) { return add(index, folder_.T_world_camera(index)); }

MapUpdate FrameMap::add(std::size_t index, const Pose& T_world_camera,
                        const PoseSigma& pose_sigma) {
  FrameReading reading = folder_.load(index);
  MapUpdate update;
  if (reading.fault.verdict == FrameVerdict::used) {
    Measurements measurements{T_world_camera, {}, pose_sigma};
    measurements.frames.push_back(std::move(reading.frame));
    update = scorer_.add(measurements);
    reading.fault.verdict = update.verdict;
    if (is_in_map(update.verdict)) masked_pixels_ += reading.masked_pixels;
    tally_.add(update.counts);
  }
  update.verdict = reading.fault.verdict;
  count(index, T_world_camera, reading.fault);
  return update;
}

void FrameMap::count(std::size_t index, const Pose& T_world_camera, const FrameFault& fault) {
  tally_.add(folder_.frames().images[index], fault);
  if (rigid_pose(T_world_camera)) last_pose_ = T_world_camera;
  const Pose& reported = folder_.T_world_camera(index);
  if (!is_in_map(fault.verdict) && rigid_pose(reported)) tried_.push_back(reported);
}

}  // namespace viewgain::app
