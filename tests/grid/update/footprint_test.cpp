// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Frames into leaves whose scale goes by the pixels' footprint.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "core/expect_error.hpp"
#include "grid/analytic_frames.hpp"
#include "grid/voxels.hpp"
#include "viewgain/grid/fused_points.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain {
namespace {

using namespace test;
using Occupancy = IntegrationConfig::Occupancy;
using Carve = IntegrationConfig::Carve;

Sensor sharp_sensor(int width, int height) {
  Sensor sensor = small_sensor(width, height);
  sensor.noise = ConstantNoise{.sigma_axial = 1e-4, .sigma_lateral = 1e-4};
  return sensor;
}

// Where all leaves have one scale the map is that of the larger voxels, bit for bit, but that free
// blocks become tiles of their least sure voxel, and that none is made for the rim of an image.
TEST(Footprint, LeavesOfOneScaleAreTheMapOfLargerVoxels) {
  const Sensor sensor = sharp_sensor(10, 8);  // 7 voxels and more a pixel
  int maps = 0;
  std::uint64_t cells = 0, beliefs = 0, less_sure = 0;
  std::size_t points = 0, differ = 0;
  for (const Carve carve : {Carve::cones, Carve::lines}) {
    for (const Occupancy occupancy : {Occupancy::probabilistic, Occupancy::literal}) {
      for (int scale = 0; scale <= 3; ++scale) {
        BeliefGrid fine(object_grid(128)), large(object_grid(128 >> scale));
        FrameIntegrator into_fine(sensor, {carve, occupancy, {}, scale});
        FrameIntegrator into_large(sensor, {carve, occupancy});
        for (int i = 0; i < 10; ++i) {  // the first view three times, so that there are points
          const Pose pose = ring_view(std::max(i - 2, 0));
          const DepthFrame frame = see_spheres(sensor, pose, three_spheres_in_a_room());
          const auto of_fine = into_fine.integrate(fine, frame, pose);
          const auto of_large = into_large.integrate(large, frame, pose);
          ASSERT_EQ(of_fine.voxels_hit, of_large.voxels_hit);
          ASSERT_EQ(of_fine.readings_inside, of_large.readings_inside);
          if (i != 2) continue;  // then what is free by less evidence is occupied by fewer hits
          ASSERT_EQ(fine.mean_sigma(fine.workspace()), large.mean_sigma(large.workspace()));
          for (const bool per_voxel : {false, true}) {
            auto own = fused_points(fine, {.per_voxel = per_voxel});
            auto other = fused_points(large, {.per_voxel = per_voxel});
            ASSERT_EQ(own.size(), other.size());
            // Leaves of other sizes come in another order.
            const auto order = [](const FusedPoint& a, const FusedPoint& b) {
              return a.position < b.position;
            };
            std::sort(own.begin(), own.end(), order);
            std::sort(other.begin(), other.end(), order);
            for (std::size_t k = 0; k < own.size(); ++k) {
              // Where states differ, as below, so may the side of a voxel, what is pooled and the
              // order of sums.
              const bool same = own[k].position == other[k].position &&
                                own[k].covariance == other[k].covariance &&
                                own[k].toward_free == other[k].toward_free;
              ASSERT_TRUE(same || !per_voxel);
              if (!same) ++differ;
            }
            points += own.size();
          }
        }
        std::uint64_t wrong = 0;
        for_each_voxel(large, [&](Index3 v) {
          const Index3 low{v.x << scale, v.y << scale, v.z << scale};
          ++cells;
          const std::optional<float> own = fine.log_odds(low), other = large.log_odds(v);
          if (own == other) return;
          const bool is_cautious = own ? own > other : large.state(v) == VoxelState::free;
          ++(scale > 0 && is_cautious ? less_sure : wrong);
        });
        // A ray along the faces between voxels may be walked otherwise.
        EXPECT_LE(wrong, carve == Carve::cones ? 0U : 2U) << scale;
        std::uint64_t seen = 0;
        large.for_each_belief([&](Index3 v, const Belief& belief) {
          ASSERT_EQ(fine.belief({v.x << scale, v.y << scale, v.z << scale}), belief);
          ++seen;
        });
        fine.for_each_belief([&](Index3 v, const Belief&) {
          ASSERT_EQ(fine.scale(v), scale);
          --seen;
        });
        EXPECT_EQ(seen, 0U);
        beliefs += large.statistics().hits;
        ++maps;
      }
    }
  }
  EXPECT_EQ(maps, 16);
  EXPECT_GT(cells, 5'000'000U);
  EXPECT_GT(less_sure, 10'000U);
  EXPECT_GT(points, 200U);
  EXPECT_LE(differ, points / 50);
  EXPECT_GT(beliefs, 1000U);
}

/// Frames of a sphere of 10 cm from far off, then from near.
struct Approach {
  Approach() {
    config.coarsest = 3;
    for (const double distance : {2.4, 1.9, 1.2, 0.35, 0.3}) {
      for (int i = 0; i < 3; ++i) {
        poses.push_back(
            look_at(ring_view(i).translation() * distance / 0.6, Eigen::Vector3d::Zero()));
        frames.push_back(see_spheres(sensor, poses.back(), {ball}));
      }
    }
  }
  Sensor sensor = sharp_sensor(120, 90);
  Sphere ball{{0, 0, 0}, 0.1};
  IntegrationConfig config;
  std::vector<Pose> poses;
  std::vector<DepthFrame> frames;
};

TEST(Footprint, ANearerLookRefinesAndLosesNoReading) {
  const Approach approach;
  BeliefGrid grid(GridConfig{0.004, {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}}, {}, 0.01});
  FrameIntegrator integrator(approach.sensor, approach.config);
  std::uint64_t readings = 0;
  std::map<std::tuple<int, int, int>, int> scales;
  std::array<int, 4> first{}, last{};
  int finer = 0;
  for (std::size_t i = 0; i < approach.frames.size(); ++i) {
    readings += integrator.integrate(grid, approach.frames[i], approach.poses[i]).readings_inside;
    ASSERT_EQ(grid.statistics().hits, readings);
    last = {};
    grid.for_each_belief([&](Index3 v, const Belief&) {
      const int scale = grid.scale(v);
      const auto [held, is_new] = scales.try_emplace({v.x >> 3, v.y >> 3, v.z >> 3}, scale);
      ASSERT_LE(scale, held->second);
      finer += scale < held->second ? 1 : 0;
      held->second = scale;
      ++last[static_cast<std::size_t>(scale)];
    });
    if (i == 0) first = last;
  }
  EXPECT_EQ(first[0] + first[1], 0);  // 2.3 m / 122 px are 4.7 voxels
  EXPECT_GT(first[2] + first[3], 20);
  EXPECT_GT(last[0], 500);
  EXPECT_GT(finer, 50);
  // No halo where it was refined: what is occupied lies at the sphere, but for half a cell.
  std::uint64_t occupied = 0;
  grid.for_each_occupied([&](const BeliefGrid::VoxelValue& at) {
    const int scale = grid.scale(at.voxel);
    const double off = voxel_center(at.voxel, 0.004, scale).norm() - approach.ball.radius;
    EXPECT_LT(std::abs(off), 0.004 * (1 << scale)) << scale;
    ++occupied;
  });
  EXPECT_GT(occupied, 500U);
}

TEST(Footprint, FineBoxesStayFineAndThreadsDoNotMatter) {
  Approach approach;
  approach.config.fine = {{{0, -1, -1}, {0.02, 1, 1}}};
  std::string hash;
  for (const int threads : {1, 2, 5}) {
    BeliefGrid grid(GridConfig{0.004, {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}}, {}, 0.01});
    FrameIntegrator integrator(approach.sensor, approach.config, {.num_threads = threads});
    for (std::size_t i = 0; i < 6; ++i) {
      (void)integrator.integrate(grid, approach.frames[i], approach.poses[i]);
    }
    std::array<int, 2> inside{}, outside{};
    grid.for_each_belief([&](Index3 v, const Belief&) {
      const bool touches = v.x >> 3 == 0;
      ++(touches ? inside : outside)[grid.scale(v) > 0 ? 1 : 0];
    });
    EXPECT_GT(inside[0], 20);
    EXPECT_EQ(inside[1], 0);
    EXPECT_GT(outside[1], 20);
    if (hash.empty()) hash = grid.content_hash();
    EXPECT_EQ(grid.content_hash(), hash);
  }
}

