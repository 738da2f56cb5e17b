// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Which voxels a frame crosses and hits, against loops over all voxels.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <string>
#include <tuple>

#include "grid/analytic_frames.hpp"
#include "viewgain/grid/integrate.hpp"
#include "voxel_oracle.hpp"

namespace viewgain {
namespace {
using Occupancy = IntegrationConfig::Occupancy;
using Carve = IntegrationConfig::Carve;

using namespace test;

struct Setting {
  const char* name;
  GridConfig grid;
  std::array<double, 5> distortion{};
  double focal_scale = 1.0;
};

std::vector<Setting> settings() {
  const GridConfig plain{0.0125, {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}}, {}, 0.01};
  // No multiple of 8 voxels, and no corner on the lattice.
  const GridConfig odd{0.0131, {{-0.19, -0.171, -0.2}, {0.17, 0.205, 0.113}}, {}, 0.01};
  GridConfig turned = odd;
  const Eigen::Vector3d t(0.03, -0.05, 0.02);
  turned.T_world_grid =
      Pose(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix(), t);
  // The same cube of the world, described far off the grid's origin.
  GridConfig far = odd;
  const Eigen::Vector3d off(1310.0, -2620.0, 655.0);
  for (std::size_t a = 0; a < 3; ++a) {
    far.workspace.min[a] += off[static_cast<Eigen::Index>(a)];
    far.workspace.max[a] += off[static_cast<Eigen::Index>(a)];
  }
  far.T_world_grid = Pose(Eigen::Matrix3d::Identity(), -off);
  return {{"plain", plain, {}, 1.0},
          {"odd", odd, {}, 1.0},
          {"turned", turned, {}, 1.0},
          {"far", far, {}, 1.0},
          {"distorted", turned, {-0.25, 0.08, 0.002, -0.0015, -0.01}, 1.0},
          // The lens model folds back inside the field of view.
          {"folded", turned, {-0.35, 0.0, 0.0, 0.0, 0.0}, 0.42}};
}

Sensor carving_sensor(const Setting& setting, Carve carve) {
  // The oracle tests every voxel with every line, hence fewer of them.
  Sensor sensor = carve == Carve::cones ? small_sensor(32, 24) : small_sensor(10, 7);
  sensor.noise = ConstantNoise{0.006, 0.003};
  sensor.max_range = 1.52;
  sensor.camera.fx *= setting.focal_scale;
  sensor.camera.fy *= setting.focal_scale;
  sensor.camera.distortion = setting.distortion;
  return sensor;
}

/// A view of the object; every fourth from inside the workspace.
Pose carving_view(int i) {
  if (i % 4 != 3) return ring_view(i);
  return look_at({0.15, -0.12, 0.08}, {-0.05, 0.02, 0.0});
}

class Carving : public testing::TestWithParam<std::tuple<Carve, Occupancy>> {
 protected:
  IntegrationConfig config_{std::get<0>(GetParam()), std::get<1>(GetParam())};
};

TEST_P(Carving, EqualsLoopsOverAllVoxels) {
  std::mt19937 random(11);
  int cases = 0;
  const bool literal = config_.occupancy == Occupancy::literal;
  for (const Setting& setting : settings()) {
    // Literal occupancy differs in the last step only: fewer settings do.
    if (literal && setting.name != std::string("turned") && setting.name != std::string("folded"))
      continue;
    const Sensor sensor = carving_sensor(setting, config_.carve);
    BeliefGrid grid(setting.grid);
    VoxelOracle oracle(grid);
    FrameIntegrator integrator(sensor, config_, {2});
    for (int view = 0; view < 4; ++view) {
      const Pose pose = carving_view(view);
      const DepthFrame frame = mixed_frame(sensor, pose, random);
      const IntegrationReport report = integrator.integrate(grid, frame, pose);
      oracle.integrate(sensor, frame, pose, config_);
      EXPECT_EQ(oracle.differences(grid), 0U) << setting.name << ", view " << view;
      EXPECT_EQ(report.voxels_crossed, oracle.crossed()) << setting.name << ", view " << view;
      EXPECT_EQ(report.voxels_hit, oracle.hit()) << setting.name << ", view " << view;
      EXPECT_GT(oracle.crossed(), oracle.voxels() / 200);
      EXPECT_EQ(report.readings + report.out_of_range + report.invalid, frame.depth.size());
      ++cases;
    }
    const BeliefGrid::Statistics statistics = grid.statistics();
    EXPECT_EQ(statistics.unknown + statistics.free + statistics.occupied, oracle.voxels());
  }
  EXPECT_EQ(cases, literal ? 8 : 24);
}

INSTANTIATE_TEST_SUITE_P(
    AllRules, Carving,
    testing::Combine(testing::Values(Carve::cones, Carve::lines),
                     testing::Values(Occupancy::probabilistic, Occupancy::literal)),
    [](const auto& test) {
      return std::string(std::get<0>(test.param) == Carve::cones ? "Cones" : "Lines") +
             (std::get<1>(test.param) == Occupancy::literal ? "Literal" : "Probabilistic");
    });

// Large blocks are judged as a whole; what decides must not show.
TEST(Carving, ManyVoxelsAPixelAndManyPixelsAVoxel) {
  for (const auto& [width, n] : {std::pair{8, 48}, std::pair{96, 12}}) {
    Sensor sensor = small_sensor(width, width * 3 / 4);
    sensor.noise = ConstantNoise{0.002, 0.002};
    BeliefGrid grid(object_grid(n));
    VoxelOracle oracle(grid);
    FrameIntegrator integrator(sensor, {}, {1});
    for (int view = 0; view < 2; ++view) {
      const DepthFrame frame = see_spheres(sensor, ring_view(view), three_spheres_in_a_room());
      integrator.integrate(grid, frame, ring_view(view));
      oracle.integrate(sensor, frame, ring_view(view), {});
      EXPECT_EQ(oracle.differences(grid), 0U) << width << " px, " << n << " voxels";
    }
  }
  // A lens model that folds inside the image, and voxels on both sides of the fold.
  Sensor folded = small_sensor(28, 20);
  folded.noise = ConstantNoise{0.002, 0.002};
  folded.camera.fx = folded.camera.fy = 9.0;
  folded.camera.distortion = {-0.35, 0, 0, 0, 0};
  BeliefGrid grid(object_grid(48));
  VoxelOracle oracle(grid);
  const Pose corner(Eigen::Matrix3d::Identity(), {-0.16, -0.15, -0.1});
  const DepthFrame frame = see_spheres(folded, corner, {{{0, 0, 0}, 1.4}});
  FrameIntegrator(folded).integrate(grid, frame, corner);
  oracle.integrate(folded, frame, corner, {});
  EXPECT_EQ(oracle.differences(grid), 0U);
}

TEST(Carving, ThreeKindsOfPixel) {
  Sensor sensor = small_sensor(8, 6);
  sensor.camera.cx = 4;  // the ray of pixel (4, 3) is the z axis
  sensor.camera.cy = 3;
  sensor.min_range = 0.3;
  sensor.max_range = 0.55;
  const GridConfig config{0.005, {{-0.02, -0.02, 0.1}, {0.02, 0.02, 0.7}}, {}, 0.01};
  const Pose pose;  // looks along +z
  const auto column = [&](float depth) {
    BeliefGrid grid(config);
    DepthFrame frame{8, 6, std::vector<float>(48, depth)};
    const IntegrationReport report = FrameIntegrator(sensor).integrate(grid, frame, pose);
    std::string states;
    for (int k = grid.min_index().z; k < grid.min_index().z + grid.dims().z; ++k) {
      states += ".fo"[static_cast<int>(grid.state({0, 0, k}))];
    }
    return std::tuple(states, report.readings, report.out_of_range, report.invalid);
  };
  const std::size_t all = 120;  // voxels of 5 mm between 0.1 and 0.7
  const auto line = [&](std::size_t free, std::size_t occupied) {
    return std::string(free, 'f') + std::string(occupied, 'o') +
           std::string(all - free - occupied, '.');
  };
  const std::string nothing(all, '.');
  // A reading carves what lies before it, also nearer than min_range, and says nothing beyond.
  EXPECT_EQ(column(0.4025F), std::tuple(line(60, 1), 48U, 0U, 0U));
  // Out of range carves up to max_range: the last centre within 0.55 is at 0.5475.
  EXPECT_EQ(column(DepthFrame::kOutOfRange), std::tuple(line(90, 0), 0U, 48U, 0U));
  EXPECT_EQ(column(0.6F), std::tuple(line(90, 0), 0U, 48U, 0U));
  for (const float invalid : {DepthFrame::kInvalid, -1.0F, std::nanf(""), 0.25F}) {
    EXPECT_EQ(column(invalid), std::tuple(nothing, 0U, 0U, 48U)) << invalid;
  }
  // A centre at max_range itself is crossed.
  const double x = 0.5 * 0.005, z = 109.5 * 0.005;
  sensor.max_range = std::sqrt(x * x + x * x + z * z);
  EXPECT_EQ(column(DepthFrame::kOutOfRange), std::tuple(line(90, 0), 0U, 48U, 0U));
  sensor.max_range = std::nextafter(sensor.max_range, 0.0);
  EXPECT_EQ(column(DepthFrame::kOutOfRange), std::tuple(line(89, 0), 0U, 48U, 0U));
}

}  // namespace
}  // namespace viewgain
