// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/range_corrector.hpp"

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {

RangeCorrector::RangeCorrector(const PinholeCamera& camera, RangeCalibration calibration)
    : camera_(camera), calibration_(std::move(calibration)) {
  camera_.validate();
  calibration_.validate();
  if (calibration_.table.empty()) return;
  range_per_depth_.reserve(static_cast<std::size_t>(camera_.width) *
                           static_cast<std::size_t>(camera_.height));
  for (int v = 0; v < camera_.height; ++v) {
    for (int u = 0; u < camera_.width; ++u) {
      range_per_depth_.push_back(camera_.ray(u, v).norm());
    }
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
    throw Error(ErrorCode::invalid_argument, std::to_string(depth.size()) + " depths for " +
                                                 std::to_string(camera_.width) + " x " +
                                                 std::to_string(camera_.height) + " pixels");
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
