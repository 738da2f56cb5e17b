// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Writes frames of a block in the bin of the example bin_planner, as a robot would leave them.
//   bin_planner_frames SENSOR.toml FOLDER
#include <cstdio>
#include <exception>
#include <memory>
#include <vector>

#include "viewgain/core/generators.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/raycast/obstacle_view.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"

using namespace viewgain;

int main(int argc, char** argv) try {
  if (argc != 3) return 2;
  const Sensor sensor = load_sensor(argv[1]);
  const Obstacles block{{{{-0.06, -0.05, 0.0}, {0.07, 0.04, 0.08}}}, {}};
  const Obstacles walls{{{{-0.22, -0.17, 0}, {-0.20, 0.17, 0.2}},
                         {{0.20, -0.17, 0}, {0.22, 0.17, 0.2}},
                         {{-0.22, -0.17, 0}, {0.22, -0.15, 0.2}},
                         {{-0.22, 0.15, 0}, {0.22, 0.17, 0.2}}},
                        {}};
  SimulationConfig config;
  config.noise = true;
  config.support_plane = 0.0;
  config.surroundings = std::make_shared<const SurfaceScene>(mesh_of(walls));
  const SimulatedSensor camera(std::make_shared<const SurfaceScene>(mesh_of(block)), sensor,
                               config);
  const std::vector<Pose> poses = orbit_poses(5, 0.55, 1.0, 0.2, 1.1, {0.0, 0.0, 0.1});
  FramesWriter writer(argv[2]);
  for (std::size_t i = 0; i < poses.size(); ++i) writer.write_frame(i, camera.acquire(poses[i], i));
  writer.commit(poses, sensor);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
