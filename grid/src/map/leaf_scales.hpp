// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "grid_storage.hpp"

namespace viewgain::detail {

/// A block's codes and beliefs (or null) in cells of another scale, as BeliefGrid::resample()
/// documents. Allocations come first.
void resample_block(Index3 origin, double voxel_size, int from, int to, std::uint8_t* codes,
                    std::shared_ptr<const BeliefBlock>& beliefs);

/// As the grid's (belief_blocks.hpp).
void set_scale(GridStorage& s, std::uint64_t key, int scale);

/// Keys of the blocks that store anything by cells, in increasing order.
[[nodiscard]] std::vector<std::uint64_t> held_blocks(const GridStorage& s);

/// Removes the scales of blocks that store nothing by cells.
void drop_idle_scales(GridStorage& s);

}  // namespace viewgain::detail
