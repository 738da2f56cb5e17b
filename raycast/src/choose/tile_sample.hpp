// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gain/view_driver.hpp"

namespace viewgain::detail {

/// The first tiles of a random sequence that covers the image evenly from the start, dealt out in
/// turns, so that all groups together are spread more evenly than each.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> random_tiles(const TileTable& table,
                                                                   std::size_t groups,
                                                                   std::size_t per_group,
                                                                   std::uint64_t seed);

/// Rays of a group.
[[nodiscard]] std::uint64_t rays_of(const TileTable& table, std::span<const std::uint32_t> tiles);

/// Traces groups of a pose's tiles and adds up what each gains by itself, into gains, one a group;
/// NaN for a bad pose.
void sample(const ViewDriver& driver, const Pose& T_world_camera,
            std::span<const std::vector<std::uint32_t>> groups, std::span<double> gains,
            ViewDriver::Lease& lease);

/// The full scores of some of the poses, in their order; entries not reached stay as they are.
/// Returns whether all were reached.
bool evaluate_some(const ViewDriver& driver, std::span<const Pose> T_world_camera,
                   std::span<const std::size_t> indices, std::span<ViewGain> results,
                   const BatchControl& control);

}  // namespace viewgain::detail
