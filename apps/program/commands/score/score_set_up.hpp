// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "program/commands/score/score_options.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain::app {

/// Warns of values that are valid but rarely intended (suspect_set_up.hpp). `sensor` is that of the
/// map.
void warn_of_set_up(const ScoreOptions& options, const Obstacles& obstacles, const BeliefGrid& grid,
                    Sensor sensor);

}  // namespace viewgain::app