// A room roughly, what stands in it precisely, from however near.
TEST(Footprint, LeavesAreNoFinerThanAskedOutsideTheBoxes) {
  Approach approach;
  approach.config.fine = {{{0, -1, -1}, {0.02, 1, 1}}};
  approach.config.finest = 2;
  BeliefGrid grid(GridConfig{0.004, {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}}, {}, 0.01});
  FrameIntegrator integrator(approach.sensor, approach.config);
  for (std::size_t i = 0; i < approach.frames.size(); ++i) {
    (void)integrator.integrate(grid, approach.frames[i], approach.poses[i]);
  }
  std::array<int, 4> inside{}, outside{};
  grid.for_each_belief([&](Index3 v, const Belief&) {
    ++(v.x >> 3 == 0 ? inside : outside)[static_cast<std::size_t>(grid.scale(v))];
  });
  EXPECT_GT(inside[0], 100);
  EXPECT_EQ(inside[1] + inside[2] + inside[3], 0);
  EXPECT_EQ(outside[0] + outside[1], 0);
  EXPECT_GT(outside[2], 20);
}

TEST(Footprint, ScalesDoNotGoToAndFroAtAThreshold) {
  // A wall of one leaf's width; its nearest point is at the range t, the footprint t / f.
  Sensor sensor = sharp_sensor(64, 48);
  sensor.camera.fx = sensor.camera.fy = 64;
  sensor.camera.cx = 31.5, sensor.camera.cy = 23.5;
  const double V = 0.01;
  FrameIntegrator integrator(sensor, {.coarsest = 3});
  const auto look = [&](BeliefGrid& grid, double voxels_a_pixel) {
    const double t = voxels_a_pixel * V * 64;
    DepthFrame frame{64, 48, std::vector<float>(64 * 48, static_cast<float>(t + 0.045))};
    (void)integrator.integrate(grid, frame, Pose(Eigen::Matrix3d::Identity(), {0.04, 0.04, -t}));
    return grid.scale({4, 4, 4});
  };
  const auto map = [&] {
    return BeliefGrid(GridConfig{V, {{0, 0, 0}, {0.08, 0.08, 0.08}}, {}, 0.01});
  };
  int looks = 0;
  for (int k = 0; k < 3; ++k) {
    const double threshold = 1.5 * (1 << k);
    BeliefGrid below = map(), above = map();
    EXPECT_EQ(look(below, threshold * 0.99), k);
    EXPECT_EQ(look(below, threshold * 1.5), k);  // never coarser by itself
    EXPECT_EQ(look(above, threshold * 1.01), k + 1);
    EXPECT_EQ(look(above, threshold * 0.82), k + 1);
    EXPECT_EQ(look(above, threshold * 0.78), k);
    looks += 5;
  }
  EXPECT_EQ(looks, 15);
}

