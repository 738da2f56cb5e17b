// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/frames/aligned_frames.hpp"

#include <cstddef>

#include "program/cli/progress.hpp"
#include "viewgain/planner/align_frames.hpp"

namespace viewgain::app {

std::vector<FrameRegistration> align_folder(const FrameMap& map, const PoseSigma& sigma, bool quiet,
                                            const ExecConfig& exec) {
  FrameAlignment alignment(map.model().sensor(), map.config(), exec);
  Progress progress("alignment of frame", quiet);
  const FrameFolder& folder = map.folder();
  for (std::size_t i = 0; i < folder.size(); ++i) {
    alignment.add(folder.load(i).frame, folder.T_world_camera(i), sigma);
    progress.update(i + 1, folder.size());
  }
  return alignment.registrations();
}

}  // namespace viewgain::app
