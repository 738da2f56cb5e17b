// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "viewgain/core/export.hpp"

/// @file
/// What names of files say. The functions never throw. Cost: at most a look at the file system.

namespace viewgain {

/// The name's ending, as .vdb, with capital letters made small.
[[nodiscard]] VIEWGAIN_EXPORT std::string small_ending(const std::filesystem::path& path);

/// Whether something is there that is neither a regular file nor a folder (/dev/null, a pipe).
/// Names of such files may end in anything.
[[nodiscard]] VIEWGAIN_EXPORT bool is_special_file(const std::filesystem::path& path);

}  // namespace viewgain
