// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// @file
/// Random numbers that are the same on every machine. The functions take any number and never
/// throw.

namespace viewgain {

/// Steps of this between the arguments of mix64 give SplitMix64's sequence.
inline constexpr std::uint64_t kMixStep = 0x9E3779B97F4A7C15ULL;

/// SplitMix64's finaliser: a bijection in which every input bit flips half of the output's.
[[nodiscard]] constexpr std::uint64_t finalize64(std::uint64_t x) {
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31U);
}

/// SplitMix64 (Steele, Lea, Flood, OOPSLA 2014): a good hash of a counter, so that random choices
/// are the same on every machine and do not depend on the order in which they are made.
[[nodiscard]] constexpr std::uint64_t mix64(std::uint64_t x) { return finalize64(x + kMixStep); }

/// The upper 53 bits as a number in [0, 1).
[[nodiscard]] constexpr double unit_number(std::uint64_t bits) {
  return static_cast<double>(bits >> 11U) * 0x1.0p-53;
}

}  // namespace viewgain
