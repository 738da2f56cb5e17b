// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "apps/planner/c_scene.hpp"
#include "viewgain/core/jump_edge_filter.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/planner.h"
#include "viewgain/planner/frame_check.hpp"

namespace viewgain {
namespace {

using test::BinScene, test::CScene, test::numbers_of;

// A check beside a bare integrator says what C++'s says.
TEST(CFrameCheck, SaysWhatTheOtherSays) {
  const CScene c;
  const BinScene& scene = c.scene;
  const double plane = c.config.support_plane;
  const JumpEdgeFilter filter(scene.sensor.camera);
  std::size_t cases = 0;
  for (const double off : {0.0, 0.04}) {
    FrameCheck own(scene.sensor, plane);
    BeliefGrid map(scene.config(GainModel::combined).grid);
    FrameIntegrator integrator(scene.sensor, {.support_plane = plane}, {1});
    vg_frame_check* check = nullptr;
    ASSERT_EQ(vg_frame_check_create(&c.sensor, plane, &check), VG_OK) << vg_last_error();
    vg_grid_config grid_config;
    vg_grid_config_init(&grid_config, sizeof grid_config);
    grid_config.voxel_size = c.config.voxel_size;
    grid_config.prior_sigma = map.prior_sigma();
    std::copy_n(c.config.box_min, 3, grid_config.box_min);
    std::copy_n(c.config.box_max, 3, grid_config.box_max);
    vg_grid* grid = nullptr;
    ASSERT_EQ(vg_grid_create(&grid_config, &grid), VG_OK) << vg_last_error();
    vg_integrator_config settings;
    vg_integrator_config_init(&settings, sizeof settings);
    settings.support_plane = plane;
    settings.num_threads = 1;
    vg_integrator* puts = nullptr;
    ASSERT_EQ(vg_integrator_create(&c.sensor, &settings, &puts), VG_OK) << vg_last_error();
    constexpr std::size_t kViews = 6;
    for (std::size_t view = 0; view < kViews; ++view) {
      const Pose& right = scene.views[2 * view];
      DepthFrame frame = scene.see(right, view);
      filter.apply(frame);
      const Pose pose{right.rotation(),
                      right.translation() + Eigen::Vector3d(view % 2 == 0 ? 0 : off, 0, 0)};
      own.look(map, frame, pose);
      own.see(frame, pose);
      integrator.integrate(map, frame, pose);
      const std::vector<double> numbers = numbers_of({pose});
      ASSERT_EQ(vg_frame_check_look(check, grid, frame.depth.data(), numbers.data(), nullptr),
                VG_OK)
          << vg_last_error();
      ASSERT_EQ(
          vg_integrate(puts, grid, frame.depth.data(), nullptr, numbers.data(), nullptr, nullptr),
          VG_OK)
          << vg_last_error();
    }
    const FrameConsistency all = own.result(map);
    vg_consistency found;
    vg_consistency_init(&found, sizeof found);
    std::array<std::int32_t, kViews> contradicts{};
    ASSERT_EQ(vg_frame_check_result(check, grid, &found, contradicts.data(), kViews), VG_OK);
    EXPECT_EQ(found.frames, kViews);
    EXPECT_EQ(found.contradicting, all.contradicting.size());
    EXPECT_EQ(found.share_in_free, all.share_in_free);
    EXPECT_EQ(found.share_seen_past, all.share_seen_past);
    EXPECT_EQ(found.displacement, all.displacement);
    EXPECT_EQ(found.expected, all.expected);
    EXPECT_GT(all.expected, 0);
    EXPECT_EQ(found.kind, all.suspicion.kind);
    EXPECT_EQ(found.what, all.suspicion.what);
    EXPECT_EQ(all.suspicion.kind.empty(), off == 0) << all.suspicion.what;
    std::array<std::int32_t, kViews> expected{};
    for (const std::size_t i : all.contradicting) expected[i] = 1;
    EXPECT_EQ(contradicts, expected);
    std::array<double, 16> bent{};
    const std::vector<float> depth = scene.see(scene.views[0], 0).depth;
    EXPECT_EQ(vg_frame_check_look(check, grid, depth.data(), bent.data(), nullptr),
              VG_INVALID_ARGUMENT);
    const std::array<double, 2> negative{-1, 0};
    EXPECT_EQ(vg_frame_check_look(check, grid, depth.data(), numbers_of({scene.views[0]}).data(),
                                  negative.data()),
              VG_INVALID_ARGUMENT);
    EXPECT_EQ(vg_frame_check_result(check, grid, &found, contradicts.data(), kViews), VG_OK);
    EXPECT_EQ(found.frames, kViews);  // what was refused is not counted
    EXPECT_EQ(vg_frame_check_result(check, grid, &found, contradicts.data(), kViews - 1),
              VG_INVALID_ARGUMENT);
    EXPECT_EQ(vg_frame_check_result(nullptr, grid, &found, nullptr, 0), VG_INVALID_ARGUMENT);
    vg_frame_check_release(check);
    vg_frame_check_release(nullptr);
    vg_integrator_release(puts);
    vg_grid_release(grid);
    ++cases;
  }
  EXPECT_EQ(cases, 2U);
}

}  // namespace
}  // namespace viewgain
