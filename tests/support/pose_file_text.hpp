// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <sstream>
#include <string>

#include "viewgain/core/pose.hpp"

namespace viewgain::test {

/// What a frame-NNNNNN.pose.txt holds: 4x4, to the last bit.
inline std::string matrix_text(const Pose& pose) {
  std::ostringstream text;
  text.precision(17);
  for (std::size_t i = 0; i < 12; ++i) text << pose.m[i] << (i % 4 == 3 ? "\n" : " ");
  return text.str() + "0 0 0 1\n";
}

}  // namespace viewgain::test
