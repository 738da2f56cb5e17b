// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

#include "viewgain/raycast/suspect_frames.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/planner/registration_scene.hpp"
#include "core/expect_error.hpp"
#include "support/meshes.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/planner/simulated_acquisition.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain {
namespace {

Pose turned(const Pose& pose, const Eigen::Quaterniond& turn) {
  return {pose.rotation() * turn.toRotationMatrix(), pose.translation()};
}

Pose w_first(const Pose& pose) {
  const Eigen::Quaterniond q(pose.rotation());
  return {Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y()).toRotationMatrix(), pose.translation()};
}

// An orbit round a lumpy ball, of which all sides look alike from afar.
using Change = std::function<Pose(const Pose&)>;

// Of `kind`, what is suspected of poses that were changed so.
template <typename Kind>
void expect_other_conventions(const Kind& kind) {
  EXPECT_EQ(kind([](const Pose& T) { return T.inverse(); }), "world_to_camera");
  EXPECT_EQ(kind(w_first), "quaternion_order");
  EXPECT_EQ(kind([](const Pose& T) { return turned(T, {0.5, 0.5, -0.5, 0.5}); }), "body_frame");
  EXPECT_EQ(kind([](const Pose& T) { return turned(T, {0, 1, 0, 0}); }), "upward_camera");
  EXPECT_EQ(kind([](const Pose& T) {
              return Pose{T.rotation(), 1000 * T.translation()};
            }),
            "pose_millimetres");
}

class SuspectFrames : public testing::Test {
 protected:
  SuspectFrames() {
    sensor_.camera = {64, 48, 60, 60, 31.5, 23.5};
    sensor_.noise = ConstantNoise{0.002, 0.002};
    see(orbit_poses(6, 0.5, 0.6));
  }

  void see(const std::vector<Pose>& poses) {
    static const auto ball = std::make_shared<const SurfaceScene>(test::bumpy_sphere(0.12, 0.008));
    const SimulatedSensor camera(ball, sensor_, {}, {1});
    poses_ = poses;
    frames_.clear();
    for (const Pose& pose : poses) frames_.push_back(camera.acquire(pose, frames_.size()));
  }

  [[nodiscard]] std::string what() const { return suspect_frames(sensor_, frames_, poses_).what; }
  [[nodiscard]] std::string kind(const std::function<Pose(const Pose&)>& change = {}) const {
    std::vector<Pose> poses = poses_;
    if (change) {
      for (Pose& pose : poses) pose = change(pose);
    }
    return suspect_frames(sensor_, frames_, poses).kind;
  }

  // Each depth times a factor and a power of the ray's length at depth 1.
  void scale(double factor, double power) {
    const auto rays = sensor_.camera.ray_table();
    for (DepthFrame& frame : frames_) {
      for (std::size_t i = 0; i < rays.size(); ++i) {
        frame.depth[i] *= static_cast<float>(factor * std::pow(rays[i].norm(), power));
      }
    }
  }

  Sensor sensor_ = sensor_preset("sr4000");
  std::vector<Pose> poses_;
  std::vector<DepthFrame> frames_;
};

TEST_F(SuspectFrames, PosesOfOtherConventions) {
  for (const std::size_t views : {6, 9, 14}) {
    see(orbit_poses(views, 0.5, 0.6));
    SCOPED_TRACE(views);
    EXPECT_EQ(kind(), "");
    expect_other_conventions([&](const Change& change) { return kind(change); });
  }
}

TEST_F(SuspectFrames, DepthsInOtherUnits) {
  for (const std::string factor : {"2", "2.5", "4", "5", "10", "1000"}) {
    const std::vector<DepthFrame> right = frames_;
    scale(std::stod(factor), 0);
    EXPECT_NE(what().find("the correct depth scale is " + factor + " times smaller"),
              std::string::npos)
        << factor << what();
    frames_ = right;
    scale(1 / std::stod(factor), 0);
    EXPECT_NE(what().find("the correct depth scale is " + factor + " times larger"),
              std::string::npos)
        << factor << what();
    frames_ = right;
  }
}

// Only frames that meet can tell which of the scales is meant that bring depths into range.
TEST_F(SuspectFrames, WhatFitsAlikeIsNamed) {
  see(orbit_poses(1, 0.5, 0.6));
  scale(20, 0);
  for (const std::string factor : {"2", "4", "5", "10"}) {
    EXPECT_NE(what().find("the correct depth scale is " + factor + " times smaller"),
              std::string::npos)
        << factor << what();
  }
}

TEST_F(SuspectFrames, DepthsAlongTheRay) {
  scale(1, 1);
  EXPECT_EQ(kind(), "depth_along_ray");
}

// Boxes of other sides and places, as one mesh.
TriangleMesh boxes(const std::vector<std::array<double, 6>>& all) {
  TriangleMesh mesh;
  for (const auto& [x, y, z, a, b, c] : all) {
    const TriangleMesh cube = test::cube_mesh(0.5);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& v : cube.vertices) {
      mesh.vertices.push_back({x + a * v[0], y + b * v[1], z + c * v[2]});
    }
    for (const auto& t : cube.triangles) {
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }
  return mesh;
}

