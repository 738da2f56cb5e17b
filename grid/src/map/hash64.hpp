// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "viewgain/support/mix64.hpp"

namespace viewgain::detail {

/// A 64-bit hash of a sequence of 64-bit words, the same on every machine. Not cryptographic.
class Hash64 {
 public:
  void add(std::uint64_t word) {
    state_ = finalize64(state_ ^ (word + kMixStep)) + kMixStep;
    ++count_;
  }
  [[nodiscard]] std::uint64_t value() const { return finalize64(state_ ^ count_); }

  /// 16 hexadecimal digits.
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

}  // namespace viewgain::detail
