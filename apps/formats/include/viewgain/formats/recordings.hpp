// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/camera.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/frame_verdict.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/formats/png.hpp"

/// @file
/// Recordings of others. Cost of opening: O(frames), images are not decoded; of loading and
/// importing: O(pixels) a frame, one frame in memory.

namespace viewgain {

/// How others lay out recordings of depth images with poses.
enum class VIEWGAIN_EXPORT RecordingFormat : std::uint8_t {
  /// depth.txt (timestamp [s] and image a line), groundtruth.txt (TUM poses), images in 1/5000 m.
  tum,
  /// A scene of BOP: depth/NNNNNN.png, scene_camera.json with cam_K, depth_scale (to mm) and the
  /// pose world to camera, cam_R_w2c and cam_t_w2c [mm].
  bop,
  /// depth/N.png in mm, pose/N.txt (4x4, camera to world [m]; not finite where tracking was lost),
  /// intrinsic/intrinsic_depth.txt.
  scannet,
  /// The PNGs of ICL-NUIM that are like TUM's: depth/N.png in 1/5000 m, along z, and one
  /// *.gt.freiburg (or groundtruth.txt), whose first number is N. Its camera has y up.
  icl_nuim,
};

/// tum, bop, scannet, icl-nuim: in the order of the enumeration.
[[nodiscard]] VIEWGAIN_EXPORT const std::vector<std::string>& recording_format_names();
/// Throws Error(invalid_argument) that names the valid ones.
[[nodiscard]] VIEWGAIN_EXPORT RecordingFormat recording_format(std::string_view name);

/// What a recording does not say itself.
struct VIEWGAIN_EXPORT RecordingConfig {
  /// Needed for tum. For icl_nuim the published one, fx 481.2, fy -480, cx 319.5, cy 239.5, where
  /// there is none. The others have their own. Of 0 x 0 px: of the images' size. A negative fy says
  /// that y is up in the camera's frame.
  std::optional<PinholeCamera> camera{};
  double max_time_gap = 0.02;  ///< between an image and its pose, tum [s]
};

/// A frame that can be used.
struct VIEWGAIN_EXPORT RecordedFrame {
  std::uint64_t number = 0;     ///< the source's; tum: the place in depth.txt, from 0
  std::filesystem::path image;  ///< 16-bit depth along z
  Pose T_world_camera;          ///< orthonormalised
};

/// A recording, opened but not read.
struct VIEWGAIN_EXPORT Recording {
  std::vector<RecordedFrame> frames;  ///< numbers rising
  PinholeCamera camera;               ///< of the images that load_depth() returns
  double depth_scale = 0;             ///< [m] per unit
  /// The images' rows are to be reversed, since the camera's frame has y up. Then the pixels of
  /// load_depth() fit the poses, and world coordinates stay those of the recording, mirrored as it
  /// has them.
  bool rows_reversed = false;
  /// Frames that cannot be used: no_pose, lost_pose, unreadable, wrong_size, intrinsics and
  /// depth_scale (other than the first frame's).
  FrameCounts dropped;
  std::string fault;                ///< of the first that a file's contents are to blame for
  std::size_t orthonormalized = 0;  ///< frames whose rotation was off by 1e-9 to 1e-2 and mended
};

/// Finds the frames of a recording and their poses; of the images only sizes are read. Throws
/// Error(io) or Error(format), naming the file and where there is one the line, for what is missing
/// or damaged, also for a recording without a frame that can be used; Error(invalid_argument) for a
/// camera that is needed, cannot be used or is the recording's own, or a gap that is negative.
[[nodiscard]] VIEWGAIN_EXPORT Recording open_recording(const std::filesystem::path& source,
                                                       RecordingFormat format,
                                                       const RecordingConfig& config = {});

/// The depth image of a frame, rows as Recording::camera has them, a pixel of 65535 (which means
/// nothing in these formats) as 0. Throws as read_gray_png(), and Error(invalid_argument) for an
/// index that is not less than the count of frames. May be called from many threads.
[[nodiscard]] VIEWGAIN_EXPORT GrayImage load_depth(const Recording& recording, std::size_t index);

/// How a recording is imported.
struct VIEWGAIN_EXPORT ImportConfig {
  /// Whose noise and range limits sensor.toml is to have; nothing: none is written.
  std::optional<Sensor> sensor{};
  /// Folder of masks by the names of the recording's images (see MaskFolder), empty: none.
  std::filesystem::path masks{};
  /// Folder of confidences likewise.
  std::filesystem::path confidences{};
  std::uint8_t least_confidence = 1;  ///< that counts
  /// Folder of amplitude images by the names of the recording's images, grayscale PNGs of up to 16
  /// bits, empty: none. They tell how readings scatter, see ShotNoise.
  std::filesystem::path amplitudes{};
  double amplitude_scale = 1e-3;  ///< [m⁻²] per unit
  /// Called with the count of frames done and of all.
  std::function<void(std::size_t, std::size_t)> progress{};
};

/// What an import came to.
struct VIEWGAIN_EXPORT ImportReport {
  std::uint64_t readings = 0;       ///< pixels with a depth that were written
  std::uint64_t masked_pixels = 0;  ///< with a depth, taken away by masks or confidences
  std::size_t masks = 0;            ///< frames that have one or the other
  std::size_t amplitudes = 0;       ///< frames that have an amplitude image
  std::size_t unreadable = 0;       ///< frames that are left out since their image is damaged
};

/// Writes a recording's frames into a folder that open_frames() reads (RecordedFramesWriter), which
/// appears whole or not at all. Throws as load_depth(), read_gray_png(), MaskFolder and
/// RecordedFramesWriter do, also for masks or amplitudes none of which is of a frame, and
/// Error(invalid_argument) for a scale of amplitudes that is not positive and finite.
VIEWGAIN_EXPORT ImportReport import_recording(const Recording& recording,
                                              const std::filesystem::path& out,
                                              const ImportConfig& config = {});

}  // namespace viewgain
