// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/frame_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "check/frame_meetings.hpp"
#include "check/suspicion.hpp"

namespace viewgain {
namespace {

constexpr std::size_t kMostKept = 12;

double median_of(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

FrameCheck::FrameCheck(const Sensor& sensor, std::optional<double> support_plane,
                       const ExecConfig& exec)
    : sensor_(sensor),
      support_plane_(support_plane),
      exec_(exec),
      agreement_(sensor, support_plane) {}

void FrameCheck::see(const DepthFrame& frame, const Pose& T_world_camera) {
  if (frame.width != sensor_.camera.width || frame.height != sensor_.camera.height) return;
  const std::size_t place = sequence_.size();
  sequence_.push_back(T_world_camera);
  if (place % keep_every_ != 0 || !rigid_pose(T_world_camera)) return;
  if (kept_.size() == kMostKept) {
    keep_every_ *= 2;
    for (std::size_t k = 1; 2 * k < kMostKept; ++k) {
      kept_[k] = std::move(kept_[2 * k]);
      places_[k] = places_[2 * k];
    }
    kept_.resize((kMostKept + 1) / 2);
    places_.resize(kept_.size());
    if (place % keep_every_ != 0) return;
  }
  kept_.push_back({frame.width, frame.height, frame.depth});
  places_.push_back(place);
}

void FrameCheck::look(const BeliefGrid& before, const DepthFrame& frame, const Pose& T_world_camera,
                      const PoseSigma& pose_sigma) {
  agreement_.look(before, frame, T_world_camera, pose_sigma);
}

FrameConsistency FrameCheck::result(const BeliefGrid& after) const {
  FrameConsistency result;
  result.frames = agreement_.frames(after);
  FrameContradiction all;
  std::vector<double> displacement, expected;
  for (const FrameContradiction& frame : result.frames) {
    all.readings += frame.readings;
    all.in_free += frame.in_free;
    all.others += frame.others;
    all.seen_past += frame.seen_past;
    if (frame.compared == 0) continue;
    displacement.push_back(frame.displacement);
    expected.push_back(frame.expected);
  }
  result.displacement = median_of(std::move(displacement));
  result.expected = median_of(std::move(expected));
  result.in_free = all.in_free;
  result.seen_past = all.seen_past;
  result.share_in_free = all.share_in_free();
  result.share_seen_past = all.share_seen_past();
  const double voxel_size = after.voxel_size();
  const Suspicion contradiction = detail::suspect_contradiction(result, voxel_size);
  const JumpEdgeFilter filter(sensor_.camera, {}, exec_);
  const detail::FrameMeetings meetings(sensor_, filter, kept_, sequence_, places_);
  result.suspicion = detail::suspicion_of(sensor_, kept_, meetings, support_plane_, contradiction);
  if (result.suspicion.kind.empty()) return result;
  const double most = std::max(detail::kContradicting, 0.5 * detail::largest_share(result));
  for (std::size_t i = 0; i < result.frames.size(); ++i) {
    const FrameContradiction& frame = result.frames[i];
    const double share = std::max(frame.share_in_free(), frame.share_seen_past());
    const bool is_copy = frame.same_image_as && share >= detail::kContradicting;
    const bool is_displaced = contradiction.kind == "displacement" &&
                              detail::is_displaced(frame.displacement, frame.expected, voxel_size);
    if (share >= most || is_copy || is_displaced) result.contradicting.push_back(i);
  }
  return result;
}

std::string ranges_text(const std::vector<std::size_t>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t end = i + 1;
    while (end < numbers.size() && numbers[end] == numbers[end - 1] + 1) ++end;
    text += (text.empty() ? "" : ", ") + std::to_string(numbers[i]);
    if (end - i > 1) text += "-" + std::to_string(numbers[end - 1]);
    i = end;
  }
  return text;
}

}  // namespace viewgain
