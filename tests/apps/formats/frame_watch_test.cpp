// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// A folder of frames that somebody writes into, with a clock of the test's own.
#include "viewgain/formats/frame_watch.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "apps/formats/watched_folder.hpp"
#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/formats/sensor_toml.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using test::Counts;
using test::expect_error;
using test::matrix_text;
using test::Numbers;
using test::pose_of;
using test::read_all;
using test::small_sensor;
using test::WatchedFolder;

TEST_F(WatchedFolder, GivesWhatOpenFramesGives) {
  for (const int number : {7, 0, 12}) put_frame(number);
  put("camera-intrinsics.txt", "11 0 3\n0 12 2\n0 0 1\n");
  put("frame-000007.amplitude.png", png(900));
  put("frame-000012.amplitude.png", png(901));
  put("frame-000000.amplitude.png", png(902));
  const FrameSequence frames = open_frames(dir.path());
  FrameWatch watched = watch();
  EXPECT_FALSE(watched.folder());
  std::size_t cases = 0;
  for (; cases < 3; ++cases) {
    const FolderLook look = watched.look(now);
    ASSERT_TRUE(look.frame);
    EXPECT_EQ(look.frame->image, frames.images[cases]);
    EXPECT_EQ(look.frame->identity, frame_identity(frames, cases));
    EXPECT_EQ(look.frame->frame, load_frame(frames, cases));
    EXPECT_EQ(look.frame->T_world_camera, frames.poses[cases]);
  }
  EXPECT_FALSE(watched.look(now).frame);
  EXPECT_EQ(cases, 3U);
  ASSERT_TRUE(watched.folder());
  EXPECT_EQ(watched.folder()->sensor.camera, frames.sensor.camera);
  EXPECT_EQ(watched.folder()->depth_scale, frames.depth_scale);
  EXPECT_TRUE(watched.folder()->recorded);
  EXPECT_EQ(watched.taken().size(), 3U);
  EXPECT_TRUE(watched.bad().empty());
  EXPECT_EQ(watched.waiting(), 0U);
}

TEST_F(WatchedFolder, GivesSimulatedFrames) {
  const Sensor sensor = small_sensor();
  FramesWriter writer(dir.path() / "simulated");
  const std::vector<Pose> poses{pose_of(0), pose_of(1), pose_of(2)};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    writer.write_frame(i, {8, 6, std::vector<float>(48, 0.5F)});
  }
  writer.commit(poses, sensor);
  FrameWatch watched(dir.path() / "simulated", {});
  EXPECT_EQ(complete(watched), (Numbers{0, 1, 2}));
  EXPECT_FALSE(watched.folder()->recorded);
  EXPECT_EQ(watched.folder()->depth_scale, kDepthUnit);
  EXPECT_EQ(sensor_toml(watched.folder()->sensor), sensor_toml(sensor));
}

// Whatever part of a file is there: it waits. The last byte makes the frame complete.
TEST_F(WatchedFolder, EveryPartOfAFileWaits) {
  const std::string image = png(500), pose = matrix_text(pose_of(0));
  const std::string amplitude = png(900), line = "0 0.5 0 0.4 0 0 0 1\n";
  struct Part {
    std::string file, bytes;
    bool is_own_layout;
  };
  std::size_t cases = 0;
  for (const Part& part :
       {Part{"frame-000000.depth.png", image, false},
        Part{"frame-000000.amplitude.png", amplitude, false},
        Part{"frame-000000.pose.txt", pose, false}, Part{"poses.txt", line, true},
        Part{"frame-000000.depth.png", image, true}}) {
    put("frame-000000.depth.png", image);
    put("frame-000000.amplitude.png", amplitude);
    fs::remove(dir.path() / "poses.txt");
    fs::remove(dir.path() / "frame-000000.pose.txt");
    part.is_own_layout ? put("poses.txt", line) : put("frame-000000.pose.txt", pose);
    FrameWatch watched = watch();
    for (std::size_t size = 0; size < part.bytes.size(); ++size, ++cases) {
      put(part.file, part.bytes.substr(0, size));
      now += 1999ms;
      EXPECT_EQ(complete(watched), Numbers{}) << part.file << " " << size;
      EXPECT_EQ(watched.waiting(), 1U);
    }
    put(part.file, part.bytes);
    EXPECT_EQ(complete(watched), Numbers{0}) << part.file;
  }
  EXPECT_EQ(cases, 3 * image.size() - image.size() + amplitude.size() + pose.size() + line.size());
  EXPECT_TRUE(bad.empty());
}

