// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstring>

#include "viewgain/grid/belief.hpp"
#include "viewgain/support/log_odds_code.hpp"

namespace viewgain::detail {

/// Bits of the voxels of a block with a greater code, eight codes at a time.
[[nodiscard]] inline LeafMask mask_above(const std::uint8_t* codes, std::uint8_t code) {
  static_assert(kMaxCode < 128 && std::endian::native == std::endian::little);
  constexpr std::uint64_t kOnes = 0x0101010101010101ULL;
  constexpr std::uint64_t kGather = 0x0102040810204080ULL;  // lowest bit of byte i to bit 56 + i
  const std::uint64_t lift = kOnes * (127U - code);         // sets the top bit of greater codes
  LeafMask mask{};
  for (std::size_t word = 0; word < 8; ++word) {
    for (std::size_t byte = 0; byte < 8; ++byte) {
      std::uint64_t eight;
      std::memcpy(&eight, codes + word * 64 + byte * 8, 8);
      const std::uint64_t top = ((eight + lift) >> 7U) & kOnes;
      mask[word] |= ((top * kGather) >> 56U) << (8 * byte);
    }
  }
  return mask;
}

[[nodiscard]] inline LeafMask known_mask(const std::uint8_t* codes) {
  return mask_above(codes, kUnknownCode);
}
[[nodiscard]] inline LeafMask occupied_mask(const std::uint8_t* codes) {
  return mask_above(codes, kZeroCode);
}

}  // namespace viewgain::detail
