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

/// A folder of masks, which say where depth images show what is no part of the scene, as the arm
/// that carries the camera. The mask of a depth image has the image's name and size; it is a
/// grayscale PNG of 1 to 8 bits. 0: the pixel counts; any other value: it says nothing. Or a folder
/// of confidences, images likewise, as many cameras give them: pixels under the least say nothing.
/// Thread safety: const members may run from many threads. Cost of mask_of(): a file is read,
/// O(pixels); of the others a look at the file system for each image.
class VIEWGAIN_EXPORT MaskFolder {
 public:
  /// With `least_confidence` the images are confidences. Throws Error(io), naming it, if there is
  /// no such folder.
  explicit MaskFolder(std::filesystem::path folder,
                      std::optional<std::uint8_t> least_confidence = {});

  /// Throws Error(invalid_argument), naming the folder, if none of the images, in any order, has a
  /// mask in it: it is another recording's.
  void require_mask_of_any(const std::vector<std::filesystem::path>& images) const;

  /// Where the mask of the depth image of this name is, or would be. Takes constant time; not
  /// checked is whether there is one.
  [[nodiscard]] std::filesystem::path file_of(const std::filesystem::path& image) const;

  /// The mask of the depth image of this name, made of the confidences where these are in the
  /// folder; nothing where the folder has none. Throws Error(io)
  /// or Error(format), naming the file, for one that cannot be used.
  [[nodiscard]] std::optional<Gray8Image> mask_of(const std::filesystem::path& image, int width,
                                                  int height) const;

 private:
  std::filesystem::path folder_;
  std::optional<std::uint8_t> least_confidence_;
};

/// Makes the pixels invalid (0) that the mask says; returns how many were not invalid before.
/// Throws Error(invalid_argument) if the sizes differ. Costs O(pixels).
VIEWGAIN_EXPORT std::uint64_t apply_mask(const Gray8Image& mask, GrayImage& depth);
/// The same of a frame: how many of the masked pixels had a depth.
VIEWGAIN_EXPORT std::uint64_t apply_mask(const Gray8Image& mask, DepthFrame& frame);

}  // namespace viewgain

/// @file
/// Folders of depth frames. Cost: functions that open a folder read a pose a frame and no image,
/// and make a RangeCorrector where the sensor has a table (640x480: 3 ms, with lens distortion 0.1
/// s); those of a frame read or write its images, O(pixels).

