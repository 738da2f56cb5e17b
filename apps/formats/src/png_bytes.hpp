// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "viewgain/formats/png.hpp"

namespace viewgain {

/// Like read_gray_png(), from bytes in memory, of any size up to 2^24 pixels. Throws Error(format)
/// without a file's name.
[[nodiscard]] GrayImage gray_image_of_png(std::string_view bytes);

}  // namespace viewgain
