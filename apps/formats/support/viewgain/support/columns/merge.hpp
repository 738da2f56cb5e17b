// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/support/columns/part_head.hpp"
#include "viewgain/support/columns/table.hpp"

namespace viewgain {

/// What merging came to.
struct Merged {
  PartHead head;  ///< of the result
  Table best;     ///< the best rows, best first
};

/// Puts the parts of a job together in `out`: all rows in order, or, with `top`, the best so many,
/// best first. By the gain that stands first, ties to the lower row, NaN last. Memory for
/// `shown` or `top` rows and a line a part; reads each part once.
///
/// Throws Error(invalid_argument) that names the files if they are not parts of one job (another
/// map, sensor, set of settings, version, ISA, set of poses, other columns), if rows are missing or
/// in two of them; Error(io) and Error(format) as PartReader, also for one that is cut off. The
/// result appears whole or not at all. `progress`: rows done, of all.
[[nodiscard]] VIEWGAIN_EXPORT Merged
merge_parts(const std::vector<std::filesystem::path>& parts, const std::filesystem::path& out,
            std::optional<std::size_t> top, std::size_t shown,
            const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace viewgain
