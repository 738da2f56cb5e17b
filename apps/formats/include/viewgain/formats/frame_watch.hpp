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

/// Settings for watching a folder.
struct VIEWGAIN_EXPORT FrameWatchConfig {
  std::string sensor{};                              ///< as in open_frames()
  std::optional<double> depth_scale{};               ///< as in open_frames() [m per unit]
  std::optional<Sensor::OutOfRange> out_of_range{};  ///< empty: the folder's own
  /// Folders of masks; each frame needs a mask in all of them. Masks may also arrive late.
  std::vector<MaskFolder> masks{};
  /// Identities (frame_identity()) of frames that are not returned again.
  std::set<std::string> taken{};
  /// Faults of files that changed more recently than this are ignored, because another program may
  /// still be writing these files.
  std::chrono::milliseconds settle{2000};
};

/// A complete frame.
struct VIEWGAIN_EXPORT WatchedFrame {
  std::uint64_t number = 0;         ///< from its file names
  std::filesystem::path image;      ///< depth image
  DepthFrame frame;                 ///< as from load_frame(), without masked pixels
  Pose T_world_camera;              ///< camera pose
  std::uint64_t masked_pixels = 0;  ///< masked pixels that had a depth
};

/// A frame whose files cannot be used.
struct VIEWGAIN_EXPORT BadFrame {
  std::uint64_t number = 0;  ///< from its file names
  /// unreadable, wrong_size, lost_pose or changed; no_pose and no_mask come from give_up().
  /// `changed` also marks one of two images with the same number, and a number of more than 64
  /// bits.
  FrameFault fault{};
  std::string name{};                    ///< file name of its depth image
  std::optional<Pose> T_world_camera{};  ///< camera pose, if known
};

/// Result of a look at the folder.
struct VIEWGAIN_EXPORT FolderLook {
  std::optional<WatchedFrame> frame{};  ///< the next complete frame, if any
  /// New faults since the previous look, in order of their numbers. Frames that share their number
  /// with another frame come first.
  std::vector<BadFrame> bad{};
};

/// Watches a folder of frames of either layout (open_frames()) that another program writes to, file
/// by file, in any order. Files may be renamed into place or written slowly. A frame is complete
/// when its images and masks are complete PNG files, and its pose is a complete line of poses.txt
/// or a complete pose file. A pose file without a line end is complete if it has not changed for
/// FrameWatchConfig::settle. If any frame of the folder has an amplitude image, the others need one
/// too. sensor.toml, frames.toml and camera-intrinsics.txt must exist before the first frame. Masks
/// are not part of a frame's identity.
///
/// Detects changes by the files' times and sizes, and does not read unchanged files again. To
/// continue with a new object, pass taken() as FrameWatchConfig::taken. Thread safety: one call at
/// a time.
class VIEWGAIN_EXPORT FrameWatch {
 public:
  /// Time of a look.
  using Time = std::chrono::steady_clock::time_point;

  /// Does not look at the folder; constant time.
  FrameWatch(std::filesystem::path dir, FrameWatchConfig config);
  ~FrameWatch();
  FrameWatch(FrameWatch&&) noexcept;
  FrameWatch& operator=(FrameWatch&&) noexcept;

  /// Looks at the folder; `now` must not decrease. A returned frame counts as taken; the next look
  /// returns the next frame. Each look also checks the next 256 taken or bad frames for changes.
  /// Throws Error(io) if the folder cannot be read. Throws Error(format) if the first numbers of
  /// images and poses.txt disagree for longer than `settle`. With the first complete frame, also
  /// throws whatever open_frames() throws. Cost: a few µs per file of new and checked frames.
  [[nodiscard]] FolderLook look(Time now);

  /// Ends the wait for incomplete frames. Frames that lack a pose, a mask or an image that
  /// poses.txt lists become bad (no_pose, no_mask, unreadable) until their files change. Returns
  /// these frames in order of their numbers. Cost: O(frames); does not look at files.
  [[nodiscard]] std::vector<BadFrame> give_up();

  /// Rejects the frame of the last look: it counts as bad, with this verdict, until its files
  /// change.
  void refuse(const WatchedFrame& frame, FrameVerdict verdict);

  /// Sensor, scale and layout, without images and poses; empty before the first complete frame.
  [[nodiscard]] const std::optional<FrameSequence>& folder() const noexcept;
  /// Identities of the taken frames, including FrameWatchConfig::taken.
  [[nodiscard]] std::set<std::string> taken() const;
  /// Number of taken frames.
  [[nodiscard]] std::size_t taken_count() const;
  /// Number of frames in the folder that are incomplete or may still be written.
  [[nodiscard]] std::size_t waiting() const;
  /// Number of bad frames in the folder for each verdict, with its name as the key.
  [[nodiscard]] std::map<std::string, std::size_t> bad() const;
  /// Whether nothing changes any more: waiting frames have not changed for
  /// FrameWatchConfig::settle, and the other frames have not changed since their last check.
  [[nodiscard]] bool is_settled() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
