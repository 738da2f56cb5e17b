// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "program/cli/flags/frame_folder.hpp"
#include "viewgain/formats/frame_watch.hpp"
#include "viewgain/grid/belief_grid.hpp"

namespace viewgain::app {

/// What is probably wrong with the masks of a folder's frames (suspect_masks()); empty if nothing,
/// or without masks. Reads a dozen frames with and without their masks.
[[nodiscard]] std::string mask_suspicion(const FrameFolder& folder,
                                         const BeliefGrid* map = nullptr);

/// The same for frames that arrive one by one.
class MaskWatch {
 public:
  /// `folder`: FrameWatch::folder(). Reads the image again, without its masks.
  void add(const FrameSequence& folder, const WatchedFrame& frame);
  /// What is probably wrong, reported once. Checked after six and after twelve frames, and at the
  /// end.
  [[nodiscard]] std::string suspicion(const Sensor& sensor, const BeliefGrid& map, bool is_last);
  /// Whether it was reported; frames then need no other explanation.
  [[nodiscard]] bool is_suspected() const noexcept { return is_suspected_; }

 private:
  std::vector<DepthFrame> unmasked_, masked_;
  std::vector<Pose> poses_;
  std::size_t judged_ = 0;  // frames
  bool is_suspected_ = false;
};

/// A line about pixels with a depth that masks removed; empty without --mask and --confidence.
[[nodiscard]] std::string masked_text(const FrameFolderOptions& options, std::uint64_t pixels);

}  // namespace viewgain::app
