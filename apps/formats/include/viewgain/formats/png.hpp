// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "viewgain/core/export.hpp"

/// @file
/// PNG images. Cost: O(pixels) to read or write, constant time for png_size().

namespace viewgain {

/// 16-bit grayscale image.
struct VIEWGAIN_EXPORT GrayImage {
  int width = 0;                      ///< [px]
  int height = 0;                     ///< [px]
  std::vector<std::uint16_t> pixels;  ///< row-major
};

/// 8-bit RGB image, row-major.
struct VIEWGAIN_EXPORT RgbImage {
  int width = 0;                     ///< [px]
  int height = 0;                    ///< [px]
  std::vector<std::uint8_t> pixels;  ///< 3 * width * height
};

/// 8-bit grayscale image.
struct VIEWGAIN_EXPORT Gray8Image {
  int width = 0;                     ///< [px]
  int height = 0;                    ///< [px]
  std::vector<std::uint8_t> pixels;  ///< row-major
};

/// Reads a 16-bit grayscale PNG of exactly this size. Values are raw, without gamma. Throws
/// Error(io) if the file cannot be read and Error(format) with the file if it is damaged or has
/// another kind or size.
[[nodiscard]] VIEWGAIN_EXPORT GrayImage read_gray_png(const std::filesystem::path& path, int width,
                                                      int height);

/// Reads a grayscale PNG of 1 to 8 bits of exactly this size. Values are raw, extended to 8 bits.
/// Throws whatever read_gray_png() throws.
[[nodiscard]] VIEWGAIN_EXPORT Gray8Image read_gray8_png(const std::filesystem::path& path,
                                                        int width, int height);

/// Width and height of a PNG [px] from the file's first bytes. Throws Error(io) if it cannot be
/// read and Error(format) with the file if it does not begin as a PNG.
[[nodiscard]] VIEWGAIN_EXPORT std::array<int, 2> png_size(const std::filesystem::path& path);

/// Writes a 16-bit image. Atomic. Throws Error(io), and Error(invalid_argument) for a wrong number
/// of values.
VIEWGAIN_EXPORT void write_png(const std::filesystem::path& path, const GrayImage& image);
/// As above, 8 bits per channel.
VIEWGAIN_EXPORT void write_png(const std::filesystem::path& path, const RgbImage& image);
/// As above, 8 bits.
VIEWGAIN_EXPORT void write_png(const std::filesystem::path& path, const Gray8Image& image);

}  // namespace viewgain
