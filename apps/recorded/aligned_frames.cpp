// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "aligned_frames.hpp"

#include <cstddef>
#include <optional>
#include <utility>

#include "command_line/progress.hpp"
#include "options/obstacle_source.hpp"
#include "options/sensing.hpp"
#include "viewgain/core/jump_edge_filter.hpp"
#include "viewgain/planner/align_frames.hpp"
#include "viewgain/raycast/obstacle_view.hpp"

namespace viewgain::app {

std::vector<FrameRegistration> align_folder(const FrameMap& map, const FrameMapOptions& options,
                                            const ProposalOptions& proposal,
                                            const PosePrior& sigmas, bool quiet,
                                            const ExecConfig& exec) {
  const Sensor& sensor = map.model().sensor();
  RegistrationConfig config;
  config.support_plane = proposal.support_plane;
  FrameAlignment alignment(sensor, map.model().grid(), config, exec);
  std::optional<JumpEdgeFilter> filter;
  if (const auto edges = parse_jump_edge_filter(options.jump_edge_filter, false)) {
    filter.emplace(sensor.camera, *edges);
  }
  ObstacleView obstacles(obstacles_of(proposal.obstacles), sensor, exec);
  std::vector<FrameRegistration> all;
  Progress progress("alignment of frame", quiet);
  const FrameFolder& folder = map.folder();
  for (std::size_t i = 0; i < folder.size(); ++i) {
    DepthFrame frame = folder.load(i).frame;
    if (filter) filter->apply(frame);
    PosePrior prior = sigmas;
    prior.T_world_camera = folder.T_world_camera(i);
    obstacles.mark(frame, prior.T_world_camera);
    all.push_back(alignment.add(frame, prior));
    progress.update(i + 1, folder.size());
  }
  std::vector<FrameRegistration> known = alignment.registrations();
  auto next = known.begin();
  for (FrameRegistration& registration : all) {
    if (registration.status != RegistrationStatus::refused) registration = std::move(*next++);
  }
  return all;
}

}  // namespace viewgain::app
