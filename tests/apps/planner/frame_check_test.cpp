// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/frame_check.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "core/expect_error.hpp"
#include "support/meshes.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/planner/simulated_acquisition.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"
#include "viewgain/raycast/surface_scene.hpp"
#include "viewgain/raycast/view_scorer.hpp"

namespace viewgain {
namespace {

// A table with things on it, one of which may stand elsewhere.
TriangleMesh table(double moved = 0) {
  const std::vector<std::array<double, 6>> boxes{{0, 0, -0.22, 0.9, 0.9, 0.04},
                                                 {0, 0, -0.1, 0.2, 0.24, 0.2},
                                                 {0.25, 0.1 + moved, -0.12, 0.12, 0.1, 0.16},
                                                 {-0.25, -0.15, -0.15, 0.1, 0.14, 0.1},
                                                 {-0.1, 0.3, -0.05, 0.3, 0.06, 0.3}};
  TriangleMesh mesh;
  for (const auto& [x, y, z, a, b, c] : boxes) {
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

Sensor camera() {
  Sensor sensor = sensor_preset("sr4000");
  sensor.camera = {96, 72, 90, 90, 47.5, 35.5};
  sensor.noise = ConstantNoise{0.003, 0.001};
  return sensor;
}

Pose on_arc(double k) {
  const double a = 0.2 * k - 1;
  return look_at({0.7 * std::cos(a), 0.7 * std::sin(a), 0.35 + 0.05 * std::sin(3 * a)},
                 {0.02, 0.03, -0.05});
}

constexpr std::size_t kFrames = 12;

struct Taken {
  std::vector<DepthFrame> frames;
  std::vector<Pose> poses;
};

Taken taken(const Sensor& sensor, std::uint64_t seed, double moved = 0) {
  SimulationConfig config;
  config.noise = config.lateral_noise = true;
  config.seed = seed;
  const SimulatedSensor before(std::make_shared<const SurfaceScene>(table()), sensor, config, {1});
  const SimulatedSensor after(std::make_shared<const SurfaceScene>(table(moved)), sensor, config,
                              {1});
  Taken all;
  for (std::size_t i = 0; i < kFrames; ++i) {
    all.poses.push_back(on_arc(static_cast<double>(i)));
    all.frames.push_back((2 * i < kFrames ? before : after).acquire(all.poses.back(), i));
  }
  return all;
}

FrameConsistency consistency_of(const Sensor& sensor, const Taken& all) {
  ScorerConfig config;
  config.voxel_size = 0.01;
  config.workspace = {{-0.5, -0.5, -0.3}, {0.5, 0.5, 0.2}};
  config.gain.model = GainModel::paper;
  ViewScorer map(sensor, config, {1});
  for (std::size_t i = 0; i < all.frames.size(); ++i) {
    (void)map.add({all.poses[i], {all.frames[i]}});
  }
  return map.consistency();
}

TEST(FrameCheck, RightFramesAgree) {
  std::size_t cases = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const FrameConsistency exact = consistency_of(camera(), taken(camera(), seed));
    EXPECT_EQ(exact.suspicion.what, "") << seed;
    EXPECT_EQ(exact.frames.size(), kFrames);
    EXPECT_TRUE(exact.contradicting.empty());
    EXPECT_LT(exact.share_in_free, 0.01);
    EXPECT_LT(exact.share_seen_past, 0.005);
    // Poses that are off by what the sensor declares.
    Sensor declared = camera();
    declared.pose_sigma = {0.005, 0.0087};
    Taken off = taken(camera(), seed);
    for (std::size_t i = 0; i < kFrames; ++i) {
      off.poses[i] = reported_pose(off.poses[i], i, declared.pose_sigma, seed);
    }
    EXPECT_EQ(consistency_of(declared, off).suspicion.what, "") << seed;
    cases += 2;
  }
  EXPECT_EQ(cases, 6U);
}

Pose turned(const Pose& pose, const Eigen::Vector3d& axis, double degrees) {
  const Eigen::AngleAxisd turn(degrees * std::numbers::pi / 180, axis);
  return {pose.rotation() * turn.toRotationMatrix(), pose.translation()};
}

// What is wrong in frames or poses, and what must be said of it; empty: anything.
struct Mistake {
  std::string kind;
  std::function<void(Taken&)> make;
};

std::function<void(Taken&)> each_pose(const std::function<Pose(const Pose&)>& change) {
  return [change](Taken& all) {
    for (Pose& pose : all.poses) pose = change(pose);
  };
}

std::function<void(Taken&)> each_image(bool columns, bool rows) {
  return [=](Taken& all) {
    for (DepthFrame& frame : all.frames) {
      const DepthFrame own = frame;
      const auto width = static_cast<std::size_t>(frame.width);
      const auto height = static_cast<std::size_t>(frame.height);
      for (std::size_t v = 0; v < height; ++v) {
        for (std::size_t u = 0; u < width; ++u) {
          frame.depth[v * width + u] =
              own.depth[(rows ? height - 1 - v : v) * width + (columns ? width - 1 - u : u)];
        }
      }
    }
  };
}

TEST(FrameCheck, MistakesAreNoticed) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  const auto shifted = [](const Eigen::Vector3d& by) {
    return [by](const Pose& pose) { return Pose(pose.rotation(), pose * by); };
  };
  const std::vector<Mistake> mistakes{
      {"", each_pose([&](const Pose& T) { return turned(T, y, 5); })},
      {"", each_pose([&](const Pose& T) { return turned(T, y, 25); })},
      {"", each_pose([&](const Pose& T) { return turned(T, x, 30); })},
      {"", each_pose([&](const Pose& T) { return turned(T, z, 30); })},
      {"", each_pose(shifted({0.06, 0, 0}))},
      {"", each_pose(shifted({0.05, 0, 0.1}))},
      {"rolled_camera", each_pose([&](const Pose& T) { return turned(T, z, 90); })},
      {"rolled_camera", each_pose([&](const Pose& T) { return turned(T, z, 180); })},
      {"mirrored", each_image(true, false)},
      {"upside_down", each_image(false, true)},
      {"numbering",
       [](Taken& all) { std::rotate(all.poses.begin(), all.poses.begin() + 1, all.poses.end()); }},
      {"",
       [](Taken& all) {
         for (std::size_t i = kFrames / 2; i < kFrames; ++i) {
           all.poses[i] = {all.poses[i].rotation(),
                           all.poses[i].translation() + Eigen::Vector3d(0, 0.1, 0)};
         }
       }},
      {"same_image",
       [](Taken& all) {
         for (std::size_t i = 5; i < 10; ++i) all.frames[i] = all.frames[4];
       }},
  };
  std::size_t noticed = 0;
  for (const Mistake& mistake : mistakes) {
    Taken wrong = taken(camera(), 4);
    mistake.make(wrong);
    const FrameConsistency found = consistency_of(camera(), wrong);
    EXPECT_NE(found.suspicion.kind, "") << noticed;
    EXPECT_FALSE(found.suspicion.what.empty());
    if (!mistake.kind.empty()) {
      EXPECT_EQ(found.suspicion.kind, mistake.kind) << found.suspicion.what;
    }
    ++noticed;
  }
  EXPECT_EQ(noticed, mistakes.size());
}

// What is too small for readings to contradict each other, and yet more than is declared.
TEST(FrameCheck, FramesThatLieBesideOneAnotherAreNoticed) {
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const std::vector<std::function<Pose(const Pose&)>> changes{
      [&](const Pose& T) { return turned(T, y, 1); },
      [](const Pose& T) { return Pose(T.rotation(), T * Eigen::Vector3d(0.012, 0, 0)); }};
  Sensor exact = camera();
  exact.noise = ConstantNoise{0.001, 0.001};
  std::size_t cases = 0;
  for (const auto& change : changes) {
    Taken wrong = taken(exact, 4);
    each_pose(change)(wrong);
    const FrameConsistency found = consistency_of(exact, wrong);
    EXPECT_EQ(found.suspicion.kind, "displacement") << cases << found.suspicion.what;
    EXPECT_GT(found.displacement, 2 * found.expected);
    EXPECT_GE(2 * found.contradicting.size(), kFrames);
    // The same where poses are declared to be off by that.
    Sensor declared = exact;
    declared.pose_sigma = {0.01, 0.02};
    EXPECT_EQ(consistency_of(declared, wrong).suspicion.kind, "") << cases;
    // Four frames are compared with earlier ones, too few.
    wrong.frames.resize(5), wrong.poses.resize(5);
    EXPECT_NE(consistency_of(exact, wrong).suspicion.kind, "displacement") << cases;
    ++cases;
  }
  EXPECT_EQ(cases, 2U);
}

TEST(FrameCheck, AnObjectThatMovedIsNoticed) {
  const FrameConsistency found = consistency_of(camera(), taken(camera(), 5, -0.25));
  EXPECT_EQ(found.suspicion.kind, "contradiction");
  EXPECT_FALSE(found.contradicting.empty());
}

// One frame among many: it is the one that is named.
TEST(FrameCheck, ALostFrameIsNamed) {
  Taken all = taken(camera(), 6);
  all.poses[7] = turned({all.poses[7].rotation(), all.poses[7] * Eigen::Vector3d(0.15, 0, 0)},
                        Eigen::Vector3d::UnitY(), 12);
  const FrameConsistency found = consistency_of(camera(), all);
  EXPECT_NE(found.suspicion.kind, "");
  EXPECT_NE(std::find(found.contradicting.begin(), found.contradicting.end(), 7U),
            found.contradicting.end());
  EXPECT_LT(found.contradicting.size(), kFrames / 2);
}

// A dozen images are kept of any number of frames.
TEST(FrameCheck, ManyFramesAgree) {
  std::size_t cases = 0;
  for (const std::size_t count : {13, 25, 49}) {
    Taken all = taken(camera(), 9);
    for (std::size_t i = kFrames; i < count; ++i) {
      all.frames.push_back(all.frames[i % kFrames]);
      all.poses.push_back(all.poses[i % kFrames]);
    }
    const FrameConsistency found = consistency_of(camera(), all);
    EXPECT_EQ(found.suspicion.what, "") << count;
    EXPECT_EQ(found.frames.size(), count);
    for (Pose& pose : all.poses) pose = turned(pose, Eigen::Vector3d::UnitZ(), 90);
    EXPECT_EQ(consistency_of(camera(), all).suspicion.kind, "rolled_camera") << count;
    ++cases;
  }
  EXPECT_EQ(cases, 3U);
}

TEST(FrameCheck, FocalLengthsThatAreFarApartAreNamed) {
  Sensor sensor = camera();
  const Taken all = taken(sensor, 7);
  sensor.camera.fx *= 1.3;
  EXPECT_EQ(consistency_of(sensor, all).suspicion.kind, "focal_lengths");
}

TEST(FrameCheck, FewFramesSayNothing) {
  Taken all = taken(camera(), 8);
  all.frames.resize(1), all.poses.resize(1);
  EXPECT_EQ(consistency_of(camera(), all).suspicion.kind, "");
  EXPECT_EQ(consistency_of(camera(), {}).suspicion.kind, "");
}

// What is refused is not counted.
TEST(FrameCheck, AnIdentityOfAnotherFormChangesNothing) {
  Taken all = taken(camera(), 8);
  ScorerConfig config;
  config.voxel_size = 0.01;
  config.workspace = {{-0.5, -0.5, -0.3}, {0.5, 0.5, 0.2}};
  ViewScorer map(camera(), config, {1});
  const std::string hash = map.grid().content_hash();
  all.frames[0].identity = "frame 0";
  test::expect_error(ErrorCode::invalid_argument, "16 hexadecimal digits", [&] {
    (void)map.add({all.poses[0], {all.frames[0]}});
  });
  EXPECT_EQ(map.consistency().frames.size(), 0U);
  EXPECT_EQ(map.grid().content_hash(), hash);
  all.frames[0].identity = "0123456789abcdef frame 0";
  EXPECT_EQ(map.add({all.poses[0], {all.frames[0]}}).verdict, FrameVerdict::used);
  EXPECT_EQ(map.consistency().frames.size(), 1U);
}

TEST(FrameCheck, NumbersAreWrittenAsRanges) {
  EXPECT_EQ(ranges_text({}), "");
  EXPECT_EQ(ranges_text({3}), "3");
  EXPECT_EQ(ranges_text({3, 5, 6, 7, 9, 10}), "3, 5-7, 9-10");
}

}  // namespace
}  // namespace viewgain
