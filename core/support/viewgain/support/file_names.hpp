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

/// The name's ending, such as .vdb, in lower case. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string small_ending(const std::filesystem::path& path);

/// Whether the name refers to something other than a regular file or a folder (/dev/null, a pipe),
/// or to an open file of this process (/dev/stdout). Such names may have any ending. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT bool is_special_file(const std::filesystem::path& path);

/// What is wrong with the ending of an output file: "the name of a surface must end in .ply". Empty
/// if the ending is one of `endings`, in lower or upper case, or for is_special_file(). Never
/// throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string fault_of_ending(
    const std::filesystem::path& path, std::string_view what,
    std::initializer_list<std::string_view> endings);

/// Throws Error(invalid_argument) that names the file and has fault_of_ending(), if there is one.
/// All writers of a format call it, so that a file's name matches its format.
VIEWGAIN_EXPORT void require_ending(const std::filesystem::path& path, std::string_view what,
                                    std::initializer_list<std::string_view> endings);

}  // namespace viewgain
