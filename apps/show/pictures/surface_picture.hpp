// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "show/pictures/picture_parts.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/mesh/surface.hpp"

namespace viewgain::app {

/// What of a surface is drawn.
struct SurfacePicture {
  const SurfaceMesh& surface;
  /// One a vertex [m]: the surface from dark to bright by them; none: grey.
  std::vector<double> sigmas{};
  std::array<double, 2> sigma_range{};  ///< what is darkest and brightest [m]
};

/// The picture, which the surface fills. Throws Error(invalid_argument) for one without a triangle.
/// The same for any number of threads.
[[nodiscard]] RgbImage draw(const SurfacePicture& picture, const Viewer& viewer,
                            const ExecConfig& exec);

/// The 2nd and the 98th percentile, for colours. Zeros without a value.
[[nodiscard]] std::array<double, 2> usual_range(std::vector<double> values);

}  // namespace viewgain::app
