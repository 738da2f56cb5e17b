// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "viewgain/core/camera.hpp"
#include "viewgain/core/export.hpp"

namespace viewgain {

struct DepthFrame;

/// Table of a camera's systematic range error, which depends on the range (Fuchs and Hirzinger,
/// CVPR 2008). A value type. Members require a table that passes validate(). They do not check
/// their arguments unless stated otherwise.
struct VIEWGAIN_EXPORT RangeCalibration {
  /// Rows of measured range and its error, measured minus true range [m], in order of increasing
  /// measured range. Empty: no correction.
  std::vector<std::array<double, 2>> table{};

  /// Throws Error(invalid_argument) unless all numbers are finite and the measured ranges increase
  /// strictly.
  void validate() const;

  /// `measured_range` [m] minus its error. The error is interpolated linearly in the table, and is
  /// constant beyond its ends.
  [[nodiscard]] double corrected(double measured_range) const;

  /// Corrects all readings (measured depths) of the frame along their rays. If a corrected range is
  /// not positive, the pixel becomes invalid. Other pixels, amplitudes and known depths do not
  /// change. Throws Error(invalid_argument) if frame and camera differ in size. Cost: 30 ns per
  /// pixel; with lens distortion 0.5 µs.
  void correct(const PinholeCamera& camera, DepthFrame& frame) const;

  bool operator==(const RangeCalibration&) const = default;
};

/// Corrects many frames of one camera. Results are bit-identical to those of
/// RangeCalibration::correct(), but the rays are computed only once. Immutable; may be used from
/// many threads at once.
class VIEWGAIN_EXPORT RangeCorrector {
 public:
  /// Throws whatever PinholeCamera::validate() and RangeCalibration::validate() throw. Cost: 8
  /// bytes and 10 ns per pixel; with lens distortion 0.4 µs. Constant if the table is empty.
  RangeCorrector(const PinholeCamera& camera, RangeCalibration calibration);

  /// The camera.
  [[nodiscard]] const PinholeCamera& camera() const noexcept { return camera_; }
  /// The calibration table.
  [[nodiscard]] const RangeCalibration& calibration() const noexcept { return calibration_; }

  /// Corrects all readings (measured depths) of the frame along their rays. If a corrected range is
  /// not positive, the pixel becomes invalid. Other pixels, amplitudes and known depths do not
  /// change. Throws Error(invalid_argument) if frame and camera differ in size. Cost: 10 ns per
  /// pixel, with or without lens distortion.
  void correct(DepthFrame& frame) const;
  /// As above, for width * height depths [m] in row-major order, as in DepthFrame::depth.
  void correct(std::span<float> depth) const;

 private:
  PinholeCamera camera_;
  RangeCalibration calibration_;
  std::vector<double> range_per_depth_;  // one per pixel, not finite without a ray; or empty
};

}  // namespace viewgain
