// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace viewgain::detail {

/// A 64-bit hash of a sequence of 64-bit words, the same on every machine. Not cryptographic.
class Hash64 {
 public:
  void add(std::uint64_t word) {
    state_ = mix(state_ ^ (word + kOdd)) + kOdd;
    ++count_;
  }
  [[nodiscard]] std::uint64_t value() const { return mix(state_ ^ count_); }

  /// 16 hexadecimal digits.
  [[nodiscard]] std::string hex() const {
    std::string text(16, '0');
    for (std::size_t i = 0; i < 16; ++i) {
      text[i] = "0123456789abcdef"[value() >> (60U - 4U * i) & 15U];
    }
    return text;
  }

 private:
  static constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15U;

  // The finaliser of SplitMix64: a bijection in which every input bit flips half of the output's.
  static constexpr std::uint64_t mix(std::uint64_t x) {
    x = (x ^ x >> 30U) * 0xbf58476d1ce4e5b9U;
    x = (x ^ x >> 27U) * 0x94d049bb133111ebU;
    return x ^ x >> 31U;
  }

  std::uint64_t state_ = 0;
  std::uint64_t count_ = 0;
};

}  // namespace viewgain::detail
