// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

#include "viewgain/raycast/suspect_set_up.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/planner/registration_scene.hpp"
#include "core/expect_error.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/planner/register_frame.hpp"
#include "viewgain/raycast/obstacle_view.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"
#include "viewgain/raycast/suspect_frames.hpp"

namespace viewgain {
namespace {

std::string kinds(const std::vector<Suspicion>& all) {
  std::string text;
  for (const Suspicion& suspicion : all) text += (text.empty() ? "" : " ") + suspicion.kind;
  return text;
}

std::string kinds(const Sensor& sensor) { return kinds(suspect_sensor(sensor, 0.01)); }

// A preset as calibration and a robot's manual complete it.
Sensor completed(Sensor sensor) {
  sensor.pose_sigma = kUsualPoseSigma;
  sensor.scale_sigma = 0.005;
  sensor.body_size = {0.2, 0.15, 0.3};
  sensor.T_flange_camera = Pose(Eigen::Matrix3d::Identity(), {0.05, 0.02, 0.25});
  for (int i = 0; i < 10; ++i) {
    const double measured = sensor.min_range + i * (sensor.max_range - sensor.min_range) / 9;
    sensor.range_calibration.table.push_back({measured, 0.02 * std::sin(i) * measured});
  }
  return sensor;
}

TEST(SuspectSensor, SaysNothingOfSensorsAtUsualVoxelSizes) {
  for (const std::string& name : sensor_preset_names()) {
    const Sensor preset = sensor_preset(name);
    for (const Sensor& sensor : {preset, completed(preset)}) {
      EXPECT_EQ(kinds(suspect_sensor(sensor)), "") << name;
      for (const double voxel : {0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1}) {
        EXPECT_EQ(kinds(suspect_sensor(sensor, voxel)), "") << name << " " << voxel;
      }
    }
  }
  // A camera of a wide view, and a scanner of halls.
  Sensor wide = sensor_preset("azure_kinect_nfov");
  wide.camera = {512, 512, 252.0, 252.0, 255.5, 255.5};
  EXPECT_EQ(kinds(wide), "");
  Sensor scanner;
  scanner.camera = {1024, 64, 580.0, 580.0, 511.5, 31.5};
  scanner.max_range = 120;
  scanner.working_distance = 15;
  scanner.noise = ConstantNoise{0.02, 0.03};
  EXPECT_EQ(kinds(suspect_sensor(scanner, 0.1)), "");
}

TEST(SuspectSensor, NamesTheUnitThatIsWrong) {
  struct Slip {
    const char* preset;
    std::function<void(Sensor&)> make;
    const char* kind;
    const char* part;  // of the sentence
  };
  const auto noise_of = []<typename Noise>(Noise noise) {
    return [noise](Sensor& sensor) { sensor.noise = noise; };
  };
  const std::vector<Slip> slips{
      {"d435", [](Sensor& s) { s.camera.fx = s.camera.fy = 1.93; }, "field_of_view", "pixels"},
      {"sr4000", [](Sensor& s) { s.camera.fy = 8; }, "field_of_view", "fy = 8"},
      {"sr4000", [](Sensor& s) { s.min_range = 200, s.max_range = 5000, s.working_distance = 400; },
       "range_unit", "200 to 5000"},
      {"sr4000", [](Sensor& s) { s.min_range = 20, s.max_range = 250, s.working_distance = 40; },
       "range_unit", "voxels wide"},
      {"sr4000", noise_of(ConstantNoise{2.0, 0.0005}), "noise_unit", "sigma_axial"},
      {"sr4000", noise_of(ConstantNoise{0.002, 0.5}), "noise_unit", "sigma_lateral"},
      {"sr4000", noise_of(ConstantNoise{0.2, 0.0005}), "noise_unit", "0.2 m, 50 %"},
      {"sr4000", noise_of(ShotNoise{.reference_sigma = 4}), "noise_unit", "reference_sigma"},
      {"sr4000", noise_of(ShotNoise{.reference_range = 1300}), "noise_unit", "reference_range"},
      {"sr4000", noise_of(ShotNoise{.integration_time = 1.0}), "time_unit", "integration_time = 1"},
      {"sr4000", noise_of(ShotNoise{.reference_integration_time = 8.5}), "time_unit", "seconds"},
      {"sr4000", noise_of(ShotNoise{.modulation_frequency = 30}), "frequency_unit", "30 Hz"},
      {"kinect_v1", noise_of(StructuredLightNoise{.offset = 1.2}), "noise_unit", "offset"},
      {"kinect_v1", noise_of(StructuredLightNoise{.quadratic = 1.9}), "noise_unit", "quadratic"},
      {"kinect_v1", noise_of(StructuredLightNoise{.vertex = 400}), "noise_unit", "vertex"},
      {"kinect_v1", noise_of(StructuredLightNoise{.grazing = 3.2}), "noise_unit", "grazing"},
      {"azure_kinect_nfov", noise_of(QuadraticNoise{.offset = 1.0}), "noise_unit", "offset"},
      {"azure_kinect_nfov", noise_of(QuadraticNoise{.quadratic = 1.074}), "noise_unit", "1/m"},
      {"d435", noise_of(StereoNoise{.baseline = 50}), "noise_unit", "baseline = 50"},
      {"d435", noise_of(StereoNoise{.focal = 1.93}), "noise_unit", "focal = 1.93"},
      {"d435",
       [](Sensor& s) {
         s.pose_sigma = {5, 0.5};
       },
       "pose_sigma_unit", "5 m"},
      {"d435",
       [](Sensor& s) {
         s.pose_sigma = {0.005, 0.5};
       },
       "pose_sigma_unit", "28.65 degrees"},
      {"d435",
       [](Sensor& s) {
         s.pose_sigma = {0.3, 0.005};
       },
       "pose_sigma_unit", "0.3 m"},
      {"d435", [](Sensor& s) { s.scale_sigma = 0.5; }, "scale_sigma", "50 %"},
      {"d435",
       [](Sensor& s) {
         s.range_calibration.table = {{200, 1}, {3000, 9}};
       },
       "calibration_unit", "200 m"},
      {"d435",
       [](Sensor& s) {
         s.range_calibration.table = {{0.2, -1}, {3, -9}};
       },
       "calibration_unit", "-1 m"},
      {"d435",
       [](Sensor& s) {
         s.body_size = {90, 25, 25};
       },
       "body_unit", "90 x 25 x 25 m"},
      {"d435",
       [](Sensor& s) {
         s.T_flange_camera = Pose(Eigen::Matrix3d::Identity(), {50, 20, 250});
       },
       "mounting_unit", "255.7 m"}};
  for (const Slip& slip : slips) {
    Sensor sensor = sensor_preset(slip.preset);
    slip.make(sensor);
    sensor.validate();  // else nobody would have to be warned
    EXPECT_EQ(kinds(sensor), slip.kind) << slip.part;
    const std::vector<Suspicion> all = suspect_sensor(sensor, 0.01);
    if (all.empty()) continue;
    EXPECT_NE(all[0].what.find(slip.part), std::string::npos) << all[0].what;
  }
}

TEST(SuspectSensor, SeveralSlipsAreAllNamed) {
  Sensor sensor = sensor_preset("d435");
  sensor.body_size = {90, 25, 25};
  sensor.pose_sigma = {5, 0.5};
  sensor.noise = ConstantNoise{2, 2};
  EXPECT_EQ(kinds(sensor), "noise_unit pose_sigma_unit body_unit");
}

TEST(SuspectSensor, FramesAreNotBlamedForItsIntrinsics) {
  Sensor sensor = sensor_preset("sr4000");
  sensor.camera.fx = sensor.camera.fy = 4.2;
  const DepthFrame frame{176, 144, std::vector<float>(std::size_t{176} * 144, 1.0F)};
  const std::vector<DepthFrame> frames(3, frame);
  const std::vector<Pose> poses = orbit_poses(3, 0.5, 0.6);
  EXPECT_EQ(suspect_frames(sensor, frames, poses).kind, "field_of_view");
}

// A map of half a metre.
class SuspectSetUp : public testing::Test {
 protected:
  BeliefGrid map{GridConfig{.voxel_size = 0.01, .prior_sigma = 0.01}};
  Sensor sensor = sensor_preset("sr4000");  // sees to 5 m
};

TEST_F(SuspectSetUp, ObstaclesPlanesAndSizes) {
  const auto obstacle = [&](const Box& box) { return suspect_obstacle(box, map, sensor).kind; };
  EXPECT_EQ(obstacle({{-2, -2, -1}, {2, 2, -0.9}}), "");
  EXPECT_EQ(obstacle({{9, 0, 0}, {9.1, 1, 1}}), "");
  EXPECT_EQ(obstacle({{900, 0, 0}, {950, 50, 50}}), "obstacle_unit");
  EXPECT_EQ(obstacle({{-300, -300, -1}, {300, 300, -0.9}}), "obstacle_unit");
  const auto plane = [&](double z) { return suspect_support_plane(z, map, sensor).kind; };
  for (const double z : {-0.3, 0.0, 0.3, -2.0}) EXPECT_EQ(plane(z), "") << z;
  for (const double z : {-250.0, 80.0}) EXPECT_EQ(plane(z), "plane_unit") << z;
  const auto size = [&](double longest) { return suspect_object_size(longest, map).kind; };
  for (const double longest : {0.02, 0.35, 2.0}) EXPECT_EQ(size(longest), "") << longest;
  for (const double longest : {350.0, 35.0, 0.00035}) {
    EXPECT_EQ(size(longest), "object_size_unit") << longest;
  }
  EXPECT_EQ(suspect_clearance(0.05).kind, "");
  EXPECT_EQ(suspect_clearance(20).kind, "clearance_unit");
}

TEST_F(SuspectSetUp, Workspaces) {
  EXPECT_EQ(suspect_workspace(map, sensor).kind, "");
  const BeliefGrid hall({0.1, {{-50, -50, 0}, {50, 50, 10}}, {}, 0.05});
  EXPECT_EQ(suspect_workspace(hall, sensor).kind, "");
  const BeliefGrid of_millimetres({5, {{-300, -300, -300}, {300, 300, 300}}, {}, 0.05});
  EXPECT_EQ(suspect_workspace(of_millimetres, sensor).kind, "workspace_unit");
}

TEST_F(SuspectSetUp, ReachRegions) {
  const auto kind = [&](const ReachRegion& reach) {
    return suspect_reach(reach, map, sensor).kind;
  };
  ReachRegion reach;
  EXPECT_EQ(kind(reach), "");
  // In metres and, by `unit` 1000, in millimetres. A region round the map is always near.
  const auto box = [](double unit) {
    return Box{{0.4 * unit, -0.5 * unit, 0}, {unit, 0.5 * unit, unit}};
  };
  for (const auto& [unit, expected] : {std::pair(1.0, ""), std::pair(1000.0, "reach_unit")}) {
    EXPECT_EQ(kind({.boxes = {box(unit)}}), expected);
    EXPECT_EQ(kind({.boxes = {box(unit), box(2 * unit)}}), expected);
    EXPECT_EQ(kind({.shells = {{Eigen::Vector3d::Zero(), 0.3 * unit, 0.9 * unit}}}), expected);
    EXPECT_EQ(kind({.shells = {{Eigen::Vector3d(0.5, 0, 0.2) * unit, 0, 0.3 * unit}}}), expected);
    EXPECT_EQ(kind({.half_spaces = {{Eigen::Vector3d(0, 0, 2), 0.8 * unit}}}), expected);
    EXPECT_EQ(kind({.poses = {look_at(Eigen::Vector3d(0.5, 0, 0.5) * unit, {0, 0, 0})}}), expected);
  }
}

// Walls round a room whose camera was inside.
TEST_F(SuspectSetUp, ViewsInSolidObstacles) {
  const std::vector<Pose> views = orbit_poses(4, 1.0, 0.3);
  const auto kind = [&](const Obstacles& obstacles, std::span<const Pose> of) {
    return suspect_solid_obstacles(obstacles, of).kind;
  };
  const Box room{{-2, -2, -2}, {2, 2, 2}};
  const TriangleMesh closed = mesh_of({{room}, {}});
  TriangleMesh open = closed;
  open.triangles.pop_back();
  EXPECT_EQ(kind({{room}, {}}, views), "views_in_obstacle");
  EXPECT_EQ(kind({{}, {closed}}, views), "views_in_obstacle");
  EXPECT_EQ(kind({{}, {open}}, views), "");
  EXPECT_EQ(kind({{{{-2, -2, -2}, {2, 2, -1.9}}}, {}}, views), "");
  EXPECT_EQ(kind({{room}, {}}, {}), "");
  EXPECT_EQ(kind({}, views), "");
  std::vector<Pose> mostly_outside = orbit_poses(4, 4.0, 0.3);
  mostly_outside.push_back(views[0]);
  EXPECT_EQ(kind({{room}, {}}, mostly_outside), "");
}

// A lumpy ball of 0.24 m in the middle of the map.
class SuspectReadings : public testing::Test {
 protected:
  SuspectReadings() {
    sensor.camera = {64, 48, 60, 60, 31.5, 23.5};
    const auto ball = std::make_shared<const SurfaceScene>(test::bumpy_sphere(0.12, 0.008));
    const SimulatedSensor camera(ball, sensor, {.background_radius = 1.5}, {1});
    for (const Pose& pose : poses) frames.push_back(camera.acquire(pose, frames.size()));
  }

