// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "recordings/ros_messages.hpp"
#include "viewgain/formats/png.hpp"

namespace viewgain {

/// Depths along z [m] row by row: not positive or NaN: no reading; infinity: nothing in range.
struct DepthImage {
  int width = 0, height = 0;
  std::vector<float> z;
};

inline constexpr double kMillimetre = 1e-3;  ///< what 16 bits count, unless told otherwise [m]

/// Whether images of this encoding are depths: 2, by their name; 1: mono16, which may be; 0: not.
[[nodiscard]] int depth_likelihood(const std::string& encoding);

/// 16UC1 and mono16 in units of `unit` [m] (65535: no reading), 32FC1 in m as REP 117 has it, in
/// either byte order; or a PNG of compressedDepth. Throws Error(format), without a file, for
/// another encoding, a size that the bytes do not have, and a damaged PNG.
[[nodiscard]] DepthImage decode_depth(const DepthMessage& message, double unit = kMillimetre);

/// Whether the pixels make a much smoother image with their bytes in the other order; nothing for
/// an image of too few readings.
[[nodiscard]] std::optional<bool> is_wrong_byte_order(const DepthMessage& message);

/// In units of `unit` [m], 65535 for infinity; too large for them: no reading.
[[nodiscard]] GrayImage gray_image(const DepthImage& depth, double unit);

}  // namespace viewgain
