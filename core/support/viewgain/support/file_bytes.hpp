// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Default of the largest file that file_bytes() reads [bytes].
inline constexpr std::uint64_t kMostFileBytes = std::uint64_t{1} << 34U;
/// Default of the maximum that is read from a pipe, whose length is not known beforehand [bytes].
inline constexpr std::uint64_t kMostPipeBytes = std::uint64_t{1} << 30U;

/// All bytes of a regular file or a pipe. Throws Error(io) that names the file if it cannot be
/// opened, is something else (a folder, a device), or a read fails; Error(capacity) if it has more
/// than `most` bytes or does not fit into memory. Thread safe. Cost: the bytes are read once.
[[nodiscard]] VIEWGAIN_EXPORT std::string file_bytes(const std::filesystem::path& path,
                                                     std::uint64_t most = kMostFileBytes);

/// As above for a file that was found in a folder. It must be a regular file, because a pipe would
/// wait for a writer; throws Error(io) for others. Thread safe.
[[nodiscard]] VIEWGAIN_EXPORT std::string folder_file_bytes(const std::filesystem::path& path,
                                                            std::uint64_t most = kMostFileBytes);

/// At most the first `count` bytes of a regular file. Throws Error(io) like file_bytes(). Thread
/// safe.
[[nodiscard]] VIEWGAIN_EXPORT std::string file_head(const std::filesystem::path& path,
                                                    std::size_t count);

/// From now on file_bytes() keeps the bytes of a pipe, and returns them again for the same pipe.
/// For a program that reads the files of its command line several times and then ends. Costs the
/// memory of these bytes.
VIEWGAIN_EXPORT void keep_bytes_of_pipes() noexcept;

}  // namespace viewgain
