// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

#include "viewgain/core/export.hpp"

/// @file
/// What names of files say. Cost: at most a look at the file system.

namespace viewgain {

/// The name's ending, as .vdb, with capital letters made small. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string small_ending(const std::filesystem::path& path);

/// Whether something is there that is neither a regular file nor a folder (/dev/null, a pipe), or
/// the name stands for an open file of this process (/dev/stdout). Names of such files may end in
/// anything. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT bool is_special_file(const std::filesystem::path& path);

/// What is wrong with the ending of a file that is to be written: "the name of a surface must end
/// in .ply". Empty if it is one of `endings`, capitals too, or is_special_file(). Never throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string fault_of_ending(
    const std::filesystem::path& path, std::string_view what,
    std::initializer_list<std::string_view> endings);

/// Throws Error(invalid_argument) that names the file and has fault_of_ending(), if there is one.
/// All writers of one format call it, so that no file holds another format than its name says.
VIEWGAIN_EXPORT void require_ending(const std::filesystem::path& path, std::string_view what,
                                    std::initializer_list<std::string_view> endings);

}  // namespace viewgain
