// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace viewgain {

/// Whether something of this name exists. Throws Error(io) if that cannot be determined, for
/// example because the folder is not readable or links form a cycle.
[[nodiscard]] bool is_there(const std::filesystem::path& path);

/// Names in a folder, sorted; none if the folder does not exist. Throws Error(io) if it cannot be
/// read.
[[nodiscard]] std::vector<std::string> names_in(const std::filesystem::path& folder);

}  // namespace viewgain
