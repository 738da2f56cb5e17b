// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/frame_verdict.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/range_calibration.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/formats/staged_folder.hpp"

namespace viewgain {

/// A folder of masks that exclude pixels of depth images, for example of the arm that carries the
/// camera. A mask is a grayscale PNG of 1 to 8 bits with the depth image's name and size; nonzero
/// pixels are ignored. Alternatively, a folder of confidence images from the camera: pixels below
/// the least confidence are ignored. Thread safety: const members may run from many threads. Cost
/// of mask_of(): reads a file, O(pixels).
class VIEWGAIN_EXPORT MaskFolder {
 public:
  /// If `least_confidence` is given, the images are confidence images. Throws Error(io) naming the
  /// folder if it does not exist.
  explicit MaskFolder(std::filesystem::path folder,
                      std::optional<std::uint8_t> least_confidence = {});

  /// Throws Error(invalid_argument) naming the folder if none of the images has a mask, because the
  /// masks then belong to another recording.
  void require_mask_of_any(const std::vector<std::filesystem::path>& images) const;

  /// Path of the mask of the depth image with this name. The mask need not exist. Constant time.
  [[nodiscard]] std::filesystem::path file_of(const std::filesystem::path& image) const;

  /// The mask of the depth image with this name, computed from the confidences if the folder holds
  /// confidences; empty if there is no file. Throws Error(io) or Error(format) naming the file if
  /// it cannot be used.
  [[nodiscard]] std::optional<Gray8Image> mask_of(const std::filesystem::path& image, int width,
                                                  int height) const;

 private:
  std::filesystem::path folder_;
  std::optional<std::uint8_t> least_confidence_;
};

/// Sets masked pixels to invalid (0). Returns how many of these were valid. Throws
/// Error(invalid_argument) if the sizes differ. Cost: O(pixels).
VIEWGAIN_EXPORT std::uint64_t apply_mask(const Gray8Image& mask, GrayImage& depth);
/// As above for a frame; returns how many masked pixels had a depth.
VIEWGAIN_EXPORT std::uint64_t apply_mask(const Gray8Image& mask, DepthFrame& frame);

}  // namespace viewgain

/// @file
/// Folders of depth frames. Opening a folder reads one pose per frame and no image. If the sensor
/// has a table of range errors, it also makes a RangeCorrector (640x480: 3 ms, with lens distortion
/// 0.1 s). Functions that take a frame read or write its images, O(pixels).

