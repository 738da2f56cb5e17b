// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include "check/suspicion.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::detail {
namespace {

// "2.3 mm": two significant digits.
std::string millimetres(double metres) {
  const double digit = std::pow(10.0, std::floor(std::log10(std::max(metres, 1e-9))) - 1);
  return short_text(static_cast<float>(std::round(metres / digit) * digit * 1000)) + " mm";
}

bool contradicts(const FrameContradiction& frame, double share) {
  return (frame.readings >= kEnoughReadings && frame.share_in_free() > share) ||
         (frame.others >= kEnoughReadings && frame.share_seen_past() > share);
}

// How frames contradict each other; empty if they do not.
std::string contradiction_of(const FrameConsistency& found) {
  if (found.share_in_free > kInFree && found.in_free >= kEnoughContradictions) {
    return percent(found.share_in_free) +
           " of the points lie in space that other frames saw as free";
  }
  if (found.share_seen_past > kSeenPast && found.seen_past >= kEnoughContradictions) {
    return "later frames see free space at " + percent(found.share_seen_past) +
           " of the points of earlier frames";
  }
  const bool is_one =
      std::any_of(found.frames.begin(), found.frames.end(),
                  [](const FrameContradiction& frame) { return contradicts(frame, kOfAFrame); });
  if (!is_one) return {};
  return "up to " + percent(largest_share(found)) +
         " of a frame's points contradict other frames, which see free space there";
}

// Frames that are displaced, but by too little for their readings to contradict each other.
Suspicion suspect_displacement(const FrameConsistency& found, double voxel_size) {
  const auto compared =
      std::count_if(found.frames.begin(), found.frames.end(),
                    [](const FrameContradiction& frame) { return frame.compared > 0; });
  if (static_cast<std::size_t>(compared) < kEnoughFrames ||
      !is_displaced(found.displacement, found.expected, voxel_size)) {
    return {};
  }
  return {
      "displacement",
      "surfaces are displaced by " + millimetres(found.displacement) +
          " between frames; the declared errors of the sensor and the poses explain only " +
          millimetres(found.expected) +
          ". Are the poses late? Is the hand-eye calibration or the focal length wrong? Do the "
          "poses drift? Registration (--register on) corrects small errors. If you cannot improve "
          "the poses, declare their errors: pose_sigma_rad in the sensor file"};
}

}  // namespace

std::string percent(double share) { return short_text(std::round(100 * share)) + " %"; }

double largest_share(const FrameConsistency& found) {
  double most = 0;
  for (const FrameContradiction& frame : found.frames) {
    if (frame.readings >= kEnoughReadings) most = std::max(most, frame.share_in_free());
    if (frame.others >= kEnoughReadings) most = std::max(most, frame.share_seen_past());
  }
  return most;
}

bool is_displaced(double displacement, double expected, double voxel_size) {
  return displacement > std::max(kDisplaced * expected, kOfAVoxel * voxel_size);
}

Suspicion suspect_contradiction(const FrameConsistency& found, double voxel_size) {
  const std::string now = contradiction_of(found);
  if (now.empty()) return suspect_displacement(found, voxel_size);
  const auto copies =
      std::count_if(found.frames.begin(), found.frames.end(), [](const FrameContradiction& frame) {
        return frame.same_image_as && contradicts(frame, kContradicting);
      });
  if (copies > 0) {
    return {"same_image", now + ". " + std::to_string(copies) +
                              (copies == 1 ? " frame has" : " frames have") +
                              " the same image as an earlier frame, but another pose. Does the "
                              "camera repeat images?"};
  }
  return {
      "contradiction",
      now +
          ". Are the poses those of a flange or body, not of the camera? Are they late or early? "
          "Are poses and images numbered differently? Are the images mirrored? Are the "
          "intrinsics those of another camera? Did an object move? Do the poses drift?"};
}

}  // namespace viewgain::detail
