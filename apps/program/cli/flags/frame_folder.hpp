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

namespace viewgain::app {

/// How to read the frames of a folder.
struct FrameFolderOptions {
  std::string folder;                     ///< FRAMES_DIR
  std::string sensor;                     ///< --sensor; empty: the folder's own
  std::optional<double> depth_scale{};    ///< --depth-scale [m per unit]; empty: the folder's
  std::string mask;                       ///< --mask; empty: none
  std::string confidence;                 ///< --confidence DIR[,LEAST]; empty: none
  std::string out_of_range;               ///< --out-of-range; empty: the folder's
  std::string on_contradiction = "skip";  ///< --on-contradiction skip|keep|error
};

/// The meaning of 65535 given by the flag; empty: the folder's.
[[nodiscard]] std::optional<Sensor::OutOfRange> out_of_range_of(const FrameFolderOptions& options);

/// Adds --depth-scale, --out-of-range, --mask, --confidence and --on-contradiction, which are the
/// same in every subcommand that puts frames into a map.
void add_frame_folder_options(App& app, FrameFolderOptions& options);

/// Throws Error(invalid_argument) for --on-contradiction keep without --register on.
void check_contradiction(const FrameFolderOptions& options, bool registers);

/// Adds --mask and --confidence.
void add_mask_options(App& app, std::string& mask, std::string& confidence);

/// The value of --confidence DIR[,LEAST].
struct Confidence {
  std::string folder;
  std::uint8_t least = 1;  ///< smallest value that counts
};
/// Throws Error(invalid_argument) for a LEAST that is not in 1..255.
[[nodiscard]] Confidence parse_confidence(const std::string& text);

/// open_frames() or open_depth_images(). Errors name --sensor if that would help.
using OpenFrames = FrameSequence (*)(const std::filesystem::path&, const std::string&,
                                     std::optional<double>);
[[nodiscard]] FrameSequence opened(OpenFrames open, const std::string& folder,
                                   const std::string& sensor, std::optional<double> depth_scale);

/// Warns with assumed_text(), if there is one.
void warn_of_assumptions(const std::string& folder, const FrameSequence& frames);

/// Recorded or simulated frames with their poses, without masked pixels.
class FrameFolder {
 public:
  /// Throws Error like opened() and MaskFolder.
  explicit FrameFolder(const FrameFolderOptions& options);

  /// FRAMES_DIR, for messages.
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] const FrameSequence& frames() const noexcept { return frames_; }
  [[nodiscard]] const Sensor& sensor() const noexcept { return frames_.sensor; }
  [[nodiscard]] std::size_t size() const noexcept { return frames_.images.size(); }
  [[nodiscard]] bool has_masks() const noexcept { return !masks_.empty(); }
  [[nodiscard]] const Pose& T_world_camera(std::size_t index) const { return frames_.poses[index]; }

  /// Whether frames that contradict each other are an error instead of a warning.
  [[nodiscard]] bool refuses_contradictions() const noexcept { return refuses_contradictions_; }

  /// The folders of --mask and --confidence.
  [[nodiscard]] const std::vector<MaskFolder>& masks() const noexcept { return masks_; }

  /// Reads a frame. Faults of the frame are returned, not thrown.
  [[nodiscard]] FrameReading load(std::size_t index) const {
    return read_frame(frames_, index, masks_);
  }

 private:
  std::string name_;
  FrameSequence frames_;
  std::vector<MaskFolder> masks_;
  bool refuses_contradictions_ = false;
};

/// The workspace for what frames or clouds see: the box around `bounds(i)`, i < count. Half a voxel
/// is added on each side, because a reading on the box's face would lie outside. Empty if none has
/// readings. `voxel` [m].
[[nodiscard]] std::optional<Box> workspace_around(
    std::size_t count, double voxel, const std::function<std::optional<Box>(std::size_t)>& bounds);

}  // namespace viewgain::app
