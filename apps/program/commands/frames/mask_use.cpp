// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/frames/mask_use.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>
#include <vector>

#include "program/cli/values.hpp"
#include "program/commands/frames/frame_tally.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/raycast/suspect_set_up.hpp"

namespace viewgain::app {
namespace {

constexpr std::size_t kFrames = 12;  // number of checked frames

}  // namespace

std::string mask_suspicion(const FrameFolder& folder, const BeliefGrid* map) {
  if (!folder.has_masks()) return {};
  std::vector<DepthFrame> unmasked, masked;
  std::vector<Pose> poses;
  const std::size_t step = std::max<std::size_t>(1, folder.size() / kFrames);
  for (std::size_t i = 0; i < folder.size() && masked.size() < kFrames; i += step) {
    FrameReading reading = folder.load(i);
    if (reading.fault.verdict != FrameVerdict::used) continue;
    unmasked.push_back(load_frame(folder.frames(), i));
    masked.push_back(std::move(reading.frame));
    poses.push_back(folder.T_world_camera(i));
  }
  return suspect_masks(folder.sensor(), unmasked, masked, poses, map).what;
}

void MaskWatch::add(const FrameSequence& folder, const WatchedFrame& frame) {
  if (is_suspected_ || masked_.size() >= kFrames) return;
  FrameSequence one = folder;
  one.images = {frame.image};
  try {
    unmasked_.push_back(load_frame(one, 0));
  } catch (const Error&) {  // the file has changed since
    return;
  }
  masked_.push_back(frame.frame);
  poses_.push_back(frame.T_world_camera);
}

std::string MaskWatch::suspicion(const Sensor& sensor, const BeliefGrid& map, bool is_last) {
  const bool is_due = is_last || 2 * masked_.size() == kFrames || masked_.size() == kFrames;
  if (is_suspected_ || !is_due || judged_ == masked_.size()) return {};
  judged_ = masked_.size();
  std::string what = suspect_masks(sensor, unmasked_, masked_, poses_, &map).what;
  is_suspected_ = !what.empty();
  return what;
}

std::string masked_text(const FrameFolderOptions& options, std::uint64_t pixels) {
  if (options.mask.empty() && options.confidence.empty()) return {};
  return "pixels removed by masks: " + with_commas(pixels) + "\n";
}

bool FrameTally::blames_masks(const FrameFolder& folder, const BeliefGrid& map) const {
  const std::string what = mask_suspicion(folder, &map);
  if (what.empty()) return false;
  const bool has_frames = counts_.empty() || is_in_map(counts_.begin()->first);
  if (!has_frames) refuse(folder.name() + ": " + what);
  name_left_out();
  std::fprintf(stderr, "viewgain: warning: %s: %s\n", folder.name().c_str(), what.c_str());
  return true;
}

}  // namespace viewgain::app
