// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "viewgain/core/export.hpp"
#include "viewgain/grid/belief_grid.hpp"

namespace viewgain {

struct VIEWGAIN_EXPORT VdbWriteConfig {
  /// Adds covariance_diagonal, covariance_offdiagonal and position, for viewers.
  bool with_covariance = false;
};

/// Writes the map as a plain OpenVDB file (active = known; grid/README.md has the layout), of types
/// that OpenVDB's Python module reads. Atomic: a temporary file beside it is renamed. Throws
/// Error(io). If memory runs out (std::bad_alloc), the file that was there stays.
VIEWGAIN_EXPORT void save_vdb(const BeliefGrid& grid, const std::filesystem::path& path,
                              const VdbWriteConfig& config = {});

/// Reads a file that save_vdb wrote, of any version, or another program in the same layout; exact:
/// the loaded map has the saved one's content_hash(). Throws Error(io) if it cannot be opened and
/// Error(format), naming the file and what is missing or out of bounds, if it is truncated or no
/// viewgain map; Error(capacity) if tiles hold more than 2^27 occupied voxels, or the file is over
/// 16 GiB.
[[nodiscard]] VIEWGAIN_EXPORT BeliefGrid load_vdb(const std::filesystem::path& path);

}  // namespace viewgain
