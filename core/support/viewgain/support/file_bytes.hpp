// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Default of the largest size of a file that file_bytes() reads [bytes].
inline constexpr std::uint64_t kMostFileBytes = std::uint64_t{1} << 34U;
/// Maximum that file_bytes() reads from a pipe, whose length is not known beforehand [bytes].
inline constexpr std::uint64_t kMostPipeBytes = std::uint64_t{1} << 30U;

/// All bytes of a regular file or a pipe. Throws Error(io) that names the file if it is neither,
/// cannot be opened or cannot be read. Throws Error(capacity) if it has more than `most` bytes or
/// does not fit into memory. Thread safe. Cost: the bytes are read once.
[[nodiscard]] VIEWGAIN_EXPORT std::string file_bytes(const std::filesystem::path& path,
                                                     std::uint64_t most = kMostFileBytes);

/// As above, for a file that was found in a folder. Throws Error(io) unless it is a regular file,
/// because reading a pipe would wait for a writer. Thread safe.
[[nodiscard]] VIEWGAIN_EXPORT std::string folder_file_bytes(const std::filesystem::path& path,
                                                            std::uint64_t most = kMostFileBytes);

/// The first `count` bytes of a regular file, or all if it has fewer. Throws Error(io) if it cannot
/// be opened or read. Thread safe.
[[nodiscard]] VIEWGAIN_EXPORT std::string file_head(const std::filesystem::path& path,
                                                    std::size_t count);

/// After this call, file_bytes() keeps the bytes of each pipe in memory, and returns them again for
/// the same pipe. For a program that reads the files of its command line several times and then
/// ends.
VIEWGAIN_EXPORT void keep_bytes_of_pipes() noexcept;

}  // namespace viewgain