namespace viewgain {

/// Default unit of depth images in viewgain's layout [m].
inline constexpr double kDepthUnit = 1e-4;
inline constexpr double kRecordedDepthUnit = 1e-3;  ///< default unit of recorded depth images [m]
inline constexpr double kAmplitudeUnit = 1e-3;      ///< unit of amplitude images [m⁻²]

/// Why a frame cannot be used.
struct VIEWGAIN_EXPORT FrameFault {
  FrameVerdict verdict = FrameVerdict::used;  ///< used: no fault
  std::string what{};                         ///< message with the file
};

/// A folder of depth frames whose poses are read, but not its images.
struct VIEWGAIN_EXPORT FrameSequence {
  Sensor sensor;                              ///< including the folder's intrinsics, if any
  double depth_scale = 0;                     ///< metres per unit
  bool recorded = false;                      ///< one pose file per frame instead of poses.txt
  std::vector<std::filesystem::path> images;  ///< depth images, in order
  /// T_world_camera of each image, not finite if missing; empty after open_depth_images().
  std::vector<Pose> poses;
  std::vector<FrameFault> pose_faults;  ///< fault of each pose: lost_pose, no_pose or none
  /// Meaning of 65535 in the images: from frames.toml, else the sensor, else carve in viewgain's
  /// layout and invalid in the recorded layout. May be set before frames are loaded.
  Sensor::OutOfRange out_of_range = Sensor::OutOfRange::carve;
  bool is_scale_assumed = false;         ///< depth_scale is not stated; see assumed_text()
  bool is_out_of_range_assumed = false;  ///< out_of_range is not stated
  std::size_t orthonormalized = 0;       ///< number of repaired rotations
  /// Corrector of the sensor at the time of opening, so that load_frame() need not compute the
  /// rays; null if the sensor has no table of range errors. Ignored if the sensor was changed.
  std::shared_ptr<const RangeCorrector> corrector{};
};

/// Opens a folder of frame-NNNNNN.depth.png in either layout: viewgain's with poses.txt and
/// sensor.toml, or the recorded one with frame-NNNNNN.pose.txt and camera-intrinsics.txt.
/// frames.toml states the layout, depth scale and meaning of 65535; apps/docs/reference/formats.md
/// documents its keys, the defaults, and how poses are matched to images. A pose that is missing,
/// not finite or not rigid affects only its own frame. `sensor`: preset or .toml file; empty: the
/// folder's own. Throws Error naming the file for faults of the whole folder.
[[nodiscard]] VIEWGAIN_EXPORT FrameSequence open_frames(const std::filesystem::path& dir,
                                                        const std::string& sensor = {},
                                                        std::optional<double> depth_scale = {});

/// As above, but without poses, which may be missing. Images are in order of their numbers.
[[nodiscard]] VIEWGAIN_EXPORT FrameSequence
open_depth_images(const std::filesystem::path& dir, const std::string& sensor = {},
                  std::optional<double> depth_scale = {});

/// A warning about assumptions; empty if there are none. In viewgain's layout the unit of depth
/// images is an assumption unless frames.toml or simulated.txt states it.
[[nodiscard]] VIEWGAIN_EXPORT std::string assumed_text(const FrameSequence& frames);

/// Reads the depth image and, if present, the amplitude image (16 bit, 1e-3 m⁻²; full scale is
/// DepthFrame::kSaturated). Corrects depths with the sensor's current range_calibration. If the
/// calibration or the camera changed since opening, each call computes the rays
/// (RangeCalibration::correct()). Throws Error(io) or Error(format) naming the file, and
/// Error(invalid_argument) for an index out of range. May be called from many threads.
[[nodiscard]] VIEWGAIN_EXPORT DepthFrame load_frame(const FrameSequence& frames, std::size_t index);

/// A frame as read, or why it cannot be used.
struct VIEWGAIN_EXPORT FrameReading {
  DepthFrame frame{};               ///< as from load_frame(), without masked pixels
  FrameFault fault{};               ///< lost_pose, no_pose, wrong_size, unreadable, or none
  std::uint64_t masked_pixels = 0;  ///< masked pixels that had a depth
};

/// Like load_frame(), for folders with some bad frames: reports faults of the frame, its pose or
/// its mask instead of throwing. Throws Error(invalid_argument) for an index out of range. May be
/// called from many threads.
[[nodiscard]] VIEWGAIN_EXPORT FrameReading read_frame(const FrameSequence& frames,
                                                      std::size_t index,
                                                      std::span<const MaskFolder> masks = {});

/// Identity of a frame by name and content, "HASH NAME": 16 hexadecimal digits, a space and the
/// depth image's file name. The hash covers the bytes of its images and its pose, but not folder,
/// sensor or scale. Throws Error(io) if an image cannot be read, and Error(invalid_argument) for an
/// index out of range. May be called from many threads.
[[nodiscard]] VIEWGAIN_EXPORT std::string frame_identity(const FrameSequence& frames,
                                                         std::size_t index);

/// Files of `dir` that belong to frames of either layout, or that `simulate` and `import` write
/// with them. Paths are relative to `dir`. Empty if the folder does not exist.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<std::filesystem::path> frame_files(
    const std::filesystem::path& dir);

/// Unit [m] in which a 16-bit depth image covers the sensor's range: kDepthUnit, or the smallest
/// sufficient multiple of it from 2, 5, 10, 20, ...
[[nodiscard]] VIEWGAIN_EXPORT double depth_scale_for(const Sensor& sensor);

/// Writes frames in viewgain's layout into a folder that appears, or changes, only when everything
/// is written. Its simulated.txt states the number of simulated frames; other frames are never
/// replaced. Thread safety: one call at a time.
class VIEWGAIN_EXPORT FramesWriter {
 public:
  /// Throws Error(io), and Error(invalid_argument) if the folder holds frames, poses or a sensor
  /// that no FramesWriter wrote, or if the scale [m per unit] is not between 0 and 1.
  explicit FramesWriter(const std::filesystem::path& dir, double depth_scale = kDepthUnit);

  /// Writes the depth image, and an amplitude image if the frame has amplitudes. Depths that are
  /// NaN, negative or above 65534 units become invalid; amplitudes of at least 65.5345 m⁻² become
  /// full scale. Throws Error(io), and Error(invalid_argument) for an index that is not the number
  /// of frames so far, a wrong number of pixels, or a size that differs from the first frame's.
  void write_frame(std::size_t index, const DepthFrame& frame);

  /// Writes poses (T_world_camera, one per frame), sensor and frames.toml, and replaces the frames
  /// of an earlier simulation. Throws Error(io), and Error(invalid_argument) for a wrong number of
  /// poses, no poses, or a sensor of another size.
  void commit(const std::vector<Pose>& poses, const Sensor& sensor);

 private:
  std::vector<std::filesystem::path> earlier_;
  StagedFolder staged_;
  double depth_scale_;          // metres per unit
  std::size_t written_ = 0;     // number of frames
  int width_ = 0, height_ = 0;  // size of the frames [px]
};

}  // namespace viewgain
