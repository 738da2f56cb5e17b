// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "program/cli/app.hpp"
#include "viewgain/core/box.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/masks.hpp"

namespace viewgain::app {

/// How the frames of a folder are to be read.
struct FrameFolderOptions {
  std::string folder;                   ///< FRAMES_DIR
  std::string sensor;                   ///< --sensor; empty: the folder's own
  std::optional<double> depth_scale{};  ///< --depth-scale [m per unit]; nothing: the folder's
  std::string mask;                     ///< --mask; empty: none
  std::string confidence;               ///< --confidence; empty: none
  int least_confidence = 1;             ///< --least-confidence
  std::string out_of_range;             ///< --out-of-range; empty: the folder's
};

/// What the flag says; nothing: the folder does.
[[nodiscard]] std::optional<Sensor::OutOfRange> out_of_range_of(const FrameFolderOptions& options);

/// --depth-scale, --out-of-range, --mask and --confidence, the same in every subcommand that reads
/// frames.
void add_frame_folder_options(App& app, FrameFolderOptions& options);

/// Recorded or simulated frames with their poses, and what masks leave of them.
class FrameFolder {
 public:
  /// Throws Error as open_frames() and MaskFolder, naming --sensor where that would help.
  explicit FrameFolder(const FrameFolderOptions& options);

  /// FRAMES_DIR, for errors.
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] const FrameSequence& frames() const noexcept { return frames_; }
  [[nodiscard]] const Sensor& sensor() const noexcept { return frames_.sensor; }
  [[nodiscard]] std::size_t size() const noexcept { return frames_.images.size(); }
  [[nodiscard]] const Pose& T_world_camera(std::size_t index) const { return frames_.poses[index]; }

  /// Throws nothing that a frame is to blame for.
  [[nodiscard]] FrameReading load(std::size_t index) const {
    return read_frame(frames_, index, masks_);
  }

 private:
  std::string name_;
  FrameSequence frames_;
  std::vector<MaskFolder> masks_;
};

inline constexpr const char* kMaskHelp =
    "folder of grayscale PNGs with the depth images' names: where they are not 0, an image says "
    "nothing";
inline constexpr const char* kConfidenceHelp =
    "folder of grayscale PNGs with the depth images' names: where they are under "
    "--least-confidence, an image says nothing";
inline constexpr const char* kLeastConfidenceHelp =
    "least value of --confidence that counts, 1..255";

/// The masks and confidences of --mask and --confidence for these images. Throws Error as
/// MaskFolder, also where none of the images has one.
[[nodiscard]] std::vector<MaskFolder> mask_folders(
    const FrameFolderOptions& options, const std::vector<std::filesystem::path>& images);

/// The workspace for what frames or clouds see: the box around `bounds(i)`, i < count, with half a
/// voxel more on each side, since a reading on its face would lie outside of it; nothing if none
/// has readings. `voxel` [m].
[[nodiscard]] std::optional<Box> workspace_around(
    std::size_t count, double voxel, const std::function<std::optional<Box>(std::size_t)>& bounds);

}  // namespace viewgain::app
