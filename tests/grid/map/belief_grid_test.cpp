// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The grid itself: layout, states, bad input, hash.

#include "viewgain/grid/belief_grid.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <set>

#include "core/expect_error.hpp"
#include "grid/analytic_frames.hpp"
#include "grid/voxels.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain {
namespace {

using namespace test;

GridConfig cube(double voxel_size, double from, double to) {
  return {voxel_size, {{from, from, from}, {to, to, to}}, {}, 0.01};
}

TEST(BeliefGrid, WorkspaceGrowsOutwardToTheLattice) {
  const BeliefGrid grown({0.1, {{-0.25, 0.0, 0.31}, {0.25, 0.3, 0.39}}, {}, 0.01});
  EXPECT_EQ(grown.min_index(), (Index3{-3, 0, 3}));
  EXPECT_EQ(grown.dims(), (Index3{6, 3, 1}));
  EXPECT_EQ(grown.voxel_count(), 18U);
  EXPECT_NEAR(grown.workspace().min[0], -0.3, 1e-12);
  EXPECT_NEAR(grown.workspace().max[2], 0.4, 1e-12);
  // Within 1e-6 voxel of the lattice nothing moves; beyond it does.
  EXPECT_EQ(BeliefGrid(cube(0.1, 0.1 - 0.9e-7, 0.5 + 0.9e-7)).dims().x, 4);
  EXPECT_EQ(BeliefGrid(cube(0.1, 0.1 - 1.1e-7, 0.5 + 1.1e-7)).dims().x, 6);
  EXPECT_EQ(BeliefGrid(cube(0.1, 0.1 + 0.9e-7, 0.5)).min_index().x, 1);
  // camel-128: 0.4 / 128 is no binary fraction of 0.2.
  EXPECT_EQ(BeliefGrid(object_grid(128)).dims(), (Index3{128, 128, 128}));
}

TEST(BeliefGrid, IsMadeOfADefaultLayoutForItsSensor) {
  EXPECT_EQ(BeliefGrid(GridConfig{}).dims(), (Index3{100, 100, 100}));
  for (const std::string& name : sensor_preset_names()) {
    const Sensor sensor = sensor_preset(name);
    EXPECT_EQ(BeliefGrid(GridConfig{}, sensor).prior_sigma(), default_prior_sigma(0.005, sensor));
    EXPECT_EQ(BeliefGrid(cube(0.01, 0, 1), sensor).prior_sigma(), 0.01);
  }
}

TEST(BeliefGrid, AnUnknownWorkspaceCostsTiles) {
  for (const double low : {-20.0, 0.0, 3.217, -512.0 * 0.01}) {
    const BeliefGrid grid(cube(0.01, low, low + 40.0));
    const BeliefGrid::Statistics statistics = grid.statistics();
    EXPECT_GE(statistics.unknown, 64000000000U);
    EXPECT_EQ(statistics.unknown, grid.voxel_count());
    EXPECT_EQ(statistics.free + statistics.occupied, 0U);
    EXPECT_LT(statistics.bytes, 1000000U);
    EXPECT_EQ(statistics.entropy_removed, 0.0);
  }
}

TEST(BeliefGrid, RefusesBadConfigurations) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const auto refused = [](ErrorCode code, const std::string& part, const GridConfig& config) {
    expect_error(code, part, [&] { (void)BeliefGrid(config); });
  };
  for (const double bad : {0.0, -0.01, nan, inf}) {
    refused(ErrorCode::invalid_argument, "voxel size", cube(bad, 0, 1));
    GridConfig config = cube(0.01, 0, 1);
    config.prior_sigma = bad;
    refused(ErrorCode::invalid_argument, "prior sigma", config);
  }
  for (const double bad : {nan, inf, -inf}) {
    GridConfig config = cube(0.01, 0, 1);
    config.workspace.min[1] = bad;
    refused(ErrorCode::invalid_argument, "the workspace must be finite, but along y", config);
    config = cube(0.01, 0, 1);
    config.workspace.max[2] = bad;
    refused(ErrorCode::invalid_argument, "the workspace must be finite, but along z", config);
  }
  refused(ErrorCode::invalid_argument, "inside out", cube(0.01, 1, 0));
  refused(ErrorCode::invalid_argument, "inside out", cube(0.01, 1, 1));
  refused(ErrorCode::capacity, "1e+08 voxels", cube(1e-8, 0, 1));  // 1e24 in all
  refused(ErrorCode::capacity, "voxels", cube(1e-300, 0, 1));
  refused(ErrorCode::capacity, "2.7", cube(1.0, 0, 30000));  // 2.7e13 in all
  refused(ErrorCode::capacity, "from the origin", cube(0.001, 2e6, 2e6 + 1));
  GridConfig skewed = cube(0.01, 0, 1);
  skewed.T_world_grid.m[1] = 1e-6;
  refused(ErrorCode::invalid_argument, "T_world_grid", skewed);
  skewed.T_world_grid.m[1] = nan;
  refused(ErrorCode::invalid_argument, "T_world_grid", skewed);
}

