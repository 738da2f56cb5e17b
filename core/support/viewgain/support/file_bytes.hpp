// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// The largest file that file_bytes() reads unless told otherwise, and the most that it takes from
/// a pipe, whose length nobody knows beforehand [bytes].
inline constexpr std::uint64_t kMostFileBytes = std::uint64_t{1} << 34U;
/// Default of the most that is read from a pipe [bytes].
inline constexpr std::uint64_t kMostPipeBytes = std::uint64_t{1} << 30U;

/// All bytes of a regular file or a pipe. Throws Error(io) that names the file if it cannot be
/// opened, is something else (a folder, a device), or a read fails; Error(capacity) if it has more
/// than `most` bytes or does not fit into memory. Thread safe. Cost: the bytes are read once.
[[nodiscard]] VIEWGAIN_EXPORT std::string file_bytes(const std::filesystem::path& path,
                                                     std::uint64_t most = kMostFileBytes);

/// The same of a file that was found in a folder: a regular one, since a pipe would wait for
/// somebody to write, and nobody has named it. Throws Error(io) for all others, too. Thread safe.
[[nodiscard]] VIEWGAIN_EXPORT std::string folder_file_bytes(const std::filesystem::path& path,
                                                            std::uint64_t most = kMostFileBytes);

/// At most the first `count` bytes of a regular file. Throws Error(io) and costs as file_bytes().
/// Thread safe.
[[nodiscard]] VIEWGAIN_EXPORT std::string file_head(const std::filesystem::path& path,
                                                    std::size_t count);

/// From now on file_bytes() keeps what it reads from a pipe, and whoever reads that pipe again gets
/// the same bytes. For a program that reads each file of its command line from as many places as it
/// likes, and then ends; it costs the pipes' bytes in memory.
VIEWGAIN_EXPORT void keep_bytes_of_pipes() noexcept;

}  // namespace viewgain
