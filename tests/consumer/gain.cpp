// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What a planner's author writes first: a map from an array of labels, the expected gain of a pose.
#include <cstdio>
#include <viewgain/viewgain.hpp>

int main() {
  std::vector<std::uint8_t> labels(8 * 8 * 8, 1);                    // [x][y][z], all free
  for (std::size_t i = 0; i < labels.size(); i += 8) labels[i] = 0;  // but the lowest layer
  const viewgain::Box workspace{{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}};
  const auto grid = viewgain::BeliefGrid::from_states(
      {.voxel_size = 0.05, .workspace = workspace, .prior_sigma = 0.025}, labels);
  const viewgain::GainEvaluator evaluator(viewgain::VoxelScene::build(grid),
                                          viewgain::sensor_preset("sr4000"));
  const viewgain::Pose T_world_camera = viewgain::look_at({0.013, 0.007, 0.6}, {0, 0, 0});
  std::printf("%.17g\n", evaluator.evaluate(T_world_camera).gain);
}
