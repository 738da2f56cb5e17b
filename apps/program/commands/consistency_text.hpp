// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <string>

#include "program/cli/values.hpp"
#include "viewgain/mesh/quality.hpp"

namespace viewgain::app {

/// Two lines: how accurate the points are compared with their standard deviations, and how many
/// are outliers.
[[nodiscard]] inline std::string consistency_text(const Consistency& found) {
  if (found.points == 0) return "No point lies within 10 mm of the mesh.\n";
  const double factor = std::sqrt(found.mean_clipped);
  std::string text = "Points are ";
  if (factor < 0.95) {
    text += formatted("about %.1f times as accurate as", 1 / factor);
  } else if (factor > 1.05) {
    text += formatted("about %.1f times less accurate than", factor);
  } else {
    text += "as accurate as";
  }
  return text +
         formatted(
             " their standard deviations claim (mean squared normalised error %.2f, ideal 1).\n"
             "The median of these squares is %.2f (ideal 0.455). %.1f %% of the points are more "
             "than 3 standard deviations off (ideal 0.3 %%). %zu of %zu points are outliers, more "
             "than 10 mm off.\n",
             found.mean_clipped, found.median, 100 * found.above_9, found.outliers,
             found.points + found.outliers);
}

}  // namespace viewgain::app
