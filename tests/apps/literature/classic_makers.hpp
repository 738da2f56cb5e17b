// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "raycast/scene_makers.hpp"
#include "viewgain/literature/classic_gains.hpp"

namespace viewgain::test {

/// All ten, in their order.
[[nodiscard]] std::vector<ClassicGain> all_classic_gains();

/// Gives known voxels any log-odds of their state; those of some blocks of 8³ the same.
void vary_log_odds(BeliefGrid& grid, Random& random);

}  // namespace viewgain::test
