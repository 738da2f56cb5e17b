// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What a frame shows of new surface: planes whose area is known, and a frame of random readings
// against a count by hand.
#include "scorer/realised_area.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "apps/planner/planner_scene.hpp"
#include "core/expect_error.hpp"

namespace viewgain {
namespace {

using detail::RealisedArea;

constexpr double kVoxel = 0.005;
constexpr double kEye = 0.4;  // above the plane z = 0 [m]

ThreadPool& threads(int count = 3) {
  static ThreadPool one(1), three(3);
  return count == 1 ? one : three;
}

BeliefGrid empty_map(double half = 0.3) {
  return BeliefGrid(test::model_config(test::half_sr4000(), half, kVoxel).map.grid());
}

// Looks straight down at the plane z = 0.
Pose from_above() { return look_at({0, 0, kEye}, {0, 0, 0}); }

// How much less than from the working distance readings say: they miss the surface by σ_ax.
double worth(const Sensor& sensor, double range) {
  const auto misses = [&](double t) { return 1 + sensor.noise_sigmas(t).axial / kVoxel; };
  return misses(sensor.working_distance) / misses(range);
}

// All pixels read a plane across the optical axis.
DepthFrame plane_frame(const Sensor& sensor, double depth) {
  const auto pixels = static_cast<std::size_t>(sensor.camera.width * sensor.camera.height);
  return {sensor.camera.width,
          sensor.camera.height,
          std::vector<float>(pixels, static_cast<float>(depth)),
          {}};
}

TEST(RealisedArea, APlaneSeenFrontallyFillsItsArea) {
  Sensor sensor = test::half_sr4000();
  // Under 3°, so that area across the ray is area of the plane.
  sensor.camera.fx *= 8, sensor.camera.fy *= 8;
  const PinholeCamera& c = sensor.camera;
  const double area = c.width * kEye / c.fx * (c.height * kEye / c.fy);
  const RealisedArea realised(sensor, kVoxel);
  EXPECT_NEAR(realised.of(plane_frame(sensor, kEye), from_above(), empty_map(), nullptr, threads()),
              area, 2e-3 * area);
  // Seen from the side, by the wide camera, what counts is what lies across the rays.
  const Sensor wide = test::half_sr4000();
  double across = 0;
  for (const Eigen::Vector3d& ray : wide.camera.ray_table()) {
    across += kEye * kEye / (wide.camera.fx * wide.camera.fy) / ray.norm() *
              worth(wide, kEye * ray.norm());
  }
  EXPECT_NEAR(RealisedArea(wide, kVoxel)
                  .of(plane_frame(wide, kEye), from_above(), empty_map(), nullptr, threads()),
              across, 1e-8);
}

TEST(RealisedArea, NothingIsShownByWhatIsNoReading) {
  const Sensor sensor = test::half_sr4000();
  const RealisedArea realised(sensor, kVoxel);
  const BeliefGrid grid = empty_map();
  for (const float depth :
       {DepthFrame::kInvalid, DepthFrame::kOutOfRange, std::numeric_limits<float>::quiet_NaN(),
        -0.4F, 0.1F, 5.5F, 0.9F}) {  // nearer and farther than it measures, beside the workspace
    EXPECT_EQ(realised.of(plane_frame(sensor, depth), from_above(), grid, nullptr, threads()), 0)
        << depth;
  }
  test::expect_error(ErrorCode::invalid_argument, "6 values", [&] {
    (void)realised.of({3, 2, std::vector<float>(6, 0.4F), {}}, from_above(), grid, nullptr,
                      threads());
  });
}

TEST(RealisedArea, WhatIsKnownShowsNothing) {
  const Sensor sensor = test::half_sr4000();
  const RealisedArea realised(sensor, kVoxel);
  const BeliefGrid grid = empty_map();
  DepthFrame frame = plane_frame(sensor, kEye);
  const double all = realised.of(frame, from_above(), grid, nullptr, threads());
  // The left half of the image is known: at the reading, behind it and clearly before.
  const std::size_t pixels = frame.depth.size();
  for (const auto& [before, share] : {std::pair(0.0F, 0.5), {-0.1F, 0.5}, {0.2F, 1.0}}) {
    frame.known_depth.assign(pixels, DepthFrame::kOutOfRange);
    for (std::size_t i = 0; i < pixels; ++i) {
      if (i % static_cast<std::size_t>(frame.width) < static_cast<std::size_t>(frame.width) / 2) {
        frame.known_depth[i] = frame.depth[i] + before;
      }
    }
    EXPECT_NEAR(realised.of(frame, from_above(), grid, nullptr, threads()), share * all, 0.01 * all)
        << before;
  }
}

Belief hit(std::uint32_t hits) { return {{1e6F, 1e6F, 1e6F, 0.F, 0.F, 0.F}, {}, hits}; }

// Hazard cells of one voxel.
HazardProbe fine_hazard(const BeliefGrid& grid) {
  HazardConfig config;
  config.model = HazardConfig::Model{20, 4 * kVoxel, 0.5};
  return HazardProbe(grid.snapshot(), config);
}

TEST(RealisedArea, TheSupportPlaneIsNotSurface) {
  const Sensor sensor = test::half_sr4000();
  const BeliefGrid grid = empty_map();
  const double sigma = sensor.sigmas(kEye).axial;
  for (const double above : {-0.01, 0.0, 2.5 * sigma, 4.5 * sigma}) {
    const DepthFrame frame = plane_frame(sensor, kEye - above);
    const double with =
        RealisedArea(sensor, kVoxel, 0.0).of(frame, from_above(), grid, nullptr, threads());
    const double without =
        RealisedArea(sensor, kVoxel).of(frame, from_above(), grid, nullptr, threads());
    EXPECT_GT(without, 0);
    EXPECT_EQ(with, above > 3 * sigma ? without : 0.0) << above;
  }
}

/// The voxels from a point on, in units of voxels, and how far the line goes in each: by sorting
/// where it crosses planes.
std::vector<std::pair<Index3, double>> voxels_along(const Eigen::Vector3d& from,
                                                    const Eigen::Vector3d& along, double length) {
  std::vector<double> crossings{0, length};
  for (int a = 0; a < 3; ++a) {
    const double end = from[a] + length * along[a];
    for (double plane = std::ceil(std::min(from[a], end)); plane <= std::max(from[a], end);
         plane += 1) {
      crossings.push_back((plane - from[a]) / along[a]);
    }
  }
  std::sort(crossings.begin(), crossings.end());
  std::vector<std::pair<Index3, double>> all;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    if (!(crossings[i] < crossings[i + 1])) continue;
    const Eigen::Vector3d p = from + 0.5 * (crossings[i] + crossings[i + 1]) * along;
    all.push_back({{static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y())),
                    static_cast<int>(std::floor(p.z()))},
                   crossings[i + 1] - crossings[i]});
  }
  return all;
}

