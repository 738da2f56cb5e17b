// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace viewgain::detail {

/// A number in a binary file.
struct ScalarType {
  enum class Kind : std::uint8_t { floating, signed_integer, unsigned_integer };
  Kind kind = Kind::floating;
  std::size_t size = 4;  ///< 1, 2, 4 or 8 [bytes]; 4 or 8 where floating

  /// Is it one of the types that decode() knows?
  [[nodiscard]] bool is_known() const {
    if (size == 4 || size == 8) return true;
    return kind != Kind::floating && (size == 1 || size == 2);
  }
};

/// The value of `type.size` bytes; 64-bit integers are rounded to double precision.
[[nodiscard]] inline double decode(const char* bytes, ScalarType type, bool big_endian = false) {
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < type.size; ++i) {
    const auto byte = static_cast<unsigned char>(bytes[big_endian ? type.size - 1 - i : i]);
    word |= std::uint64_t{byte} << (8 * i);
  }
  if (type.kind == ScalarType::Kind::floating) {
    return type.size == 8
               ? std::bit_cast<double>(word)
               : static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(word)));
  }
  if (type.kind == ScalarType::Kind::unsigned_integer) return static_cast<double>(word);
  const unsigned unused = 64U - 8U * static_cast<unsigned>(type.size);
  return static_cast<double>(static_cast<std::int64_t>(word << unused) >> unused);
}

}  // namespace viewgain::detail