TEST(BeliefGrid, DenseStatesRoundTrip) {
  std::mt19937 random(3);
  for (const double share : {0.0, 0.001, 0.3, 1.0}) {
    for (const double low : {-0.2, 0.013, 127.3}) {
      // No multiple of 8; the low corner is anywhere.
      const GridConfig config{
          0.01, {{low, low, low}, {low + 0.37, low + 0.21, low + 0.29}}, {}, 0.01};
      const BeliefGrid empty(config);
      std::vector<std::uint8_t> states(empty.voxel_count(), 1);
      std::bernoulli_distribution other(share);
      std::uniform_int_distribution<int> which(0, 1);
      for (std::uint8_t& s : states) {
        if (other(random)) s = which(random) == 0 ? 0 : 2;
      }
      const BeliefGrid grid = BeliefGrid::from_states(config, states);
      std::vector<std::uint8_t> read(states.size(), 9);
      grid.copy_states(read);
      EXPECT_EQ(read, states);
      // The order is [x][y][z].
      std::size_t n = 0;
      std::uint64_t counts[3] = {};
      for_each_voxel(grid, [&](Index3 voxel) {
        const auto state = static_cast<std::uint8_t>(grid.state(voxel));
        ASSERT_EQ(state, states[n++]);
        ++counts[state];
      });
      const BeliefGrid::Statistics statistics = grid.statistics();
      EXPECT_EQ(statistics.unknown, counts[0]);
      EXPECT_EQ(statistics.free, counts[1]);
      EXPECT_EQ(statistics.occupied, counts[2]);
    }
  }

  std::vector<std::uint8_t> states(8, 1);
  const GridConfig config = cube(0.5, 0, 1);
  EXPECT_FLOAT_EQ(BeliefGrid::from_states(config, states).log_odds({0, 0, 0}).value(), -0.4F);
  states[3] = 2;
  EXPECT_FLOAT_EQ(BeliefGrid::from_states(config, states).log_odds({0, 1, 1}).value(), 0.85F);
  states[3] = 3;
  expect_error(ErrorCode::invalid_argument, "position 3",
               [&] { (void)BeliefGrid::from_states(config, states); });
  states.pop_back();
  expect_error(ErrorCode::invalid_argument, "array has 7 states, but the workspace has 8",
               [&] { (void)BeliefGrid::from_states(config, states); });
  expect_error(ErrorCode::invalid_argument, "array has 7 states, but the workspace has 8",
               [&] { BeliefGrid(config).copy_states(states); });
}

TEST(BeliefGrid, SetRoundsClampsAndKeepsToTheWorkspace) {
  BeliefGrid grid(cube(0.1, 0, 1));
  for (const auto& [given, kept] : {std::pair{0.0F, 0.0F},
                                    {0.024F, 0.0F},
                                    {0.026F, 0.05F},
                                    {-0.4F, -0.4F},
                                    {9.0F, 3.5F},
                                    {-9.0F, -2.0F},
                                    {3.46F, 3.45F},
                                    {std::numeric_limits<float>::infinity(), 3.5F}}) {
    grid.set({3, 4, 5}, given);
    EXPECT_FLOAT_EQ(grid.log_odds({3, 4, 5}).value(), kept);
    EXPECT_EQ(grid.state({3, 4, 5}), kept > 0 ? VoxelState::occupied : VoxelState::free);
  }
  EXPECT_EQ(grid.statistics().unknown, 999U);

  const Belief belief{{4, 5, 6, 1, 2, 3}, {7, 8, 9}, 11};
  grid.set({9, 9, 9}, 1.0F, belief);
  EXPECT_EQ(grid.belief({9, 9, 9}), belief);
  EXPECT_FALSE(grid.belief({9, 9, 8}).has_value());
  grid.set({9, 9, 9}, 1.0F);
  EXPECT_FALSE(grid.belief({9, 9, 9}).has_value());

  for (const Index3 outside :
       {Index3{-1, 0, 0}, {0, 10, 0}, {0, 0, 1 << 29}, {-2000000000, 0, 0}}) {
    EXPECT_EQ(grid.state(outside), VoxelState::unknown);
    EXPECT_FALSE(grid.log_odds(outside).has_value());
    EXPECT_FALSE(grid.belief(outside).has_value());
    expect_error(ErrorCode::invalid_argument, "outside", [&] { grid.set(outside, 1.0F); });
  }
  expect_error(ErrorCode::invalid_argument, "NaN", [&] { grid.set({0, 0, 0}, std::nanf("")); });
  Belief bad = belief;
  bad.information[2] = -1;
  expect_error(ErrorCode::invalid_argument, "-1", [&] { grid.set({0, 0, 0}, 1.0F, bad); });
  bad.information[2] = std::numeric_limits<float>::infinity();
  expect_error(ErrorCode::invalid_argument, "inf", [&] { grid.set({0, 0, 0}, 1.0F, bad); });
  EXPECT_EQ(grid.state({0, 0, 0}), VoxelState::unknown);
}

