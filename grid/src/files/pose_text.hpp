// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/pose.hpp"

namespace viewgain::detail {

/// Poses as text: one per line, twelve numbers [R | t] row-major, with the shortest digits that
/// read back exactly.
[[nodiscard]] std::string poses_to_text(const std::vector<Pose>& poses);
/// Empty for any other text.
[[nodiscard]] std::optional<std::vector<Pose>> poses_from_text(std::string_view text);

}  // namespace viewgain::detail