TEST_F(WatchedFolder, WhatNeverEndsIsTakenOrBadAfterAWhile) {
  put_frame(0);
  std::string pose = matrix_text(pose_of(0));
  pose.pop_back();  // all numbers, but no line's end
  put("frame-000000.pose.txt", pose);
  put_frame(1);
  put("frame-000001.pose.txt", pose.substr(0, 20));
  put_frame(2);
  put("frame-000002.depth.png", png(500).substr(0, 60));
  put_frame(3);
  fs::remove(dir.path() / "frame-000003.pose.txt");
  FrameWatch watched = watch();
  EXPECT_EQ(complete_after(watched, 1999ms), Numbers{});
  EXPECT_TRUE(bad.empty());
  EXPECT_FALSE(watched.is_settled());
  EXPECT_EQ(watched.waiting(), 4U);
  now += 1ms;
  EXPECT_EQ(complete(watched), Numbers{0});
  EXPECT_EQ(watched.bad(), (Counts{{"lost_pose", 1}, {"unreadable", 1}}));
  // The one without a pose waits for as long as it takes.
  EXPECT_EQ(watched.waiting(), 1U);
  EXPECT_TRUE(watched.is_settled());
  // In our own layout a line without its end could be the half of a number.
  const test::TemporaryFolder own;
  own.file("sensor.toml", sensor_toml(small_sensor()));
  own.file("frame-000000.depth.png", png(500));
  own.file("poses.txt", "0 0.5 0 0.4 0 0 0 1");
  FrameWatch other(own.path(), {});
  EXPECT_EQ(complete_after(other, 1h), Numbers{});
  EXPECT_EQ(other.waiting(), 1U);
}

TEST_F(WatchedFolder, BadOnesAreCountedOnceAndTakenWhenTheyBecomeGood) {
  const std::string whole = png(500);
  std::string damaged = whole;
  damaged[whole.size() / 2] ^= 1;
  std::string not_rigid = matrix_text(pose_of(0));
  not_rigid[0] = '7';
  std::string nan = "nan" + matrix_text(pose_of(0)).substr(8);
  struct Fault {
    std::string reason, file, bytes;
  };
  const std::vector<Fault> faults{
      {"unreadable", ".depth.png", whole.substr(0, whole.size() - 1)},
      {"unreadable", ".depth.png", ""},
      {"unreadable", ".amplitude.png", whole.substr(0, 30)},
      {"unreadable", ".depth.png", damaged},
      {"unreadable", ".depth.png", whole.substr(whole.size() - 12)},
      {"wrong_size", ".depth.png", png(500, 9, 6)},
      {"wrong_size", ".depth.png", png(500, 6, 8)},
      {"wrong_size", ".amplitude.png", png(500, 4, 3)},
      {"lost_pose", ".pose.txt", not_rigid},
      {"lost_pose", ".pose.txt", nan},
      {"lost_pose", ".pose.txt", "no pose\n"},
  };
  Counts expected;
  for (std::size_t i = 0; i < faults.size(); ++i) {
    const int number = static_cast<int>(i);
    put_frame(number);
    put(name(number, ".amplitude.png"), png(900));
    put(name(number, faults[i].file), faults[i].bytes);
    ++expected[faults[i].reason];
  }
  put_frame(99);
  put(name(99, ".amplitude.png"), png(900));
  FrameWatch watched = watch();
  EXPECT_EQ(complete(watched), Numbers{99});
  EXPECT_EQ(complete_after(watched, 1999ms), Numbers{});
  EXPECT_TRUE(bad.empty());
  now += 1ms;
  EXPECT_EQ(complete(watched), Numbers{});
  ASSERT_EQ(bad.size(), faults.size());
  std::size_t cases = 0;
  for (; cases < faults.size(); ++cases) {
    EXPECT_EQ(bad[cases].number, cases);
    EXPECT_EQ(frame_verdict_name(bad[cases].fault.verdict), faults[cases].reason)
        << bad[cases].fault.what;
    const std::string file = name(static_cast<int>(cases), faults[cases].file);
    EXPECT_NE(bad[cases].fault.what.find(file), std::string::npos) << bad[cases].fault.what;
  }
  EXPECT_EQ(cases, 11U);
  EXPECT_EQ(watched.bad(), expected);
  EXPECT_EQ(complete_after(watched, 1h), Numbers{});
  EXPECT_EQ(bad.size(), faults.size());
  for (std::size_t i = 0; i < faults.size(); ++i) {
    const int number = static_cast<int>(i);
    put_frame(number);
    put(name(number, ".amplitude.png"), png(900));
    EXPECT_EQ(complete(watched), Numbers{number});
  }
  EXPECT_TRUE(watched.bad().empty());
  EXPECT_EQ(watched.taken().size(), faults.size() + 1);
}

