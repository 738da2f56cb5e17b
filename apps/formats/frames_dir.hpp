// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain::app {

inline constexpr double kDepthUnit = 1e-4;          ///< of our own depth images [m]
inline constexpr double kRecordedDepthUnit = 1e-3;  ///< of recorded ones, unless said otherwise [m]
inline constexpr double kAmplitudeUnit = 1e-3;      ///< of amplitude images [m⁻²]

/// What the value 65535 of a depth image says.
enum class OutOfRangeMeaning {
  carve,    ///< nothing up to max_range
  invalid,  ///< no reading
};

/// A folder of depth frames, opened but not read.
struct FrameSequence {
  Sensor sensor;           ///< with the folder's own intrinsics, where it has them
  double depth_scale = 0;  ///< [m] a unit
  bool recorded = false;   ///< a pose file a frame, instead of poses.txt
  std::vector<std::filesystem::path> images;
  std::vector<Pose> poses;  ///< T_world_camera, one an image
  std::size_t orthonormalized = 0;
};

/// Opens either layout: poses.txt + frame-NNNNNN.depth.png (line i is frame i) + sensor.toml, or
/// frame-NNNNNN.depth.png + frame-NNNNNN.pose.txt + camera-intrinsics.txt, whose numbers may have
/// gaps. Beside a depth image there may be a frame-NNNNNN.amplitude.png. `sensor`: preset or .toml
/// file, empty for the folder's own. Throws Error naming the file that is missing or wrong.
[[nodiscard]] FrameSequence open_frames(const std::filesystem::path& dir, const std::string& sensor,
                                        std::optional<double> depth_scale);

/// Reads the depth image, and the amplitude image (16 bit, 1e-3 m⁻²) if there is one.
[[nodiscard]] DepthFrame load_frame(const FrameSequence& frames, std::size_t index,
                                    OutOfRangeMeaning meaning);

/// Writes frames in our own layout into a folder that appears, or changes, only when all is
/// written.
class FramesWriter {
 public:
  /// Creates a hidden folder beside or in `dir`. Throws Error(io).
  explicit FramesWriter(const std::filesystem::path& dir);
  /// Removes what commit() has not moved.
  ~FramesWriter();
  FramesWriter(const FramesWriter&) = delete;
  FramesWriter& operator=(const FramesWriter&) = delete;

  /// Writes the depth image, and an amplitude image if the frame has amplitudes.
  void write_frame(std::size_t index, const DepthFrame& frame);

  /// Writes poses and sensor and moves all into place; frames of an earlier run in `dir` go.
  void commit(const std::vector<Pose>& poses, const Sensor& sensor);

 private:
  std::filesystem::path dir_;
  std::filesystem::path staging_;
  std::filesystem::path created_parent_;  // topmost folder that was made for this; empty: none
  bool committed_ = false;
};

}  // namespace viewgain::app