/// The cosine by which a ray would come to known surface from behind; 0: it would not.
double cosine_from_behind(const BeliefGrid& grid, const Eigen::Vector3d& point,
                          const Eigen::Vector3d& along) {
  constexpr double kFar = 200;  // [voxels]
  const Eigen::Vector3d at = point / kVoxel;
  const auto inside = [&](Index3 v) {
    const Index3 low = grid.min_index(), n = grid.dims();
    return v.x >= low.x && v.y >= low.y && v.z >= low.z && v.x < low.x + n.x && v.y < low.y + n.y &&
           v.z < low.z + n.z;
  };
  double length = 0;
  std::optional<Index3> end;
  for (const auto& [voxel, part] : voxels_along(at, along, kFar)) {
    if (!inside(voxel) || grid.state(voxel) == VoxelState::free) return 0;
    if (grid.state(voxel) == VoxelState::occupied) {
      end = voxel;
      break;
    }
    length += part;
  }
  if (!end) return 0;
  bool is_own = length == 0;  // the occupied voxel that the reading is in
  for (const auto& [voxel, part] : voxels_along(at, -along, kFar)) {
    if (std::exchange(is_own, false)) continue;
    if (!inside(voxel) || grid.state(voxel) != VoxelState::unknown) break;
    length += part;
  }
  if (length < 2) return 0;
  Eigen::Vector3d outward = Eigen::Vector3d::Zero();
  const auto even = [](int i) { return 2 * static_cast<int>(std::floor(i / 2.0)); };
  for (int x = -2; x < 4; ++x) {
    for (int y = -2; y < 4; ++y) {
      for (int z = -2; z < 4; ++z) {
        const Index3 v{even(end->x) + x, even(end->y) + y, even(end->z) + z};
        if (!inside(v) || grid.state(v) == VoxelState::occupied) continue;
        const auto side = [](int i) { return i < 0 ? -1 : i > 1 ? 1 : 0; };
        const Eigen::Vector3d to(side(x), side(y), side(z));
        outward += grid.state(v) == VoxelState::free ? to : -to;
      }
    }
  }
  const double cosine = outward.norm() > 0 ? outward.normalized().dot(along) : 0;
  return cosine > 0.2 ? cosine : 0;
}

