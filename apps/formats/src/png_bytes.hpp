// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "viewgain/formats/png.hpp"

namespace viewgain {

/// As read_gray_png(), of bytes in memory and of whatever size up to 2^24 pixels. Throws
/// Error(format) without a file's name.
[[nodiscard]] GrayImage gray_image_of_png(std::string_view bytes);

}  // namespace viewgain
