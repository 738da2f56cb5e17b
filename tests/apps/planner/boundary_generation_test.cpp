// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later

// The planner with views at the surface's boundaries proposes what the loop of reconstruct does.
#include "viewgain/planner_mesh/boundary_generation.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "apps/planner/planner_scene.hpp"
#include "core/expect_error.hpp"
#include "viewgain/planner/view_planner.hpp"
#include "viewgain/planner_mesh/candidate_generation.hpp"

namespace viewgain {
namespace {

constexpr double kVoxel = 0.005;

TEST(BoundaryGeneration, ProposesWhatTheLoopDoes) {
  const Sensor sensor = test::half_sr4000();
  const auto mesh = std::make_shared<const SurfaceScene>(test::box_mesh(0.08));
  const SimulatedSensor camera(mesh, sensor, {});
  SurfaceModelConfig model_config = test::model_config(sensor, 0.12, kVoxel);
  SurfaceModel model(sensor, model_config, nullptr, {1});
  CandidateGeneration loop(model, sensor, default_generation(sensor, kVoxel), {1});
  PlannerConfig config;
  config.grid = model_config.map.grid;
  config.jump_edges.reset();
  ViewPlanner planner(sensor, config, {1});
  const auto generation = std::make_shared<BoundaryGeneration>(
      planner.map(), default_boundary(sensor, kVoxel), ExecConfig{1});
  planner.add_generation(generation);
  EXPECT_TRUE(planner.propose().candidates.empty());  // no surface yet

  for (const Pose& pose :
       {look_at({0.35, 0.2, 0.25}, {0, 0, 0}), look_at({-0.1, 0.4, 0.2}, {0, 0, 0})}) {
    const DepthFrame frame = camera.acquire(pose);
    (void)model.update({pose, {frame}});
    (void)planner.add(frame, pose);
    const Proposal expected = loop.generate(pose);
    const Proposal& proposal = planner.propose();
    ASSERT_EQ(proposal.candidates.size(), expected.candidates.size());
    EXPECT_GT(expected.candidates.size(), 20U);
    EXPECT_EQ(proposal.dropped, expected.dropped);
    for (std::size_t i = 0; i < expected.candidates.size(); ++i) {
      EXPECT_EQ(proposal.candidates[i].T_world_camera, expected.candidates[i].T_world_camera);
      EXPECT_EQ(proposal.candidates[i].number, expected.candidates[i].number);
      EXPECT_EQ(proposal.candidates[i].boundary_class, expected.candidates[i].boundary_class);
    }
    EXPECT_EQ(generation->surface().triangles, model.surface().triangles);
    EXPECT_EQ(generation->estimated().runs.size(), loop.estimated().runs.size());
  }
}

TEST(BoundaryGeneration, RefusesASpacingThatIsNone) {
  for (const double spacing : {0.0, -0.01, std::numeric_limits<double>::quiet_NaN()}) {
    test::expect_error(ErrorCode::invalid_argument, "spacing",
                       [&] { (void)default_boundary(test::half_sr4000(), spacing); });
  }
}

}  // namespace
}  // namespace viewgain
