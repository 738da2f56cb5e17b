// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace viewgain::detail {

// A seal is 24 bytes behind the last grid, where OpenVDB does not look: a mark, the length of what
// comes before, and its hash. OpenVDB's reader trusts sizes that it finds in a file; a seal that
// fits means that the bytes are those that were written.

[[nodiscard]] std::string make_seal(std::string_view bytes);

enum class SealCheck : std::uint8_t { absent, intact, broken };
[[nodiscard]] SealCheck check_seal(std::string_view file);

}  // namespace viewgain::detail
