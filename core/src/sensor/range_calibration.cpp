// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/range_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {

void RangeCalibration::validate() const {
  for (std::size_t i = 0; i < table.size(); ++i) {
    const auto& [measured, error] = table[i];
    if (!std::isfinite(measured) || !std::isfinite(error)) {
      refuse("range calibration: entry " + std::to_string(i) +
             " has a number that is not finite: " + short_text(measured) + ", " +
             short_text(error));
    }
    if (i > 0 && !(measured > table[i - 1][0])) {
      refuse("range calibration: measured ranges must increase, but " + short_text(measured) +
             " m follows " + short_text(table[i - 1][0]) + " m");
    }
  }
}

double RangeCalibration::corrected(double measured_range) const {
  if (table.empty()) return measured_range;
  const auto above = std::upper_bound(
      table.begin(), table.end(), measured_range,
      [](double range, const std::array<double, 2>& entry) { return range < entry[0]; });
  if (above == table.begin()) return measured_range - table.front()[1];
  if (above == table.end()) return measured_range - table.back()[1];
  const std::array<double, 2>& low = *(above - 1);
  const std::array<double, 2>& high = *above;
  const double share = (measured_range - low[0]) / (high[0] - low[0]);
  return measured_range - (low[1] + share * (high[1] - low[1]));
}

void RangeCalibration::correct(const PinholeCamera& camera, DepthFrame& frame) const {
  check_frame_size(frame, camera);
  if (!table.empty()) RangeCorrector(camera, *this).correct(frame);
}

RangeCorrector::RangeCorrector(const PinholeCamera& camera, RangeCalibration calibration)
    : camera_(camera), calibration_(std::move(calibration)) {
  camera_.validate();
  calibration_.validate();
  if (calibration_.table.empty()) return;
  range_per_depth_.reserve(static_cast<std::size_t>(camera_.width) *
                           static_cast<std::size_t>(camera_.height));
  for (int v = 0; v < camera_.height; ++v) {
    for (int u = 0; u < camera_.width; ++u) range_per_depth_.push_back(camera_.ray(u, v).norm());
  }
}

void RangeCorrector::correct(DepthFrame& frame) const {
  check_frame_size(frame, camera_);
  correct(std::span(frame.depth));
}

void RangeCorrector::correct(std::span<float> depth) const {
  const std::size_t pixels =
      static_cast<std::size_t>(camera_.width) * static_cast<std::size_t>(camera_.height);
  if (depth.size() != pixels) {
    refuse("there are " + std::to_string(depth.size()) + " depths, but the camera has " +
           std::to_string(camera_.width) + " x " + std::to_string(camera_.height) + " pixels");
  }
  if (calibration_.table.empty()) return;
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    float& z = depth[pixel];
    if (!(z > 0) || !std::isfinite(z)) continue;
    const double range_per_depth = range_per_depth_[pixel];
    if (!std::isfinite(range_per_depth)) continue;  // no ray: no range
    const double range = calibration_.corrected(z * range_per_depth);
    z = range > 0 ? static_cast<float>(range / range_per_depth) : DepthFrame::kInvalid;
  }
}

}  // namespace viewgain
