// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "viewgain/core/export.hpp"

namespace viewgain {

struct DepthFrame;
struct PinholeCamera;

/// Table of a camera's systematic, distance-dependent error: what the paper's ref. [7] (Fuchs and
/// Hirzinger, CVPR 2008) measures against known distances and subtracts. A value type; unless they
/// say otherwise members check nothing: the table must be one that validate() takes.
struct VIEWGAIN_EXPORT RangeCalibration {
  /// (measured range, measured minus true range) [m], measured ranges rising. Empty: no correction.
  std::vector<std::array<double, 2>> table{};

  /// Throws Error(invalid_argument) unless all are finite and measured ranges rise strictly.
  void validate() const;

  /// `measured_range` [m] less its error [m], which is interpolated linearly, held constant beyond
  /// the ends.
  [[nodiscard]] double corrected(double measured_range) const;

  /// Corrects every reading of the frame along its pixel's ray. A reading whose corrected range is
  /// not positive becomes invalid; other pixels, amplitudes and known depths stay as they are.
  /// Throws Error(invalid_argument) unless the frame has the camera's size. Costs 30 ns a pixel,
  /// with lens distortion half a microsecond.
  void correct(const PinholeCamera& camera, DepthFrame& frame) const;

  bool operator==(const RangeCalibration&) const = default;
};

}  // namespace viewgain
