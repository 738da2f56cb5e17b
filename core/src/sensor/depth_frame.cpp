// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/depth_frame.hpp"

#include <string>

#include "viewgain/core/error.hpp"
#include "viewgain/support/frame_identity.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {

void check_frame_size(const DepthFrame& frame, const PinholeCamera& camera) {
  const std::size_t pixels =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  if (frame.width != camera.width || frame.height != camera.height ||
      frame.depth.size() != pixels) {
    refuse("the depth frame has " + std::to_string(frame.width) + " x " +
           std::to_string(frame.height) + " px with " + std::to_string(frame.depth.size()) +
           " values, but the sensor has " + std::to_string(camera.width) + " x " +
           std::to_string(camera.height) + " px");
  }
  if (!frame.amplitude.empty() && frame.amplitude.size() != pixels) {
    refuse("the depth frame has " + std::to_string(frame.amplitude.size()) + " amplitudes for " +
           std::to_string(pixels) + " pixels");
  }
  if (!frame.known_depth.empty() && frame.known_depth.size() != pixels) {
    refuse("the depth frame has " + std::to_string(frame.known_depth.size()) +
           " known depths for " + std::to_string(pixels) + " pixels");
  }
}

bool is_identity(const std::string& text) {
  constexpr std::size_t kDigits = 16;
  return text.size() >= kDigits + 2 && text.find_first_not_of("0123456789abcdef") == kDigits &&
         text[kDigits] == ' ' && text.find('\n') == std::string::npos;
}

void check_identity(const std::string& identity) {
  if (identity.empty() || is_identity(identity)) return;
  refuse("the identity of a frame must be 16 hexadecimal digits, a space and a name, not " +
         quoted(identity));
}

}  // namespace viewgain
