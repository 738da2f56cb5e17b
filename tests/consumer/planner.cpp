// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The component planner, from C++ and C: a frame in, a view out, there and back through a file.
#include <viewgain/planner.h>

#include <cstdio>
#include <viewgain/core/generators.hpp>
#include <viewgain/planner/view_planner.hpp>
#ifdef WITH_SURFACES
#include <viewgain/planner_mesh/candidate_generation.hpp>
#endif

int main(int, char** argv) {
  const viewgain::Sensor sensor = viewgain::sensor_preset("sr4000");
  viewgain::PlannerConfig config;
  config.grid.voxel_size = 0.02;
  config.grid.workspace = {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}};
  viewgain::ViewPlanner planner(sensor, config);
  planner.add_poses({"sphere", viewgain::sphere_poses(30, 0.6)});
#ifdef WITH_SURFACES
  planner.add_generation(std::make_shared<viewgain::BoundaryGeneration>(
      planner.map(), viewgain::default_boundary(sensor, config.grid.voxel_size)));
#endif
  viewgain::DepthFrame frame{176, 144, std::vector<float>(176 * 144, 0.6F)};
  const auto view = planner.add(frame, viewgain::look_at({0.6, 0, 0}, {0, 0, 0}));
  const bool added = view.update.counts.readings_inside > 1000;
  const bool proposed = planner.propose().candidates.size() > 10;
  const bool ranked = planner.rank(2).views.size() == 2;
  planner.save(argv[1]);
  const bool loaded = viewgain::ViewPlanner::load(argv[1], sensor, config).grid().content_hash() ==
                      planner.grid().content_hash();
  vg_sensor of_c;
  vg_sensor_init(&of_c, sizeof of_c);
  vg_planner_config config_of_c;
  vg_planner_config_init(&config_of_c, sizeof config_of_c);
  vg_planner* planner_of_c = nullptr;
  const bool refused = vg_sensor_preset("sr4000", &of_c) == VG_OK &&
                       vg_planner_create(&of_c, &config_of_c, &planner_of_c) == VG_INVALID_ARGUMENT;
  std::printf("%d%d%d%d%d\n", added, proposed, ranked, loaded, refused);
}
