// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "frames/frame_names.hpp"
#include "recordings/recorded_folder.hpp"
#include "viewgain/formats/recordings.hpp"

namespace viewgain {

/// A frame whose image is a PNG of the recording and that has a pose.
struct RecordedFrame {
  std::uint64_t number = 0;  ///< its place in the list, from 0
  std::filesystem::path image;
  ReadPose pose;
};

/// Throws Error(format) for a link that leads out of the recording, which may be of anybody. What
/// is not read may be one.
void refuse_link_out(const std::filesystem::path& source, const std::filesystem::path& file);

/// The image's path below the recording; empty for one that is outside of it.
[[nodiscard]] std::filesystem::path path_inside(const std::string& name);

/// Reads the images one at a time, takes masks away and writes all into `out`. The size is that of
/// report.camera, else of the first image. `depth_scale` [m per unit].
void import_images(const std::filesystem::path& source, const std::vector<RecordedFrame>& frames,
                   double depth_scale, const ImportConfig& config, const std::filesystem::path& out,
                   Dropped& dropped, ImportReport& report);

/// Throws Error(invalid_argument) if the folder could not hold the camera's lens distortion.
void require_sensor_for_distortion(const PinholeCamera& camera, const ImportConfig& config);

/// Throws Error, without a file, for a camera that PinholeCamera::validate() refuses and for a
/// principal point over 10 sizes off the image. A size of 0 is not known yet.
void check_recorded_camera(const PinholeCamera& camera);

// import_recording() of each layout.

[[nodiscard]] ImportReport import_tum(const std::filesystem::path& source,
                                      const std::filesystem::path& out, const ImportConfig& config);
/// `file`: transforms.json.
[[nodiscard]] ImportReport import_transforms(const std::filesystem::path& file,
                                             const std::filesystem::path& out,
                                             const ImportConfig& config);
/// `files`: of one recording, in its order.
[[nodiscard]] ImportReport import_messages(const std::filesystem::path& source,
                                           const std::vector<std::filesystem::path>& files,
                                           RecordingFormat format, const std::filesystem::path& out,
                                           const ImportConfig& config);

}  // namespace viewgain
