// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "viewgain/core/camera.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/frame_verdict.hpp"
#include "viewgain/core/sensor.hpp"

/// @file
/// Recordings in the layout of TUM's RGB-D data sets: depth.txt (timestamp [s] and image a line),
/// groundtruth.txt (TUM poses), 16-bit images in 1/5000 m along z.

namespace viewgain {

/// How a recording is imported.
struct VIEWGAIN_EXPORT ImportConfig {
  PinholeCamera camera{};      ///< of 0 x 0 px: of the images' size
  double max_time_gap = 0.02;  ///< between an image and its pose [s]
  /// Whose noise and range limits sensor.toml is to have; nothing: none is written.
  std::optional<Sensor> sensor{};
  /// Folder of masks by the names of the recording's images (see MaskFolder), empty: none.
  std::filesystem::path masks{};
  /// Folder of confidences likewise.
  std::filesystem::path confidences{};
  std::uint8_t least_confidence = 1;  ///< that counts
  /// Called with the count of frames done and of all.
  std::function<void(std::size_t, std::size_t)> progress{};
};

/// What an import came to.
struct VIEWGAIN_EXPORT ImportReport {
  std::size_t frames = 0;           ///< that were written
  PinholeCamera camera;             ///< of their images
  FrameCounts bad;                  ///< left out: no_pose, lost_pose, unreadable, wrong_size
  std::size_t orthonormalized = 0;  ///< whose rotation was off by 1e-9 to 1e-2 and mended
  std::uint64_t readings = 0;       ///< pixels with a depth that were written
  std::uint64_t masked_pixels = 0;  ///< with a depth, taken away by masks or confidences
  std::size_t masks = 0;            ///< frames that have one or the other
};

/// Writes a recording's frames into a folder that open_frames() reads which
/// appears whole or not at all. Each frame has the pose nearest in time, nothing is interpolated,
/// and the number of its place in depth.txt, from 0; a pixel of 65535, which means nothing here,
/// becomes 0. Files that are read must not be links out of the recording; others may.
///
/// Throws Error(io) or Error(format), naming the file and where there is one the line, for what is
/// missing or damaged and not one frame's, also for a recording without a frame that can be used
/// and for masks none of which is of a frame; as MaskFolder does;
/// Error(invalid_argument) for a camera that cannot be used, a gap that is negative, or a folder
/// with frames that no import has left. Cost:
/// O(pixels), one frame in memory.
VIEWGAIN_EXPORT ImportReport import_recording(const std::filesystem::path& source,
                                              const std::filesystem::path& out,
                                              const ImportConfig& config);

}  // namespace viewgain