namespace viewgain {

inline constexpr double kDepthUnit = 1e-4;          ///< of our own depth images, by default [m]
inline constexpr double kRecordedDepthUnit = 1e-3;  ///< of recorded ones, unless said otherwise [m]
inline constexpr double kAmplitudeUnit = 1e-3;      ///< of amplitude images [m⁻²]

/// Why a frame cannot be used.
struct VIEWGAIN_EXPORT FrameFault {
  FrameVerdict verdict = FrameVerdict::used;  ///< used: nothing is against it
  std::string what{};                         ///< names the file
};

/// A folder of depth frames, opened but not read.
struct VIEWGAIN_EXPORT FrameSequence {
  Sensor sensor;           ///< with the folder's own intrinsics, where it has them
  double depth_scale = 0;  ///< [m] per unit
  bool recorded = false;   ///< a pose file a frame, instead of poses.txt
  std::vector<std::filesystem::path> images;  ///< depth images, in their order
  /// T_world_camera, one an image, not finite where there is none; none of open_depth_images().
  std::vector<Pose> poses;
  std::vector<FrameFault> pose_faults;  ///< one a pose: lost_pose, no_pose, or nothing against it
  /// What 65535 means in the images: as frames.toml says, else the sensor, else carve in our own
  /// layout and invalid in the recorded one. May be set before frames are loaded.
  Sensor::OutOfRange out_of_range = Sensor::OutOfRange::carve;
  bool is_scale_assumed = false;         ///< nothing says depth_scale; see assumed_text()
  bool is_out_of_range_assumed = false;  ///< nothing says out_of_range
  std::size_t orthonormalized = 0;       ///< rotations that were a little off
  /// Of the sensor as the folder was opened with it, null if that has no table: spares load_frame()
  /// the rays of the sensor's camera. Where the sensor has been changed it does not count.
  std::shared_ptr<const RangeCorrector> corrector{};
};

/// Opens either layout: poses.txt + frame-NNNNNN.depth.png + sensor.toml, or frame-NNNNNN.depth.png
/// + frame-NNNNNN.pose.txt + camera-intrinsics.txt. frames.toml says which, with depth scale and
/// meaning of 65535; apps/docs/reference/formats.md has its keys, what holds without it, and how
/// the lines of poses.txt are matched to the images. A pose that is lost (not finite, not rigid) or
/// missing is that frame's fault alone. `sensor`: preset or .toml file, empty for the folder's own.
/// Throws Error, naming the file, for what is missing or wrong of all frames.
[[nodiscard]] VIEWGAIN_EXPORT FrameSequence open_frames(const std::filesystem::path& dir,
                                                        const std::string& sensor = {},
                                                        std::optional<double> depth_scale = {});

/// The same of the depth images alone, in the order of their numbers; poses are not read and need
/// not be there.
[[nodiscard]] VIEWGAIN_EXPORT FrameSequence
open_depth_images(const std::filesystem::path& dir, const std::string& sensor = {},
                  std::optional<double> depth_scale = {});

/// A warning about what had to be assumed; empty: nothing. The unit of depth images in our own
/// layout is assumed unless frames.toml or simulated.txt states it.
[[nodiscard]] VIEWGAIN_EXPORT std::string assumed_text(const FrameSequence& frames);

/// Reads the depth image, and the amplitude image (16 bit, 1e-3 m⁻²; full scale is
/// DepthFrame::kSaturated) if there is one. Depths are
/// corrected by the range_calibration of the sensor as it is at the call; where that, or its
/// camera, is not what the folder was opened with, each call finds the rays anew
/// (RangeCalibration::correct()). Throws Error(io) or Error(format), naming the file, and
/// Error(invalid_argument) for an index that is not less than the count of images. May be called
/// from many threads.
[[nodiscard]] VIEWGAIN_EXPORT DepthFrame load_frame(const FrameSequence& frames, std::size_t index);

/// A frame as it was read, or why it cannot be used.
struct VIEWGAIN_EXPORT FrameReading {
  DepthFrame frame{};               ///< as load_frame() has it, without what masks take
  FrameFault fault{};               ///< lost_pose, no_pose, wrong_size, unreadable, or none
  std::uint64_t masked_pixels = 0;  ///< with a depth, that masks took
};

/// load_frame() and its pose's fault, for folders in which some frames are bad: what is wrong with
/// the frame, or with its mask where a folder has one, is said and not thrown. Throws
/// Error(invalid_argument) for an index that is not less than the count of images. May be called
/// from many threads.
[[nodiscard]] VIEWGAIN_EXPORT FrameReading read_frame(const FrameSequence& frames,
                                                      std::size_t index,
                                                      std::span<const MaskFolder> masks = {});

/// A frame by name and content, "HASH NAME": 16 hexadecimal digits, a blank and the depth image's
/// file name. The hash is of the bytes of its images and of its pose; folder, sensor and scale do
/// not count. Throws Error(io) if an image cannot be read, and Error(invalid_argument) for an index
/// that is not less than the count of poses. May be called from many threads.
[[nodiscard]] VIEWGAIN_EXPORT std::string frame_identity(const FrameSequence& frames,
                                                         std::size_t index);

/// The files of `dir` that make up frames of either layout, and what `simulate` and `import` leave
/// with them, relative to it, in any order; none if there is no such folder.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<std::filesystem::path> frame_files(
    const std::filesystem::path& dir);

/// The unit [m] in which a depth image of 16 bits holds all that the sensor measures: kDepthUnit,
/// or the least of 2, 5, 10, 20, ... times that.
[[nodiscard]] VIEWGAIN_EXPORT double depth_scale_for(const Sensor& sensor);

/// Writes frames in our own layout into a folder that appears, or changes, only when all is
/// written. simulated.txt in it says how many frames are simulated; only those are ever replaced.
/// Thread safety: one call at a time.
class VIEWGAIN_EXPORT FramesWriter {
 public:
  /// Throws Error(io), and Error(invalid_argument) if the folder holds frames, poses or a sensor
  /// that no FramesWriter has written, or if the scale [m per unit] is not within 0 and 1.
  explicit FramesWriter(const std::filesystem::path& dir, double depth_scale = kDepthUnit);

  /// Writes the depth image, and an amplitude image if the frame has amplitudes. What is no depth
  /// (NaN, negative), or a finite one over 65534 units, is written as invalid; amplitudes from
  /// 65.5345 m⁻² on as full scale. Throws Error(io), and Error(invalid_argument) for an index that
  /// is not the count of frames so far, pixels that are too few or too many, or a size that is not
  /// that of the first.
  void write_frame(std::size_t index, const DepthFrame& frame);

  /// Writes poses (T_world_camera, one a frame), sensor and frames.toml and puts all in the place
  /// of the frames of an earlier simulation. Throws Error(io), and Error(invalid_argument) for
  /// another count of poses than of frames, none, or a sensor of another size.
  void commit(const std::vector<Pose>& poses, const Sensor& sensor);

 private:
  std::vector<std::filesystem::path> earlier_;
  StagedFolder staged_;
  double depth_scale_;          // [m] per unit
  std::size_t written_ = 0;     // frames
  int width_ = 0, height_ = 0;  // of them [px]
};

}  // namespace viewgain
