// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "viewgain/formats/png.hpp"

namespace viewgain::app {

/// The image with each factor x factor pixels made one, their mean; what is left over at the right
/// and below goes. Needs at least one such block.
[[nodiscard]] RgbImage shrunk(const RgbImage& image, int factor);

/// Images of one size side by side, `columns` in a row, row by row, with white between them and in
/// the places that are left. There must be one.
[[nodiscard]] RgbImage image_grid(const std::vector<RgbImage>& images, std::size_t columns);

}  // namespace viewgain::app
