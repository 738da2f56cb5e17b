// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace viewgain {

/// Unpacks "zstd", "lz4" (frames), "bz2", or "" and "none", which copy. `size` is what the file
/// says of the unpacked bytes; memory is taken as they come, so that a wrong one costs none.
/// Returns why it ended early; empty: all is there. `out` has what there was until then. Throws
/// Error(format) for other names and for sizes over kMostRecordBytes.
[[nodiscard]] std::string unpack(std::string_view packing, std::string_view packed,
                                 std::uint64_t size, std::string& out);

}  // namespace viewgain
