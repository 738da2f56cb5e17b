// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

/// @file
/// Hashes and random numbers that are the same on every machine.

namespace viewgain {

/// Increment of the state of SplitMix64.
inline constexpr std::uint64_t kMixStep = 0x9E3779B97F4A7C15ULL;

/// The finaliser of SplitMix64, a bijection. A change of one input bit changes about half of the
/// output bits.
[[nodiscard]] constexpr std::uint64_t finalize64(std::uint64_t x) {
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31U);
}

/// SplitMix64 (Steele, Lea, Flood, OOPSLA 2014), used as a hash of a counter. Random choices made
/// with it do not depend on the machine or on their order.
[[nodiscard]] constexpr std::uint64_t mix64(std::uint64_t x) { return finalize64(x + kMixStep); }

/// Converts the upper 53 bits to a number in [0, 1).
[[nodiscard]] constexpr double unit_number(std::uint64_t bits) {
  return static_cast<double>(bits >> 11U) * 0x1.0p-53;
}

/// A 64-bit hash of a sequence of 64-bit words, for identifying contents. It is the same on every
/// machine, and not cryptographic.
class Hash64 {
 public:
  void add(std::uint64_t word) {
    state_ = finalize64(state_ ^ (word + kMixStep)) + kMixStep;
    ++count_;
  }
  void add_number(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  /// Adds the bytes as little-endian words, and then their number.
  void add_bytes(std::string_view bytes) {
    const auto word_at = [&](std::size_t at, std::size_t count) {
      std::uint64_t word = 0;
      for (std::size_t i = 0; i < count; ++i) {
        word |= std::uint64_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
      }
      return word;
    };
    std::size_t i = 0;
    for (; i + 8 <= bytes.size(); i += 8) add(word_at(i, 8));
    add(word_at(i, bytes.size() - i));
    add(bytes.size());
  }

  [[nodiscard]] std::uint64_t value() const { return finalize64(state_ ^ count_); }
  /// The hash as 16 hexadecimal digits.
  [[nodiscard]] std::string hex() const {
    std::string text(16, '0');
    for (std::size_t i = 0; i < 16; ++i) {
      text[i] = "0123456789abcdef"[value() >> (60U - 4U * i) & 15U];
    }
    return text;
  }

 private:
  std::uint64_t state_ = 0;
  std::uint64_t count_ = 0;
};

/// The hash of a text as 16 hexadecimal digits.
[[nodiscard]] inline std::string hash_of(std::string_view text) {
  Hash64 hash;
  hash.add_bytes(text);
  return hash.hex();
}

}  // namespace viewgain
