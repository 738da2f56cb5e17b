// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "show/pictures/image_grid.hpp"

#include <algorithm>
#include <cstdint>

namespace viewgain::app {

RgbImage shrunk(const RgbImage& image, int factor) {
  RgbImage small{image.width / factor, image.height / factor, {}};
  const auto f = static_cast<std::size_t>(factor), row = 3 * static_cast<std::size_t>(image.width);
  const auto width = static_cast<std::size_t>(small.width);
  small.pixels.reserve(3 * width * static_cast<std::size_t>(small.height));
  for (std::size_t v = 0; v < static_cast<std::size_t>(small.height); ++v) {
    for (std::size_t u = 0; u < width; ++u) {
      for (std::size_t k = 0; k < 3; ++k) {
        std::size_t sum = 0;
        for (std::size_t j = 0; j < f; ++j) {
          for (std::size_t i = 0; i < f; ++i) {
            sum += image.pixels[(v * f + j) * row + 3 * (u * f + i) + k];
          }
        }
        small.pixels.push_back(static_cast<std::uint8_t>((sum + f * f / 2) / (f * f)));
      }
    }
  }
  return small;
}

RgbImage image_grid(const std::vector<RgbImage>& images, std::size_t columns) {
  columns = std::min(columns, images.size());
  const std::size_t rows = (images.size() + columns - 1) / columns;
  const auto width = static_cast<std::size_t>(images.front().width);
  const auto height = static_cast<std::size_t>(images.front().height);
  const std::size_t gap = std::max<std::size_t>(2, width / 100);
  const std::size_t all_columns = columns * width + (columns - 1) * gap;
  const std::size_t all_rows = rows * height + (rows - 1) * gap;
  RgbImage grid{static_cast<int>(all_columns), static_cast<int>(all_rows), {}};
  grid.pixels.assign(3 * all_columns * all_rows, 255);
  for (std::size_t n = 0; n < images.size(); ++n) {
    const std::size_t left = n % columns * (width + gap), top = n / columns * (height + gap);
    for (std::size_t v = 0; v < height; ++v) {
      const auto from = images[n].pixels.begin() + static_cast<std::ptrdiff_t>(3 * v * width);
      std::copy_n(
          from, 3 * width,
          grid.pixels.begin() + static_cast<std::ptrdiff_t>(3 * ((top + v) * all_columns + left)));
    }
  }
  return grid;
}

}  // namespace viewgain::app
