// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "scalar_type.hpp"

#include <bit>

namespace viewgain::detail {

bool ScalarType::is_known() const {
  if (size == 4 || size == 8) return true;
  return kind != Kind::floating && (size == 1 || size == 2);
}

double decode(const char* bytes, ScalarType type, bool big_endian) {
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
