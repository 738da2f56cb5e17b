// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/pose.hpp"

namespace viewgain::detail {

/// Poses as text: twelve numbers [R | t] row by row for each, shortest digits that read back the
/// same double, one pose a line.
[[nodiscard]] std::string poses_to_text(const std::vector<Pose>& poses);
/// Nothing if the text is anything else.
[[nodiscard]] std::optional<std::vector<Pose>> poses_from_text(std::string_view text);

}  // namespace viewgain::detail