// What is rendered by one camera and read by another: the stated focal length times the factor is
// the right one.
TEST(SuspectFocalLengths, AreNamedAndRightOnesAreNot) {
  const std::vector<TriangleMesh> objects{
      test::bumpy_sphere(0.12, 0.008), test::bumpy_sphere(0.1, 0.02),
      boxes({{0, 0, -0.05, 0.25, 0.12, 0.06}, {0.05, 0.02, 0.05, 0.06, 0.06, 0.2}}),
      boxes({{0, 0, -0.12, 0.8, 0.8, 0.02}, {-0.06, 0, -0.04, 0.1, 0.14, 0.14}}),
      test::cylinder(0.07, 0.25)};
  struct View {
    PinholeCamera camera;
    double distance, elevation, sigma;
    std::size_t count;
  };
  const std::vector<View> setups{{{64, 48, 60, 60, 31.5, 23.5}, 0.5, 0.6, 0.002, 6},
                                 {{88, 72, 100, 100, 44, 35}, 0.6, 0.4, 0.003, 9},
                                 {{80, 60, 70, 72, 39, 30}, 0.7, 0.9, 0.001, 12}};
  std::size_t right = 0, wrong = 0, alarms = 0, told = 0, named = 0, beside = 0;
  for (const TriangleMesh& object : objects) {
    const auto scene = std::make_shared<const SurfaceScene>(object);
    for (const View& view : setups) {
      Sensor sensor = sensor_preset("sr4000");
      sensor.camera = view.camera;
      sensor.noise = ConstantNoise{view.sigma, view.sigma};
      const SimulatedSensor camera(scene, sensor, {.noise = true}, {1});
      const std::vector<Pose> poses = orbit_poses(view.count, view.distance, view.elevation);
      std::vector<DepthFrame> frames;
      for (const Pose& pose : poses) frames.push_back(camera.acquire(pose, frames.size()));
      for (const char* factor : {"1", "0.5", "0.75", "0.9", "1.1", "1.25", "2"}) {
        Sensor stated = sensor;
        stated.camera.fx /= std::stod(factor);
        stated.camera.fy /= std::stod(factor);
        const Suspicion found = suspect_frames(stated, frames, poses);
        if (std::stod(factor) == 1) {
          ++right;
          alarms += found.kind.empty() ? 0 : 1;
          EXPECT_EQ(found.kind, "") << right << found.what;
          continue;
        }
        ++wrong;
        const std::string words = std::string("the correct focal length is ") + factor + " times";
        const bool is_named = found.what.find(words) != std::string::npos;
        told += found.kind == "focal_length" ? 1 : 0;
        named += is_named ? 1 : 0;
        beside += is_named && found.what.find(", or ") != std::string::npos ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(right, 15U);
  EXPECT_EQ(alarms, 0U);
  EXPECT_EQ(wrong, 90U);
  EXPECT_GE(told, 89U);
  EXPECT_GE(named, 85U);  // the others: a neighbouring factor
  EXPECT_LE(beside, 3U);
}

// Cameras that move across their axes see a relief as half as wide by twice the focal length as by
// half the depth: both are named.
TEST(SuspectFocalLengths, WhatFitsAsWellAsADepthScaleIsNamedBesideIt) {
  std::vector<std::array<double, 6>> relief{{0, 0, -0.05, 2, 2, 0.02}};
  for (int i = 0; i < 25; ++i) {
    relief.push_back({0.14 * (i % 5 - 2), 0.13 * (i / 5 - 2), 0, 0.05 + 0.01 * (i % 3), 0.06,
                      0.04 + 0.02 * (i * 7 % 5)});
  }
  const auto scene = std::make_shared<const SurfaceScene>(boxes(relief));
  Sensor sensor = sensor_preset("sr4000");
  sensor.camera = {88, 72, 100, 100, 43.5, 35.5};
  sensor.noise = ConstantNoise{0.002, 0.002};
  const SimulatedSensor camera(scene, sensor, {.noise = true}, {1});
  std::vector<Pose> poses;
  std::vector<DepthFrame> frames;
  for (int i = 0; i < 9; ++i) {
    const Eigen::Vector3d eye(0.09 * (i % 3 - 1), 0.08 * (i / 3 - 1), 0.7);
    poses.push_back(look_at(eye, eye - Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY()));
    frames.push_back(camera.acquire(poses.back(), frames.size()));
  }
  EXPECT_EQ(suspect_frames(sensor, frames, poses).kind, "");
  std::size_t cases = 0;
  for (const auto& [factor, words] :
       {std::pair{"2", "2 times smaller"}, {"0.5", "2 times larger"}}) {
    Sensor stated = sensor;
    stated.camera.fx /= std::stod(factor);
    stated.camera.fy /= std::stod(factor);
    const Suspicion found = suspect_frames(stated, frames, poses);
    EXPECT_NE(found.what.find(std::string("the correct focal length is ") + factor + " times"),
              std::string::npos)
        << found.what;
    EXPECT_NE(found.what.find(std::string("the correct depth scale is ") + words),
              std::string::npos)
        << found.what;
    ++cases;
  }
  EXPECT_EQ(cases, 2U);
}

TEST_F(SuspectFrames, IntrinsicsOfHalfTheResolution) {
  sensor_.camera.cx /= 2, sensor_.camera.cy /= 2;
  EXPECT_EQ(kind(), "principal_point");
  sensor_.camera.cx *= 2 * 424 / 320.0, sensor_.camera.cy *= 2 * 424 / 320.0;
  EXPECT_EQ(kind(), "principal_point");
}

TEST_F(SuspectFrames, DistortionThatLeavesFewPixels) {
  sensor_.camera.distortion = {-5, 0, 0, 0, 0};
  EXPECT_EQ(kind(), "distortion");
}

// From one place frames agree however poses are read; that is for no reading and against none.
TEST_F(SuspectFrames, CamerasInOnePlaceSayNothing) {
  std::vector<Pose> poses;
  for (int i = -4; i <= 4; ++i) {
    const Eigen::AngleAxisd pan(0.05 * i, Eigen::Vector3d::UnitY());
    poses.push_back(turned(poses_.front(), Eigen::Quaterniond(pan)));
  }
  see(poses);
  EXPECT_EQ(kind(), "");
}

TEST_F(SuspectFrames, OnePoseAFrame) {
  frames_[3].depth.pop_back();
  test::expect_error(ErrorCode::invalid_argument, "", [&] { (void)kind(); });
  poses_.pop_back();
  test::expect_error(ErrorCode::invalid_argument, "one pose per frame", [&] { (void)kind(); });
}

TEST(SuspectPoses, WhatSeesNoVoxelOfTheMap) {
  Sensor sensor = sensor_preset("sr4000");
  sensor.camera = {64, 48, 60, 60, 31.5, 23.5};
  const BeliefGrid grid({0.02, {{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}}, {}, 0.02});
  const auto scene = VoxelScene::build(grid);
  const auto kind = [&](const std::function<Pose(const Pose&)>& change) {
    std::vector<Pose> poses = sphere_poses(150, 0.5);
    for (Pose& pose : poses) pose = change(pose);
    return suspect_poses(scene, sensor, poses).kind;
  };
  EXPECT_EQ(kind([](const Pose& T) { return T; }), "");
  expect_other_conventions(kind);
  EXPECT_EQ(kind([](const Pose& T) {
              return Pose{T.rotation(), T.translation() + 9 * Eigen::Vector3d::UnitX()};
            }),
            "no_voxel");
  EXPECT_EQ(suspect_poses(scene, sensor, {}).kind, "");
}

const Pose kPose = look_at({0.3, -0.4, 0.2}, {0, 0, 0});

TEST(PoseNoise, TheFirstViewIsExact) {
  EXPECT_EQ(reported_pose(kPose, 0, {0.01, 0.1}, 3), kPose);
  EXPECT_EQ(reported_pose(kPose, 5, {0, 0}, 3), kPose);
}

TEST(PoseNoise, TheOthersAreOffByTheSigmasInEachPart) {
  constexpr std::size_t kViews = 4000;
  constexpr double kShift = 0.01, kTurn = 0.02;
  Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Matrix<double, 6, 6> squares = Eigen::Matrix<double, 6, 6>::Zero();
  for (std::size_t view = 1; view <= kViews; ++view) {
    const Pose pose = reported_pose(kPose, view, {kShift, kTurn}, 7);
    EXPECT_LT(orthonormality_error(pose), 1e-12);
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(pose.rotation() * kPose.rotation().transpose()));
    Eigen::Matrix<double, 6, 1> d;
    d << (pose.translation() - kPose.translation()) / kShift, turn.angle() * turn.axis() / kTurn;
    sum += d;
    squares += d * d.transpose();
  }
  // Five standard errors.
  const double few = 5 / std::sqrt(static_cast<double>(kViews));
  EXPECT_LT((sum / kViews).cwiseAbs().maxCoeff(), few);
  EXPECT_LT((squares / kViews - Eigen::Matrix<double, 6, 6>::Identity()).cwiseAbs().maxCoeff(),
            std::sqrt(2.0) * few);
}

TEST(PoseNoise, SeedAndViewFixIt) {
  const PoseSigma sigma{0.01, 0.02};
  EXPECT_EQ(reported_pose(kPose, 3, sigma, 1), reported_pose(kPose, 3, sigma, 1));
  EXPECT_NE(reported_pose(kPose, 3, sigma, 1), reported_pose(kPose, 4, sigma, 1));
  EXPECT_NE(reported_pose(kPose, 3, sigma, 1), reported_pose(kPose, 3, sigma, 2));
}

TEST(PoseNoise, BadSigmasAreRefusedByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  test::expect_error(ErrorCode::invalid_argument, "sigma_translation", [] {
    (void)reported_pose(kPose, 1, {-1, 0}, 1);
  });
  test::expect_error(ErrorCode::invalid_argument, "sigma_rotation", [&] {
    (void)reported_pose(kPose, 0, {0, nan}, 1);
  });
}

}  // namespace
}  // namespace viewgain
