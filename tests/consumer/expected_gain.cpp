// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Prints the gain that gain.cpp must print, to the last digit, after holding it against the oracle;
// with any argument that of gain.c, whose grid has its origin at the array's corner.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "oracle/gain.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"

int main(int argc, char**) {
  using namespace viewgain;
  std::vector<std::uint8_t> states;
  for (int xy = 0; xy < 64; ++xy) {
    for (int z = 0; z < 8; ++z) states.push_back(z == 0 ? 0 : 1);
  }
  GridConfig layout;
  layout.voxel_size = 0.05;
  layout.workspace = {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}};
  layout.prior_sigma = 0.025;
  if (argc > 1) {
    layout.workspace = {{0, 0, 0}, {0.4, 0.4, 0.4}};
    layout.T_world_grid = {Eigen::Matrix3d::Identity(), {-0.2, -0.2, -0.2}};
  }
  const BeliefGrid grid = BeliefGrid::from_states(layout, states);
  const Sensor sensor = sensor_preset("sr4000");
  const Pose pose = look_at({0.013, 0.007, 0.6}, {0, 0, 0});

  const std::vector<RayHit> hits = oracle::trace(oracle::DenseMap(grid), sensor, {}, pose);
  const ViewGain expected = oracle::gain_of_hits(grid, sensor, {}, pose, hits);
  const auto scene = VoxelScene::build(grid);
  const ViewGain gain = GainEvaluator(scene, sensor, {.model = GainModel::paper}).evaluate(pose);
  if (gain.hits < 1000 || gain.hits != expected.hits ||
      !(std::abs(gain.gain - expected.gain) < 1e-5 * expected.gain)) {
    std::fprintf(stderr, "%u hits, gain %.17g; the oracle says %u, %.17g\n", gain.hits, gain.gain,
                 expected.hits, expected.gain);
    return 1;
  }
  std::printf("%.17g\n", GainEvaluator(scene, sensor).evaluate(pose).gain);
}