TEST_F(WatchedFolder, ABadLineIsOneFramesAlone) {
  for (const int number : {0, 1, 2, 3}) put(name(number, ".depth.png"), png(500));
  put("poses.txt",
      "# mine\n0 0.5 0 0.4 0 0 0 1\n\n1 nan 0 0.4 0 0 0 1\n2 0.5 0 0.4 0 0 0 1\n"
      "3 0.5 0 0.4 0 0 0 2\n");
  FrameWatch watched = watch();
  EXPECT_EQ(complete(watched), (Numbers{0, 2}));
  EXPECT_EQ(complete_after(watched, 2s), Numbers{});
  EXPECT_EQ(watched.bad(), (Counts{{"lost_pose", 2}}));
  ASSERT_EQ(bad.size(), 2U);
  EXPECT_NE(bad[0].fault.what.find("poses.txt:4"), std::string::npos) << bad[0].fault.what;
  // More lines change nothing for the frames before them.
  put("frame-000004.depth.png", png(500));
  put("poses.txt", read_all(dir.path() / "poses.txt") + "4 0.5 0 0.4 0 0 0 1\n");
  EXPECT_EQ(complete(watched), Numbers{4});
  EXPECT_EQ(watched.bad(), (Counts{{"lost_pose", 2}}));
}

TEST_F(WatchedFolder, WhatIsGoneIsNoFaultAndAHeadingIs) {
  const std::string line = " 0.5 0 0.4 0 0 0 1";
  for (const int number : {0, 1}) put(name(number, ".depth.png"), png(500));
  put("poses.txt", "0" + line + "\n1" + line + "\n");
  FrameWatch watched = watch();
  EXPECT_EQ(complete(watched), (Numbers{0, 1}));
  // What was taken is nobody's fault when it is gone.
  for (const int number : {0, 1}) fs::remove(dir.path() / name(number, ".depth.png"));
  EXPECT_EQ(complete_after(watched, 2s), Numbers{});
  EXPECT_TRUE(watched.give_up().empty());
  // A heading would give each image the pose of the one before.
  put("poses.txt", "timestamp tx ty tz qx qy qz qw\n0" + line + "\n");
  expect_error(ErrorCode::format, "poses.txt:1", [&] { (void)watched.look(now); });
  expect_error(ErrorCode::format, "poses.txt:1", [&] { (void)open_frames(dir.path()); });
}

