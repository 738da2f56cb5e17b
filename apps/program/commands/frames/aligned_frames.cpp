// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/frames/aligned_frames.hpp"

#include <cstddef>
#include <vector>

#include "program/cli/progress.hpp"
#include "viewgain/planner/align_frames.hpp"

namespace viewgain::app {

std::map<std::size_t, FrameRegistration> align_folder(const FrameMap& map, const PoseSigma& sigma,
                                                      bool quiet, const ExecConfig& exec,
                                                      const std::stop_token& stop) {
  FrameAlignment alignment(map.model().sensor(), map.config(), exec);
  Progress progress("alignment of frame", quiet);
  const FrameFolder& folder = map.folder();
  std::vector<std::size_t> aligned;
  for (std::size_t i = 0; i < folder.size() && !stop.stop_requested(); ++i) {
    const FrameReading reading = folder.load(i);
    progress.update(i + 1, folder.size());
    if (reading.fault.verdict != FrameVerdict::used) continue;
    alignment.add(reading.frame, folder.T_world_camera(i), sigma);
    aligned.push_back(i);
  }
  std::map<std::size_t, FrameRegistration> registrations;
  for (std::size_t k = 0; k < aligned.size(); ++k) {
    registrations.emplace(aligned[k], alignment.registrations()[k]);
  }
  return registrations;
}

}  // namespace viewgain::app
