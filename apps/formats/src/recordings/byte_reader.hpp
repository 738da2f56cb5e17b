// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "viewgain/core/error.hpp"

namespace viewgain {

static_assert(std::endian::native == std::endian::little);

/// Reads little-endian numbers and texts from the front of some bytes. Checks every length against
/// the remaining bytes; throws Error(format) without a file's name if it is too large.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  [[nodiscard]] std::size_t left() const noexcept { return bytes_.size(); }

  std::string_view bytes(std::uint64_t count) {
    if (count > bytes_.size()) {
      throw Error(ErrorCode::format, "expected " + std::to_string(count) +
                                         " more bytes, but only " + std::to_string(bytes_.size()) +
                                         " are left");
    }
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }

  template <typename Number>
  Number number() {
    Number value{};
    std::memcpy(&value, bytes(sizeof value).data(), sizeof value);
    return value;
  }

  /// A text after its length in 32 bits.
  std::string_view text() { return bytes(number<std::uint32_t>()); }

 private:
  std::string_view bytes_;
};

}  // namespace viewgain
