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

/// How the frames of a folder are to be read.
struct FrameFolderOptions {
  std::string folder;                     ///< FRAMES_DIR
  std::string sensor;                     ///< --sensor; empty: the folder's own
  std::optional<double> depth_scale{};    ///< --depth-scale [m per unit]; nothing: the folder's
  std::string mask;                       ///< --mask; empty: none
  std::string confidence;                 ///< --confidence DIR[,LEAST]; empty: none
  std::string out_of_range;               ///< --out-of-range; empty: the folder's
  std::string on_contradiction = "skip";  ///< --on-contradiction skip|keep|error
};

/// What the flag says; nothing: the folder does.
[[nodiscard]] std::optional<Sensor::OutOfRange> out_of_range_of(const FrameFolderOptions& options);

/// --depth-scale, --out-of-range, --mask, --confidence and --on-contradiction, the same in every
/// subcommand that puts frames into a map.
void add_frame_folder_options(App& app, FrameFolderOptions& options);

/// Throws Error(invalid_argument) for --on-contradiction keep without --register on.
void check_contradiction(const FrameFolderOptions& options, bool registers);

/// --mask and --confidence.
void add_mask_options(App& app, std::string& mask, std::string& confidence);

/// What --confidence DIR[,LEAST] says.
struct Confidence {
  std::string folder;
  std::uint8_t least = 1;  ///< value that counts
};
/// Throws Error(invalid_argument) for a LEAST that is not in 1..255.
[[nodiscard]] Confidence parse_confidence(const std::string& text);

/// open_frames() or open_depth_images(); their errors name --sensor where that would help.
using OpenFrames = FrameSequence (*)(const std::filesystem::path&, const std::string&,
                                     std::optional<double>);
[[nodiscard]] FrameSequence opened(OpenFrames open, const std::string& folder,
                                   const std::string& sensor, std::optional<double> depth_scale);

/// Warns of assumed_text(), where there is one.
void warn_of_assumptions(const std::string& folder, const FrameSequence& frames);

/// Recorded or simulated frames with their poses, and what masks leave of them.
class FrameFolder {
 public:
  /// Throws Error as opened() and MaskFolder.
  explicit FrameFolder(const FrameFolderOptions& options);

  /// FRAMES_DIR, for errors.
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] const FrameSequence& frames() const noexcept { return frames_; }
  [[nodiscard]] const Sensor& sensor() const noexcept { return frames_.sensor; }
  [[nodiscard]] std::size_t size() const noexcept { return frames_.images.size(); }
  [[nodiscard]] bool has_masks() const noexcept { return !masks_.empty(); }
  [[nodiscard]] const Pose& T_world_camera(std::size_t index) const { return frames_.poses[index]; }

  /// Frames that contradict one another are an error, not a warning.
  [[nodiscard]] bool refuses_contradictions() const noexcept { return refuses_contradictions_; }

  /// Of --mask and --confidence.
  [[nodiscard]] const std::vector<MaskFolder>& masks() const noexcept { return masks_; }

  /// Throws nothing that a frame is to blame for.
  [[nodiscard]] FrameReading load(std::size_t index) const {
    return read_frame(frames_, index, masks_);
  }

 private:
  std::string name_;
  FrameSequence frames_;
  std::vector<MaskFolder> masks_;
  bool refuses_contradictions_ = false;
};

/// The workspace for what frames or clouds see: the box around `bounds(i)`, i < count, with half a
/// voxel more on each side, since a reading on its face would lie outside of it; nothing if none
/// has readings. `voxel` [m].
[[nodiscard]] std::optional<Box> workspace_around(
    std::size_t count, double voxel, const std::function<std::optional<Box>(std::size_t)>& bounds);

}  // namespace viewgain::app
