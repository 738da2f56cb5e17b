// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Both sides of thin walls, however unequally they were seen, with noise and flying pixels.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "box_frames.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/fused_points.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain {
namespace {

using namespace test;
using Eigen::Vector3d;

constexpr double kVoxel = 0.005;   // [m]
constexpr double kNoise = 0.001;   // along a ray [m]
constexpr double kDistance = 0.4;  // of the cameras [m]

// How much of the two faces z = +-half.z has points, away from the rim.
struct Seen {
  std::size_t places = 0;  // on each face
  std::size_t above = 0, below = 0;
  std::size_t between = 0;  // points further than half a voxel from the face on their side
  std::size_t points = 0;
};

Seen look_for_faces(const BeliefGrid& grid, const FusedPointsConfig& config, double height,
                    double inner) {
  std::array<std::vector<Vector3d>, 2> faces;
  Seen seen;
  for (const FusedPoint& point : fused_points(grid, config)) {
    const Vector3d p(point.position[0], point.position[1], point.position[2]);
    if (std::max(std::abs(p.x()), std::abs(p.y())) > inner) continue;
    ++seen.points;
    const double side = point.toward_free[2] > 0 ? 1 : -1;
    if (std::abs(p.z() - side * height) > 0.5 * kVoxel) {
      ++seen.between;
    } else {
      faces[side > 0 ? 0 : 1].push_back(p);
    }
  }
  for (double x = -inner + kVoxel / 2; x < inner; x += kVoxel) {
    for (double y = -inner + kVoxel / 2; y < inner; y += kVoxel) {
      const auto has = [&](const std::vector<Vector3d>& points) {
        return std::any_of(points.begin(), points.end(), [&](const Vector3d& p) {
          return std::hypot(p.x() - x, p.y() - y) <= kVoxel;
        });
      };
      ++seen.places;
      seen.above += has(faces[0]) ? 1 : 0;
      seen.below += has(faces[1]) ? 1 : 0;
    }
  }
  return seen;
}

// A plate of 16 x 16 cm in z = 0, seen so often from above and below, at this angle from its
// normal.
BeliefGrid plate(double thickness, int above, int below, double slant) {
  const Sensor sensor = box_camera(kNoise);
  BeliefGrid grid({kVoxel, {{-0.13, -0.13, -0.06}, {0.13, 0.13, 0.06}}, {}, 0.01});
  FrameIntegrator integrator(sensor);
  std::mt19937_64 random(11);
  for (int i = 0; i < above + below; ++i) {
    const double side = i < above ? 1 : -1, turn = 2.4 * i, lean = slant + 0.02 * (i % 5);
    const Vector3d eye(kDistance * std::sin(lean) * std::cos(turn),
                       kDistance * std::sin(lean) * std::sin(turn),
                       side * kDistance * std::cos(lean));
    const Pose pose = look_at(eye, {0.002 * (i % 7), 0, 0}, {std::cos(turn), std::sin(turn), 0.1});
    integrator.integrate(grid, see_box(sensor, pose, {0.08, 0.08, thickness / 2}, random), pose);
  }
  return grid;
}

TEST(ThinWalls, BothFacesOfAPlateArePoints) {
  std::size_t cases = 0;
  for (const double voxels : {1.5, 2.0, 3.0, 5.0}) {
    for (const auto& [above, below] : {std::pair{6, 6}, {4, 20}, {2, 60}}) {
      for (const double slant : {0.0, std::numbers::pi / 3}) {
        const double height = voxels * kVoxel / 2;
        const Seen seen = look_for_faces(plate(2 * height, above, below, slant), {}, height, 0.05);
        const std::string what = std::to_string(voxels) + " voxels, " + std::to_string(above) +
                                 ":" + std::to_string(below) + ", " + std::to_string(slant);
        const auto places = static_cast<double>(seen.places);
        EXPECT_GE(static_cast<double>(seen.above), 0.97 * places) << what;
        EXPECT_GE(static_cast<double>(seen.below), 0.97 * places) << what;
        EXPECT_LE(static_cast<double>(seen.between), 0.01 * static_cast<double>(seen.points))
            << what;
        ++cases;
      }
    }
  }
  EXPECT_EQ(cases, 24U);
}

// The walls of a hollow box: a plate is one of them, and cameras stand inside and outside.
TEST(ThinWalls, InnerAndOuterFaceOfABoxArePoints) {
  constexpr double kHalf = 0.06;  // to the wall's middle [m]
  for (const double voxels : {2.0, 3.0}) {
    const double t = voxels * kVoxel / 2;
    const Sensor sensor = box_camera(kNoise);
    BeliefGrid grid({kVoxel, {{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}}, {}, 0.01});
    FrameIntegrator integrator(sensor);
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 72; ++i) {
      Vector3d way = Vector3d::Zero();
      way[i % 3] = i / 3 % 2 == 0 ? 1 : -1;
      const Vector3d beside = 0.002 * Vector3d(normal(random), normal(random), normal(random));
      const bool inside = i % 24 < 6;  // 1 : 3
      const Vector3d up(0.3, 0.5, 0.8);
      const Pose pose = inside ? look_at(beside - 0.04 * way, way, up)
                               : look_at(beside + 0.3 * way, {0, 0, 0}, up);
      DepthFrame frame{sensor.camera.width, sensor.camera.height, {}};
      for (const Vector3d& ray : sensor.camera.ray_table()) {
        const Vector3d along = pose.rotation() * ray;
        const double depth =
            inside ? range_to_box(pose.translation(), along, Vector3d::Constant(kHalf - t), true)
                   : std::min(range_to_box(pose.translation(), along, Vector3d::Constant(kHalf + t),
                                           false),
                              2.0);
        frame.depth.push_back(static_cast<float>(depth + kNoise * normal(random) / ray.norm()));
      }
      integrator.integrate(grid, frame, pose);
    }
    std::size_t inner = 0, outer = 0, others = 0;
    for (const FusedPoint& point : fused_points(grid)) {
      const Eigen::Array3d p =
          Eigen::Array3d(point.position[0], point.position[1], point.position[2]).abs();
      // Away from the edges, where a wall has one face.
      if (std::count_if(p.begin(), p.end(), [](double v) { return v < 0.035; }) != 2) continue;
      const double r = p.maxCoeff();
      if (std::abs(r - kHalf + t) < 0.5 * kVoxel) {
        ++inner;
      } else if (std::abs(r - kHalf - t) < 0.5 * kVoxel) {
        ++outer;
      } else {
        ++others;
      }
    }
    const double places = 6 * std::pow(0.07 / kVoxel, 2);  // voxels on a face
    EXPECT_GT(static_cast<double>(inner), 0.85 * places) << voxels;
    EXPECT_GT(static_cast<double>(outer), 0.85 * places) << voxels;
    EXPECT_LT(static_cast<double>(others), 0.005 * places) << voxels;
  }
}

}  // namespace
}  // namespace viewgain
