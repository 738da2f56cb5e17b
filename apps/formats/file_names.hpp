// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace viewgain::app {

/// The name's ending, as .vdb, with capital letters made small.
[[nodiscard]] std::string small_ending(const std::filesystem::path& path);

/// Whether something is there that is neither a regular file nor a folder (/dev/null, a pipe).
/// Names of such files may end in anything.
[[nodiscard]] bool is_special_file(const std::filesystem::path& path);

}  // namespace viewgain::app
