// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "viewgain/core/box.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/core/triangle_mesh.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/grid_snapshot.hpp"

namespace viewgain::test {

/// Appends the twelve triangles of a box.
void add_box(TriangleMesh& mesh, const Box& box);

/// The map of a furnished room of 5 m × 4 m × 2.6 m, half of which a depth camera has seen from
/// near its middle: noisy frames, which look round to the left. Its workspace is the room and 0.2 m
/// more on all sides, so there is unknown space behind the walls.
[[nodiscard]] BeliefGrid room_grid(double voxel_size, const Sensor& sensor, int frames = 8,
                                   const ExecConfig& exec = {});

/// Poses that look anywhere, upright: every other one from a voxel that is free, the others from
/// anywhere in the workspace.
[[nodiscard]] std::vector<Pose> poses_in(const GridSnapshot& map, std::size_t count,
                                         std::uint64_t seed);

}  // namespace viewgain::test