// The outer side of a thin wall whose inner side is known: its readings are next to known surface.
TEST(RealisedArea, TheOtherSideOfAThinWallIsNew) {
  const Sensor sensor = test::half_sr4000();
  const RealisedArea realised(sensor, kVoxel);
  // The wall is known at z = 0, from below, where all is free.
  BeliefGrid grid = empty_map();
  const Index3 low = grid.min_index(), n = grid.dims();
  for (int x = low.x; x < low.x + n.x; ++x) {
    for (int y = low.y; y < low.y + n.y; ++y) {
      grid.set({x, y, -1}, 0.85F, hit(5));
      for (int z = low.z; z < -1; ++z) grid.set({x, y, z}, -0.4F);
    }
  }
  const HazardProbe hazard = fine_hazard(grid);
  const BeliefGrid unknown = empty_map();
  for (const double above : {0.001, 0.004, 0.02}) {  // of the other side over z = 0 [m]
    const DepthFrame frame = plane_frame(sensor, kEye - above);
    const double all = realised.of(frame, from_above(), unknown, nullptr, threads());
    const double behind = realised.of(frame, from_above(), grid, &hazard, threads());
    // More than across the rays, which are slanted by up to 28 degrees.
    EXPECT_GT(behind, all) << above;
    EXPECT_LT(behind, 1.1 * all) << above;
  }
}

TEST(RealisedArea, IsWhatAnOracleCounts) {
  std::mt19937_64 random(5);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  Sensor sensor = test::half_sr4000();
  sensor.camera.distortion = {-0.1, 0.02, 0.001, -0.001, 0};
  const RealisedArea realised(sensor, kVoxel);
  const std::vector<Eigen::Vector3d> rays = sensor.camera.ray_table();
  const std::vector<double> angles = sensor.camera.solid_angles(rays);
  std::size_t new_readings = 0, known = 0, near = 0, behind = 0;
  int maps = 0;
  for (; maps < 20; ++maps) {
    BeliefGrid grid = empty_map(0.1);
    std::vector<Index3> evidence;
    for (int i = 0; i < 4000; ++i) {
      const auto coordinate = [&] { return static_cast<int>(std::floor(uniform(-20, 20))); };
      const Index3 voxel{coordinate(), coordinate(), coordinate()};
      if (grid.state(voxel) != VoxelState::unknown) continue;
      const bool occupied = uniform(0, 1) < 0.05;
      const auto hits = static_cast<std::uint32_t>(1 + i % 5);
      occupied ? grid.set(voxel, 0.85F, hit(hits)) : grid.set(voxel, -0.4F);
      if (occupied && hits >= 3) evidence.push_back(voxel);
    }
    const HazardProbe hazard = fine_hazard(grid);
    const Pose pose = look_at({uniform(-0.2, 0.2), uniform(-0.2, 0.2), 0.4}, {0, 0, 0});
    DepthFrame frame = plane_frame(sensor, 0);
    for (float& z : frame.depth) z = static_cast<float>(uniform(0.25, 0.6));
    double expected = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Eigen::Vector3d p = rays[i] * static_cast<double>(frame.depth[i]);
      if (p.norm() < sensor.min_range || p.norm() > sensor.max_range) continue;
      const auto voxel = grid.index_of(pose * p);
      if (!voxel) continue;
      const double across = angles[i] * p.squaredNorm() * worth(sensor, p.norm());
      const Eigen::Vector3d along = (pose.rotation() * rays[i]).normalized();
      const double cosine =
          grid.state(*voxel) == VoxelState::free ? 0 : cosine_from_behind(grid, pose * p, along);
      if (cosine > 0) {
        ++behind;
        expected += across / std::max(cosine, 0.35);
        continue;
      }
      if (grid.state(*voxel) != VoxelState::unknown) {
        ++known;
        continue;
      }
      bool is_near = false;
      for (const Index3& e : evidence) {
        const int dx = e.x - voxel->x, dy = e.y - voxel->y, dz = e.z - voxel->z;
        is_near = is_near || dx * dx + dy * dy + dz * dz <= 1;
      }
      if (is_near) {
        ++near;
        continue;
      }
      ++new_readings;
      expected += across;
    }
    const double area = realised.of(frame, pose, grid, &hazard, threads());
    EXPECT_NEAR(area, expected, 1e-9 * expected);
    EXPECT_EQ(realised.of(frame, pose, grid, &hazard, threads(1)), area);
  }
  EXPECT_EQ(maps, 20);
  EXPECT_GT(new_readings, 5000U);
  EXPECT_GT(known, 100U);
  EXPECT_GT(near, 100U);
  EXPECT_GT(behind, 400U);
}

}  // namespace
}  // namespace viewgain
