// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "viewgain/grid/belief.hpp"

namespace viewgain::detail {

/// What is wrong with a belief that readings in a voxel cannot have made ("has an information of
/// nan"); empty if it may be one. Its numbers must be finite, its information positive semidefinite
/// but for the rounding of its sums, its place no more than 2^28 voxels off, its hits at most
/// 2^31 - 1.
[[nodiscard]] std::string fault_of_belief(const Belief& belief, double voxel_size);

}  // namespace viewgain::detail
