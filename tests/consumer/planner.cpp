// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The component planner: a frame in, a view out, there and back through a file.
#include <cstdio>
#include <viewgain/core/generators.hpp>
#include <viewgain/planner/view_planner.hpp>
#ifdef WITH_SURFACES
#include <viewgain/planner_mesh/candidate_generation.hpp>
#endif

int main(int, char** argv) {
  const viewgain::Sensor sensor = viewgain::sensor_preset("sr4000");
  viewgain::ScorerConfig config;
  config.voxel_size = 0.02;
  config.workspace = {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}};
  viewgain::ViewPlanner planner(viewgain::ViewScorer(sensor, config));
  planner.add_poses({"sphere", viewgain::sphere_poses(30, 0.6)});
#ifdef WITH_SURFACES
  planner.add_generation(std::make_shared<viewgain::BoundaryGeneration>(
      planner.scorer(), viewgain::default_boundary(sensor, config.voxel_size)));
#endif
  viewgain::DepthFrame frame{176, 144, std::vector<float>(176 * 144, 0.6F)};
  const auto view = planner.add(frame, viewgain::look_at({0.6, 0, 0}, {0, 0, 0}));
  const bool added = view.update.counts.readings_inside > 1000;
  const bool proposed = planner.propose().candidates.size() > 10;
  const bool ranked = planner.rank(2).views.size() == 2;
  planner.save(argv[1]);
  const auto again = viewgain::ViewPlanner::load(argv[1], sensor, config, {});
  const bool loaded =
      again.scorer().grid().content_hash() == planner.scorer().grid().content_hash();
  std::printf("%d%d%d%d\n", added, proposed, ranked, loaded);
}
