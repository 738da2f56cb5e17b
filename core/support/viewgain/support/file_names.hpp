// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

#include "viewgain/core/export.hpp"

/// @file
/// Checks of file names. Cost: at most one query of the file system.

namespace viewgain {

/// The ending of the name in lower case, such as .vdb. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string small_ending(const std::filesystem::path& path);

/// Whether the name refers to an open file of this process (/dev/stdout), or to something other
/// than a regular file or a folder, such as /dev/null or a pipe. These may have any ending. Never
/// throws.
[[nodiscard]] VIEWGAIN_EXPORT bool is_special_file(const std::filesystem::path& path);

/// A message about a wrong ending of an output file, such as "the name of a surface must end in
/// .ply". `what` is the subject ("a surface"). Empty if the ending is one of `endings`, in lower or
/// upper case, or if is_special_file(). Never throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string fault_of_ending(
    const std::filesystem::path& path, std::string_view what,
    std::initializer_list<std::string_view> endings);

/// Throws Error(invalid_argument) with the file's name and fault_of_ending(), unless that is empty.
/// All functions that write a format call it, so that the name of a file matches its format.
VIEWGAIN_EXPORT void require_ending(const std::filesystem::path& path, std::string_view what,
                                    std::initializer_list<std::string_view> endings);

}  // namespace viewgain
