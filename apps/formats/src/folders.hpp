// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace viewgain {

/// Is there something of this name? Throws Error(io) where that cannot be told, as in a folder that
/// may not be looked into or where links go in a circle.
[[nodiscard]] bool is_there(const std::filesystem::path& path);

/// Names in a folder, sorted; none where there is no such folder. Throws Error(io) for one that
/// cannot be read.
[[nodiscard]] std::vector<std::string> names_in(const std::filesystem::path& folder);

}  // namespace viewgain
