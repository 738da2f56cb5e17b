// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace viewgain::detail {

/// A number in a binary file.
struct ScalarType {
  enum class Kind : std::uint8_t { floating, signed_integer, unsigned_integer };
  Kind kind = Kind::floating;
  std::size_t size = 4;  ///< 1, 2, 4 or 8 [bytes]; 4 or 8 where floating

  /// Is it one of the types that decode() knows?
  [[nodiscard]] bool is_known() const;
};

/// The value of `type.size` bytes; 64-bit integers are rounded to double precision.
[[nodiscard]] double decode(const char* bytes, ScalarType type, bool big_endian = false);

}  // namespace viewgain::detail
