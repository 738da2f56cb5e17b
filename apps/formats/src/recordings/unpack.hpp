// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace viewgain {

/// Unpacks "zstd", "lz4" (frames), "bz2", or "" and "none", which copy. `size` is the unpacked size
/// according to the file; memory grows with the actual bytes, so a wrong size is harmless. Returns
/// why unpacking ended early, or empty; `out` has the bytes up to then. Throws Error(format) for
/// other names and for sizes over kMostRecordBytes.
[[nodiscard]] std::string unpack(std::string_view packing, std::string_view packed,
                                 std::uint64_t size, std::string& out);

}  // namespace viewgain
