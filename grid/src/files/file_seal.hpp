// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/pose.hpp"

namespace viewgain::detail {

// A seal is 24 bytes behind the last grid, where OpenVDB does not look: a mark, the length of what
// comes before, and its hash. OpenVDB's reader trusts sizes that it finds in a file; a seal that
// fits means that the bytes are those that were written.

[[nodiscard]] std::string make_seal(std::string_view bytes);

enum class SealCheck : std::uint8_t { absent, intact, broken };
[[nodiscard]] SealCheck check_seal(std::string_view file);

/// Poses as text: twelve numbers [R | t] row by row for each, shortest digits that read back the
/// same double, one pose a line.
[[nodiscard]] std::string poses_to_text(const std::vector<Pose>& poses);
/// Nothing if the text is anything else.
[[nodiscard]] std::optional<std::vector<Pose>> poses_from_text(std::string_view text);

}  // namespace viewgain::detail
