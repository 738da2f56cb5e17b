// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace viewgain::detail {

// A seal is 24 bytes after the last grid, which OpenVDB ignores: a mark, the length of everything
// before, and its hash. OpenVDB's reader trusts sizes in a file; a valid seal shows that the bytes
// are as written.

[[nodiscard]] std::string make_seal(std::string_view bytes);

enum class SealCheck : std::uint8_t { absent, intact, broken };
[[nodiscard]] SealCheck check_seal(std::string_view file);

}  // namespace viewgain::detail
