// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/depth_frame.hpp"

#include <string>

#include "viewgain/core/error.hpp"

namespace viewgain {

void check_frame_size(const DepthFrame& frame, const PinholeCamera& camera) {
  const std::size_t pixels =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  if (frame.width != camera.width || frame.height != camera.height ||
      frame.depth.size() != pixels) {
    refuse("depth frame is " + std::to_string(frame.width) + " x " + std::to_string(frame.height) +
           " px with " + std::to_string(frame.depth.size()) + " values, the sensor has " +
           std::to_string(camera.width) + " x " + std::to_string(camera.height));
  }
  if (!frame.amplitude.empty() && frame.amplitude.size() != pixels) {
    refuse("depth frame has " + std::to_string(frame.amplitude.size()) + " amplitudes for " +
           std::to_string(pixels) + " pixels");
  }
  if (!frame.known_depth.empty() && frame.known_depth.size() != pixels) {
    refuse("depth frame has " + std::to_string(frame.known_depth.size()) + " known depths for " +
           std::to_string(pixels) + " pixels");
  }
}

}  // namespace viewgain
