// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace viewgain::detail {

/// Follows the outline of an OpenVDB file (header, metadata, grid descriptors with their positions)
/// and says what is wrong with it, or nothing. OpenVDB's reader neither notices a read that came
/// short nor cleans up after an exception, so a file that is cut is better found before it. The
/// grids' contents are not looked at, nor those of files without positions (written to a pipe).
[[nodiscard]] std::string fault_in_outline(std::string_view file);

// A seal is 24 bytes behind the last grid, where OpenVDB does not look: a mark, the length of what
// comes before, and its hash. OpenVDB's reader trusts sizes that it finds in a file; a seal that
// fits means that the bytes are those that were written.

[[nodiscard]] std::string make_seal(std::string_view bytes);

enum class SealCheck : std::uint8_t { absent, intact, broken };
[[nodiscard]] SealCheck check_seal(std::string_view file);

}  // namespace viewgain::detail