  [[nodiscard]] std::string kind(std::size_t i, const Pose& pose, double factor = 1) const {
    DepthFrame frame = frames[i];
    for (float& z : frame.depth) z *= static_cast<float>(factor);
    return suspect_frame(sensor, frame, pose, map).kind;
  }

  // The frames without the pixels that `takes` says, by (frame, pixel).
  template <typename Takes>
  [[nodiscard]] Suspicion masked(const Takes& takes, const BeliefGrid* of) const {
    std::vector<DepthFrame> left = frames;
    for (std::size_t k = 0; k < left.size(); ++k) {
      for (std::size_t i = 0; i < left[k].depth.size(); ++i) {
        if (takes(k, i)) left[k].depth[i] = DepthFrame::kInvalid;
      }
    }
    return suspect_masks(sensor, frames, left, poses, of);
  }
  [[nodiscard]] bool is_object(std::size_t k, std::size_t i) const {
    const auto z = static_cast<double>(frames[k].depth[i]);
    return z > 0 && z < 0.8;
  }

  BeliefGrid map{GridConfig{.voxel_size = 0.01, .prior_sigma = 0.01}};
  BeliefGrid room{GridConfig{0.05, {{-2, -2, -2}, {2, 2, 2}}, {}, 0.01}};
  Sensor sensor = sensor_preset("sr4000");
  std::vector<Pose> poses = orbit_poses(6, 0.6, 0.6);
  std::vector<DepthFrame> frames;
};

TEST_F(SuspectReadings, AFrameOfAnotherConvention) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Pose& T = poses[i];
    EXPECT_EQ(kind(i, T), "");
    EXPECT_EQ(kind(i, T.inverse()), "world_to_camera");
    EXPECT_EQ(kind(i, {T.rotation(), 1000 * T.translation()}), "pose_millimetres");
    EXPECT_EQ(kind(i, T, 1000), "depth_scale");
    // No mistake that is known: somewhere else.
    EXPECT_EQ(kind(i, {T.rotation(), T.translation() + Eigen::Vector3d(0, 9, 0)}), "");
    Pose lost = T;
    lost.m[0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(kind(i, lost), "");
  }
  const DepthFrame empty{64, 48, std::vector<float>(frames[0].depth.size(), 0.0F)};
  EXPECT_EQ(suspect_frame(sensor, empty, poses[0].inverse(), map).kind, "");
  test::expect_error(ErrorCode::invalid_argument, "64", [&] {
    (void)suspect_frame(sensor, DepthFrame{2, 2, {1, 1, 1, 1}}, poses[0], map);
  });
}

TEST_F(SuspectReadings, MasksThatTakeTheObject) {
  const auto object = [&](std::size_t k, std::size_t i) { return is_object(k, i); };
  for (const BeliefGrid* of : {&map, &room}) {
    const Suspicion suspicion = masked(object, of);
    EXPECT_EQ(suspicion.kind, "masks");
    EXPECT_NE(suspicion.what.find("invert the masks"), std::string::npos) << suspicion.what;
  }
  EXPECT_EQ(masked([](auto, auto) { return true; }, &room).kind, "masks");
  EXPECT_EQ(masked([](auto, auto) { return true; }, nullptr).kind, "masks");
}

TEST_F(SuspectReadings, MasksThatAreMeantAsTheyAre) {
  const auto arm = [](auto, std::size_t i) { return i / 64 >= 32; };
  const auto background = [&](std::size_t k, std::size_t i) { return !is_object(k, i); };
  const auto none = [](auto, auto) { return false; };
  const auto all_but_a_spot = [](auto, std::size_t i) {
    return std::abs(static_cast<int>(i % 64) - 32) > 6 ||
           std::abs(static_cast<int>(i / 64) - 24) > 5;
  };
  for (const BeliefGrid* of : std::initializer_list<const BeliefGrid*>{&map, &room, nullptr}) {
    EXPECT_EQ(masked(arm, of).kind, "");
    EXPECT_EQ(masked(background, of).kind, "");
    EXPECT_EQ(masked(none, of).kind, "");
    EXPECT_EQ(masked(all_but_a_spot, of).kind, "");
  }
  EXPECT_EQ(suspect_masks(sensor, {}, {}, {}).kind, "");
}

TEST_F(SuspectReadings, PosesThatLookAway) {
  const GridSnapshot snapshot = map.snapshot();
  const auto is_away = [&](const std::function<Pose(const Pose&)>& change, std::size_t count) {
    std::vector<Pose> changed = orbit_poses(6, 0.6, 0.3);
    for (std::size_t i = 0; i < count; ++i) changed[i] = change(changed[i]);
    return mostly_look_away(snapshot, sensor, changed);
  };
  const auto inverse = [](const Pose& T) { return T.inverse(); };
  const auto far = [](const Pose& T) {
    return Pose{T.rotation(), T.translation() - 6 * T.rotation().col(2)};  // out of range
  };
  for (const auto& change : std::vector<std::function<Pose(const Pose&)>>{inverse, far}) {
    EXPECT_FALSE(is_away(change, 0));
    EXPECT_FALSE(is_away(change, 3));
    EXPECT_TRUE(is_away(change, 4));
    EXPECT_TRUE(is_away(change, 6));
  }
  EXPECT_FALSE(mostly_look_away(snapshot, sensor, {}));
  const std::vector<Pose> inside{Pose()};
  EXPECT_FALSE(mostly_look_away(snapshot, sensor, inside));
}

}  // namespace
}  // namespace viewgain
