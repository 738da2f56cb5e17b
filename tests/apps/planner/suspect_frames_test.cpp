// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Each natural mistake is made as a user makes it, and must be found by name; right frames by none.
#include "viewgain/planner/suspect_frames.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "apps/planner/bin_scene.hpp"
#include "core/expect_error.hpp"

namespace viewgain {
namespace {

struct Recording {
  Sensor sensor;
  std::vector<DepthFrame> frames;
  std::vector<Pose> poses;

  [[nodiscard]] Suspicion suspicion() const { return suspect_frames(sensor, frames, poses); }
  void scale(float factor) {
    for (DepthFrame& frame : frames) {
      for (float& z : frame.depth) z *= factor;  // what is none stays none
    }
  }
  template <typename Change>
  void change_poses(const Change& change) {
    for (Pose& pose : poses) pose = change(pose);
  }
};

// A dozen views of the bin, from one side or all round it.
Recording right_one(std::size_t first) {
  const test::BinScene scene;
  Recording recording{scene.sensor, {}, {}};
  for (std::size_t i = first; i < first + 12; ++i) {
    recording.poses.push_back(scene.views.at(i % scene.views.size()));
    recording.frames.push_back(scene.see(recording.poses.back(), i));
  }
  return recording;
}

TEST(SuspectFrames, SayNothingOfRightOnes) {
  for (std::size_t first = 0; first < 20; ++first) {
    const Suspicion found = right_one(first).suspicion();
    EXPECT_EQ(found.kind, "") << first << ": " << found.what;
  }
  EXPECT_EQ(suspect_frames(right_one(0).sensor, {}, {}).kind, "");
}

TEST(SuspectFrames, NameEachMistake) {
  const auto expect_found = [](const Recording& recording, const std::string& kind) {
    const Suspicion found = recording.suspicion();
    EXPECT_EQ(found.kind, kind) << found.what;
    EXPECT_NE(found.what.find('%'), std::string::npos) << kind;
  };
  const auto with_poses = [&](const std::string& kind, const auto& change) {
    for (const std::size_t first : {0U, 7U, 15U}) {
      Recording recording = right_one(first);
      recording.change_poses(change);
      expect_found(recording, kind);
    }
  };
  with_poses("world_to_camera", [](const Pose& T) { return T.inverse(); });
  with_poses("quaternion_order", [](const Pose& T) {
    const Eigen::Quaterniond q(T.rotation());  // w x y z, read as x y z w
    return Pose(Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y()).toRotationMatrix(), T.translation());
  });
  with_poses("body_frame", [](const Pose& T) {
    Eigen::Matrix3d R_body_camera;
    R_body_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    return Pose(T.rotation() * R_body_camera.transpose(), T.translation());
  });
  with_poses("upward_camera", [](const Pose& T) {
    return Pose(T.rotation() * Eigen::Vector3d(1, -1, -1).asDiagonal(), T.translation());
  });
  with_poses("pose_millimetres",
             [](const Pose& T) { return Pose(T.rotation(), 1000 * T.translation()); });

  for (const float factor : {1e-3F, 0.1F, 0.2F, 5.0F, 10.0F, 1000.0F}) {
    Recording recording = right_one(3);
    recording.scale(factor);
    expect_found(recording, "depth_scale");
  }
  Recording along_ray = right_one(0);
  const std::vector<Eigen::Vector3d> rays = along_ray.sensor.camera.ray_table();
  for (DepthFrame& frame : along_ray.frames) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      frame.depth[i] *= static_cast<float>(rays[i].norm());
    }
  }
  expect_found(along_ray, "depth_along_ray");
  Recording halved = right_one(0);
  PinholeCamera& camera = halved.sensor.camera;
  camera.fx /= 2, camera.fy /= 2, camera.cx /= 2, camera.cy /= 2;
  expect_found(halved, "principal_point");
}

TEST(SuspectFrames, RefuseWhatDoesNotBelongTogether) {
  Recording recording = right_one(0);
  recording.poses.pop_back();
  test::expect_error(ErrorCode::invalid_argument, "one pose a frame",
                     [&] { (void)recording.suspicion(); });
  recording = right_one(0);
  recording.frames[3].depth.pop_back();
  test::expect_error(ErrorCode::invalid_argument, "", [&] { (void)recording.suspicion(); });
}

}  // namespace
}  // namespace viewgain