TEST(Footprint, CloudsHaveScalesToo) {
  const Sensor sensor = sharp_sensor(16, 12);
  BeliefGrid grid(object_grid(128));
  CloudIntegrator integrator(sensor, {.coarsest = 2});
  std::vector<std::array<double, 3>> points;
  for (int i = 0; i < 400; ++i)
    points.push_back({-0.1 + 0.01 * (i % 20), -0.1 + 0.01 * (i / 20), 0});
  const auto report =
      integrator.integrate(grid, points, Pose(Eigen::Matrix3d::Identity(), {0, 0, -0.6}));
  EXPECT_EQ(report.readings_inside, 400U);
  EXPECT_EQ(grid.statistics().hits, 400U);
  EXPECT_EQ(grid.scale(*grid.index_of({0, 0, 0})), 2);
}

TEST(Footprint, WrongSettingsAreRefused) {
  const Sensor sensor = small_sensor(16, 12);
  for (const int coarsest : {-1, 4}) {
    expect_error(ErrorCode::invalid_argument,
                 "the coarsest scale must be in 0..3, not " + std::to_string(coarsest),
                 [&] { FrameIntegrator(sensor, {.coarsest = coarsest}); });
  }
  for (const int finest : {-1, 2}) {
    expect_error(ErrorCode::invalid_argument,
                 "the finest scale must be between 0 and the coarsest scale, 1, not " +
                     std::to_string(finest),
                 [&] { FrameIntegrator(sensor, {.coarsest = 1, .finest = finest}); });
  }
  for (const double end : {0.0, -1.0, std::nan("")}) {
    expect_error(ErrorCode::invalid_argument, "box for fine voxels", [&] {
      FrameIntegrator(sensor, {.fine = {{{0, 0, 0}, {1, end, 1}}}});
    });
  }
}

}  // namespace
}  // namespace viewgain