TEST(BeliefGrid, AppendedViewsAreRigid) {
  BeliefGrid grid(cube(0.1, 0, 1));
  const std::string before = grid.content_hash();
  Pose bad;
  for (const double value : {std::nan(""), std::numeric_limits<double>::infinity(), 1.01}) {
    for (const std::size_t place : {0U, 3U}) {
      if (place == 3 && value == 1.01) continue;  // a translation
      bad = Pose{};
      bad.m[place] = value;
      expect_error(ErrorCode::invalid_argument, "the camera pose is not a rigid transform",
                   [&] { grid.append_view(bad); });
    }
  }
  EXPECT_EQ(grid.content_hash(), before);
  // What a file with six digits makes of a rotation is mended, as integrators do.
  Pose close = ring_view(2);
  close.m[1] += 1e-4;
  grid.append_view(close);
  EXPECT_LT(orthonormality_error(grid.views().at(0)), 1e-12);
  grid.append_view(ring_view(3));
  EXPECT_EQ(grid.views().at(1), ring_view(3));
}

TEST(BeliefGrid, HashIsThatOfTheContents) {
  const GridConfig config{0.01, {{-0.13, -0.11, -0.2}, {0.15, 0.1, 0.02}}, {}, 0.01};
  const Belief belief{{4, 5, 6, 1, 2, 3}, {7, 8, 9}, 11};
  // The same contents, written in another order and by other ways (tiles against leaves).
  std::vector<std::uint8_t> states(BeliefGrid(config).voxel_count(), 1);
  BeliefGrid tiles = BeliefGrid::from_states(config, states);
  BeliefGrid leaves(config);
  const Index3 min = leaves.min_index(), d = leaves.dims();
  for (int i = min.x + d.x - 1; i >= min.x; --i) {
    for (int j = min.y; j < min.y + d.y; ++j) {
      for (int k = min.z; k < min.z + d.z; ++k) leaves.set({i, j, k}, -0.4F);
    }
  }
  const std::string base = tiles.content_hash();
  EXPECT_EQ(base.size(), 16U);
  EXPECT_EQ(base.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_EQ(leaves.content_hash(), base);
  EXPECT_LT(tiles.statistics().bytes, leaves.statistics().bytes);

  // Anything that differs shows.
  std::set<std::string> hashes{base};
  int cases = 1;
  const auto differs = [&](const std::function<void(BeliefGrid&)>& change) {
    BeliefGrid grid = tiles.clone();
    change(grid);
    hashes.insert(grid.content_hash());
    ++cases;
  };
  differs([](BeliefGrid& g) { g.set({0, 0, 0}, -0.45F); });
  differs([](BeliefGrid& g) { g.set({0, 0, -1}, -0.45F); });
  differs([](BeliefGrid& g) { g.set({0, 0, 0}, 0.05F); });
  differs([&](BeliefGrid& g) { g.set({0, 0, 0}, -0.4F, belief); });
  differs([&](BeliefGrid& g) { g.set({0, 0, 1}, -0.4F, belief); });
  differs([&](BeliefGrid& g) { g.set({8, 0, 0}, -0.4F, belief); });
  for (std::size_t part = 0; part < 10; ++part) {
    differs([&](BeliefGrid& g) {
      Belief other = belief;
      if (part < 6) other.information[part] += 0.5F;
      if (part >= 6 && part < 9) other.information_vector[part - 6] += 0.5F;
      if (part == 9) ++other.hits;
      g.set({0, 0, 0}, -0.4F, other);
    });
  }
  differs([](BeliefGrid& g) { g.append_view(Pose{}); });
  differs([](BeliefGrid& g) { g.append_view(ring_view(1)); });
  differs([](BeliefGrid& g) { g.append_view(Pose{}), g.append_view(Pose{}); });
  for (int what = 0; what < 4; ++what) {
    GridConfig other = config;
    if (what == 0) other.prior_sigma = 0.011;
    if (what == 1) other.T_world_grid = Pose(Eigen::Matrix3d::Identity(), {0, 0, 1e-12});
    if (what == 2) other.workspace.max[2] += 0.01;
    if (what == 3) other.voxel_size = 0.0100000001;
    states.assign(BeliefGrid(other).voxel_count(), 1);
    hashes.insert(BeliefGrid::from_states(other, states).content_hash());
    ++cases;
  }
  hashes.insert(BeliefGrid(config).content_hash());
  ++cases;
  EXPECT_EQ(hashes.size(), static_cast<std::size_t>(cases));
}

TEST(BeliefGrid, IntegratorRefusesWrongFramesAndPoses) {
  const Sensor sensor = small_sensor(8, 6);
  BeliefGrid grid(object_grid(16));
  const std::string before = grid.content_hash();
  FrameIntegrator integrator(sensor);
  expect_error(ErrorCode::invalid_argument, "6 x 8", [&] {
    integrator.integrate(grid, {6, 8, std::vector<float>(48)}, Pose{});
  });
  expect_error(ErrorCode::invalid_argument, "47 values", [&] {
    integrator.integrate(grid, {8, 6, std::vector<float>(47)}, Pose{});
  });
  const DepthFrame frame{8, 6, std::vector<float>(48, 0.5F)};
  Pose bad;
  bad.m[0] = 1.01;
  expect_error(ErrorCode::invalid_argument, "the camera pose is not a rigid transform",
               [&] { integrator.integrate(grid, frame, bad); });
  bad.m[0] = std::nan("");
  expect_error(ErrorCode::invalid_argument, "the camera pose is not a rigid transform",
               [&] { integrator.integrate(grid, frame, bad); });
  bad = Pose{};
  bad.m[3] = std::numeric_limits<double>::infinity();
  expect_error(ErrorCode::invalid_argument, "the camera pose is not a rigid transform",
               [&] { integrator.integrate(grid, frame, bad); });
  EXPECT_EQ(grid.content_hash(), before);
  // What a file with six digits makes of a rotation is mended.
  Pose close = ring_view(0);
  close.m[0] += 1e-4;
  integrator.integrate(grid, frame, close);
  EXPECT_LT(orthonormality_error(grid.views().at(0)), 1e-12);

  Sensor broken = sensor;
  broken.camera.fx = -1;
  expect_error(ErrorCode::invalid_argument, "fx", [&] { FrameIntegrator unused(broken); });
}

TEST(BeliefGrid, ReadingBoundsHoldTheReadings) {
  const Sensor sensor = small_sensor(32, 24);
  const std::vector<Sphere> ball{{{0.02, 0.01, -0.03}, 0.08}};
  const DepthFrame frame = see_spheres(sensor, ring_view(0), ball);
  const auto box = reading_bounds(sensor, frame, ring_view(0));
  ASSERT_TRUE(box.has_value());
  std::size_t readings = 0;
  std::array<bool, 6> touched{};
  for (int v = 0; v < 24; ++v) {
    for (int u = 0; u < 32; ++u) {
      if (!std::isfinite(frame.at(u, v))) continue;
      ++readings;
      const Eigen::Vector3d p = ring_view(0) * (sensor.camera.ray(u, v) * double{frame.at(u, v)});
      for (std::size_t a = 0; a < 3; ++a) {
        const double x = p[static_cast<Eigen::Index>(a)];
        EXPECT_LE(box->min[a], x + 1e-12);
        EXPECT_GE(box->max[a], x - 1e-12);
        touched[a] = touched[a] || x < box->min[a] + 1e-9;
        touched[a + 3] = touched[a + 3] || x > box->max[a] - 1e-9;
      }
    }
  }
  EXPECT_GT(readings, 20U);
  EXPECT_EQ(touched, (std::array<bool, 6>{true, true, true, true, true, true}));
  EXPECT_FALSE(
      reading_bounds(sensor, {32, 24, std::vector<float>(768, DepthFrame::kOutOfRange)}, Pose{})
          .has_value());
  // In another frame, the box is that of the turned points.
  const Pose T_world_grid(Eigen::Matrix3d::Identity(), {1, 2, 3});
  const auto moved = reading_bounds(sensor, frame, ring_view(0), T_world_grid);
  ASSERT_TRUE(moved.has_value());
  EXPECT_NEAR(moved->min[2], box->min[2] - 3, 1e-12);
}

}  // namespace
}  // namespace viewgain
