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

/// A frame of the recording with a PNG image and a pose.
struct RecordedFrame {
  std::uint64_t number = 0;  ///< its index in the list
  std::filesystem::path image;
  ReadPose pose;
};

/// Throws Error(format) for a link to a file outside the recording, because recordings are
/// untrusted.
void refuse_link_out(const std::filesystem::path& source, const std::filesystem::path& file);

/// The image's path relative to the recording; empty if it is outside.
[[nodiscard]] std::filesystem::path path_inside(const std::string& name);

/// Reads the images one at a time, applies masks and writes them to `out`. The size is that of
/// report.camera, else of the first image. `depth_scale` [m per unit].
void import_images(const std::filesystem::path& source, const std::vector<RecordedFrame>& frames,
                   double depth_scale, const ImportConfig& config, const std::filesystem::path& out,
                   Dropped& dropped, ImportReport& report);

/// Throws Error(invalid_argument) if the written folder could not store the camera's lens
/// distortion.
void require_sensor_for_distortion(const PinholeCamera& camera, const ImportConfig& config);

/// Throws Error, without a file, for a camera that PinholeCamera::validate() refuses, and for a
/// principal point more than 10 image sizes away. A size of 0 is unknown so far.
void check_recorded_camera(const PinholeCamera& camera);

// import_recording() for each layout.

[[nodiscard]] ImportReport import_tum(const std::filesystem::path& source,
                                      const std::filesystem::path& out, const ImportConfig& config);
/// `file` is a transforms.json.
[[nodiscard]] ImportReport import_transforms(const std::filesystem::path& file,
                                             const std::filesystem::path& out,
                                             const ImportConfig& config);
/// `files` are those of one recording, in order.
[[nodiscard]] ImportReport import_messages(const std::filesystem::path& source,
                                           const std::vector<std::filesystem::path>& files,
                                           RecordingFormat format, const std::filesystem::path& out,
                                           const ImportConfig& config);

}  // namespace viewgain
