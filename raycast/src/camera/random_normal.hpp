// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "viewgain/support/mix64.hpp"

namespace viewgain::detail {

/// What a pixel needs random numbers for.
enum class RandomStream : std::uint64_t { axial, lateral_x, lateral_y, amplitude };

/// The random numbers of one pixel of one frame.
class PixelRandom {
 public:
  PixelRandom(std::uint64_t seed, std::uint64_t frame, std::uint64_t pixel)
      : base_(mix64(mix64(mix64(seed) ^ frame) ^ pixel)) {}

  /// A standard normal number, by Box and Muller; independent for each stream.
  [[nodiscard]] double normal(RandomStream stream) const {
    const std::uint64_t a = stream == RandomStream::axial
                                ? base_
                                : mix64(base_ ^ mix64(static_cast<std::uint64_t>(stream)));
    const std::uint64_t b = mix64(a);
    const double u = (static_cast<double>(a >> 11U) + 0.5) * 0x1.0p-53;
    const double v = static_cast<double>(b >> 11U) * 0x1.0p-53;
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
  }

 private:
  std::uint64_t base_;
};

}  // namespace viewgain::detail
