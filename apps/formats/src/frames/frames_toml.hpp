// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "viewgain/core/sensor.hpp"

namespace viewgain {

/// Contents of a folder's frames.toml about its images and poses. Every key may be missing.
struct FramesToml {
  std::optional<double> depth_scale{};               ///< [m] per unit of the depth images
  std::optional<Sensor::OutOfRange> out_of_range{};  ///< meaning of 65535
  std::optional<bool> recorded{};                    ///< a pose file per frame, not poses.txt
  std::optional<std::uint64_t> first_frame{};        ///< number of the first pose's image
  double pose_time_offset = 0;                       ///< added to the times in poses.txt [s]
};

/// All keys are missing if there is no such file. Throws Error(io), and Error(format) naming the
/// file, the line and the key.
[[nodiscard]] FramesToml read_frames_toml(const std::filesystem::path& dir);

/// The text of a file with these keys.
[[nodiscard]] std::string frames_toml(const FramesToml& said);

}  // namespace viewgain