TEST_F(WatchedFolder, ATakenFrameStaysTaken) {
  put_frame(0);
  put_frame(1);
  FrameWatch first = watch();
  EXPECT_EQ(complete(first), (Numbers{0, 1}));
  const std::set<std::string> taken = first.taken();
  EXPECT_EQ(taken.size(), 2U);
  for (FrameWatch* watched : {&first}) {
    put_frame(0);  // the same bytes anew
    EXPECT_EQ(complete_after(*watched, 3s), Numbers{});
    EXPECT_EQ(watched->waiting(), 0U);
  }
  // After a restart, too; with other contents it is not the frame that was taken.
  put("frame-000001.depth.png", png(777));
  FrameWatch second = watch(taken);
  EXPECT_EQ(complete_after(second, 1999ms), Numbers{});
  EXPECT_TRUE(second.bad().empty());
  for (FrameWatch* watched : {&first, &second}) {
    EXPECT_EQ(complete_after(*watched, 2s), Numbers{});
    EXPECT_EQ(watched->bad(), (Counts{{"changed", 1}}));
    EXPECT_EQ(watched->taken(), taken);
  }
  // Files that are gone are nobody's fault.
  fs::remove(dir.path() / "frame-000000.depth.png");
  fs::remove(dir.path() / "frame-000001.depth.png");
  EXPECT_EQ(complete(first), Numbers{});
  EXPECT_TRUE(first.bad().empty());
  EXPECT_EQ(first.taken(), taken);
}

TEST_F(WatchedFolder, AmplitudesAreWaitedForWhereThereAreAny) {
  put_frame(0);
  FrameWatch watched = watch();
  EXPECT_EQ(complete(watched), Numbers{0});
  put_frame(1);
  put_frame(2);
  put("frame-000002.amplitude.png", png(900));
  EXPECT_EQ(complete(watched), Numbers{2});
  now += 1s;
  EXPECT_EQ(complete(watched), Numbers{});
  put("frame-000001.amplitude.png", png(900));
  EXPECT_EQ(complete(watched), Numbers{1});
  put_frame(3);
  EXPECT_EQ(complete_after(watched, 1999ms), Numbers{});
  now += 1ms;
  EXPECT_EQ(complete(watched), Numbers{3});
}

TEST_F(WatchedFolder, RefusedOnesAreBadUntilTheyChange) {
  put_frame(0);
  FrameWatch watched = watch();
  const FolderLook look = watched.look(now);
  ASSERT_TRUE(look.frame);
  watched.refuse(*look.frame, FrameVerdict::outside);
  EXPECT_EQ(complete_after(watched, 3s), Numbers{});
  EXPECT_EQ(watched.bad(), (Counts{{"outside", 1}}));
  EXPECT_TRUE(watched.taken().empty());
  put("frame-000000.pose.txt", matrix_text(pose_of(5)));
  EXPECT_EQ(complete(watched), Numbers{0});
  EXPECT_TRUE(watched.bad().empty());
}

TEST_F(WatchedFolder, TheSensorIsNeededWithTheFirstCompleteFrame) {
  fs::remove(dir.path() / "sensor.toml");
  FrameWatch watched = watch();
  put("frame-000000.depth.png", png(500));
  put("frame-000001.depth.png", png(500).substr(0, 20));
  put("frame-000001.pose.txt", matrix_text(pose_of(1)));
  EXPECT_EQ(complete(watched), Numbers{});
  put("frame-000000.pose.txt", matrix_text(pose_of(0)));
  expect_error(ErrorCode::invalid_argument, "sensor.toml", [&] { (void)watched.look(now); });
  put("sensor.toml", sensor_toml(small_sensor()));
  EXPECT_EQ(complete(watched), Numbers{0});
  FrameWatch nowhere(dir.path() / "nowhere", {});
  expect_error(ErrorCode::io, "nowhere", [&] { (void)nowhere.look(now); });
}

}  // namespace
}  // namespace viewgain
