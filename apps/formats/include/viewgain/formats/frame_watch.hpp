// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/formats/frames.hpp"

namespace viewgain {

/// How a folder is watched.
struct VIEWGAIN_EXPORT FrameWatchConfig {
  std::string sensor{};                              ///< as of open_frames()
  std::optional<double> depth_scale{};               ///< likewise [m per unit]
  std::optional<Sensor::OutOfRange> out_of_range{};  ///< nothing: the folder's own
  /// Each frame needs its mask in every one of them, in any order; somebody may be writing into
  /// these, too.
  std::vector<MaskFolder> masks{};
  /// Frames that are not to be given out again, each as frame_identity() has it.
  std::set<std::string> taken{};
  /// Somebody may be writing files that are younger: what is wrong with them is not yet wrong.
  std::chrono::milliseconds settle{2000};
};

/// A frame whose files are all there and whole.
struct VIEWGAIN_EXPORT WatchedFrame {
  std::uint64_t number = 0;         ///< in its files' names
  std::filesystem::path image;      ///< the depth image
  DepthFrame frame;                 ///< as load_frame() has it, without what masks take
  Pose T_world_camera;              ///< where it was taken
  std::uint64_t masked_pixels = 0;  ///< with a depth, that masks took
};

/// A frame that cannot be used as its files are.
struct VIEWGAIN_EXPORT BadFrame {
  std::uint64_t number = 0;  ///< in its files' names
  /// unreadable, wrong_size, lost_pose, changed; no_pose and no_mask of give_up(). Of two images
  /// of one number one is `changed`, and so is one whose number needs more than 64 bits.
  FrameFault fault{};
  std::string name{};                    ///< of its depth image
  std::optional<Pose> T_world_camera{};  ///< where it was taken, if that is known
};

/// What a look at the folder found.
struct VIEWGAIN_EXPORT FolderLook {
  std::optional<WatchedFrame>
      frame{};  ///< the complete one that is next in the list, if there is one
  /// Bad since the look before; numbers rising, those first whose number another has.
  std::vector<BadFrame> bad{};
};

/// A folder of frames of either layout (open_frames()) into which somebody else writes, file by
/// file and in any order. Files may appear by a rename or be written in place, slowly: a frame is
/// complete when its images end as PNG files do and can be read, and its pose is there, in the
/// recorded layout with a line's end or unchanged for FrameWatchConfig::settle, in ours as a line
/// of poses.txt with its end. Where any frame in the folder has an amplitude image, one without is
/// waited for as long. With FrameWatchConfig::masks a mask must be there, end and be readable as
/// well; one that is missing is waited for as a pose is. Masks are no part of what a frame is known
/// by (frame_identity()): one that was taken stays taken, whatever becomes of its mask. What holds
/// for all frames (sensor.toml, frames.toml, camera-intrinsics.txt) must be there before the
/// first frame is complete.
///
/// Whether files have changed is told by what the file system says of them; none is read twice for
/// nothing. Nothing is remembered beyond the object but what FrameWatchConfig::taken says. Thread
/// safety: one call at a time. Members that throw say so.
class VIEWGAIN_EXPORT FrameWatch {
 public:
  /// Of a look.
  using Time = std::chrono::steady_clock::time_point;

  /// Does not look at the folder yet: takes constant time.
  FrameWatch(std::filesystem::path dir, FrameWatchConfig config);
  ~FrameWatch();
  FrameWatch(FrameWatch&&) noexcept;
  FrameWatch& operator=(FrameWatch&&) noexcept;

  /// Looks at the folder; `now` must not go back. A frame that is given out counts as taken; the
  /// next one comes with the next look. The folder is listed when a look has come to the end of the
  /// last list, or after 256 of them. Throws Error(io) if the folder cannot be read, Error(format)
  /// if the first numbers of images and poses.txt do not fit for as long as `settle`, and with the
  /// first complete frame as open_frames() for what holds for all. Of frames that are taken or bad
  /// 256 are looked at again, in turns. Takes some µs a file of these and of the new ones.
  [[nodiscard]] FolderLook look(Time now);

  /// Nobody writes any more: frames that wait for a pose, a mask or, where poses.txt has a line
  /// for one, an image, are bad (no_pose, no_mask, unreadable), as long as their files do not
  /// change. These, numbers rising by what is missing. O(frames); files are not looked at.
  [[nodiscard]] std::vector<BadFrame> give_up();

  /// The caller has no use for the frame that the last look gave out: it is bad for this reason, as
  /// long as its files do not change.
  void refuse(const WatchedFrame& frame, FrameVerdict verdict);

  /// Sensor, scale and layout, without images and poses; nothing before the first complete frame.
  [[nodiscard]] const std::optional<FrameSequence>& folder() const noexcept;
  /// Of the frames that were taken, here and before.
  [[nodiscard]] std::set<std::string> taken() const;
  /// How many these are.
  [[nodiscard]] std::size_t taken_count() const;
  /// Frames in the folder of which something is missing or may still be written.
  [[nodiscard]] std::size_t waiting() const;
  /// Bad frames in the folder: verdict's name -> count.
  [[nodiscard]] std::map<std::string, std::size_t> bad() const;
  /// Have the looks found that nothing has changed, for FrameWatchConfig::settle of the frames that
  /// wait, since each of the others had its turn?
  [[nodiscard]] bool is_settled() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
