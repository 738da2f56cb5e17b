// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/flags/text_hash.hpp"

#include <array>
#include <cstdint>
#include <cstdio>

#include "viewgain/support/mix64.hpp"

namespace viewgain::app {

std::string hash_of(std::string_view text) {
  std::array<std::uint64_t, 2> state{0x76696577U, 0x6761696eU};
  for (std::uint64_t& s : state) {
    s = mix64(s ^ text.size());
    for (const char c : text) s = mix64(s ^ static_cast<unsigned char>(c));
  }
  std::array<char, 33> digits{};
  std::snprintf(digits.data(), digits.size(), "%016llx%016llx",
                static_cast<unsigned long long>(state[0]),
                static_cast<unsigned long long>(state[1]));
  return digits.data();
}

}  // namespace viewgain::app
