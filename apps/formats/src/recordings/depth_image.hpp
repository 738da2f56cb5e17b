// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "recordings/ros_messages.hpp"
#include "viewgain/formats/png.hpp"

namespace viewgain {

/// Depths along z [m], row by row. Not positive or NaN: no reading; infinity: nothing in range.
struct DepthImage {
  int width = 0, height = 0;
  std::vector<float> z;
};

inline constexpr double kMillimetre = 1e-3;  ///< default unit of 16-bit values [m]

/// Whether images of this encoding are depths. 2: yes, by the name; 1: possibly (mono16); 0: no.
[[nodiscard]] int depth_likelihood(const std::string& encoding);

/// Decodes 16UC1 and mono16 in units of `unit` [m] (65535: no reading), 32FC1 in m as in REP 117,
/// in either byte order, or a PNG of compressedDepth. Throws Error(format), without a file, for
/// another encoding, a wrong number of bytes, and a damaged PNG.
[[nodiscard]] DepthImage decode_depth(const DepthMessage& message, double unit = kMillimetre);

/// Whether the image is much smoother in the other byte order; empty for an image with too few
/// readings.
[[nodiscard]] std::optional<bool> is_wrong_byte_order(const DepthMessage& message);

/// Image in units of `unit` [m], 65535 for infinity. Depths that are too large become "no reading".
[[nodiscard]] GrayImage gray_image(const DepthImage& depth, double unit);

}  // namespace viewgain
