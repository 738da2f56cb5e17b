// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// A folder of frames, and folders of masks, that somebody writes into, with a clock of the test's
// own.
#include "viewgain/formats/frame_watch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "support/pose_file_text.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/formats/sensor_toml.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using test::expect_error;
using test::matrix_text;
using test::read_all;
using test::TemporaryFolder;
using Counts = std::map<std::string, std::size_t>;
using Numbers = std::vector<int>;

Sensor small_sensor() {
  Sensor sensor = sensor_preset("sr4000");
  sensor.camera = {8, 6, 10, 10, 3.5, 2.5};
  return sensor;
}

Pose pose_of(int number) { return look_at({0.5, 0.1 * number, 0.4}, {0, 0, 0}); }

/// The folder, what is written into it, and the time.
class WatchedFolder : public testing::Test {
 protected:
  WatchedFolder() { put("sensor.toml", sensor_toml(small_sensor())); }

  void put(const std::string& name, std::string_view bytes) const { dir.file(name, bytes); }

  // The bytes of an image of which every pixel has this value.
  [[nodiscard]] std::string png(std::uint16_t value, int width = 8, int height = 6) const {
    GrayImage image{width, height, {}};
    image.pixels.assign(static_cast<std::size_t>(width * height), value);
    const std::filesystem::path path = elsewhere.path() / "image.png";
    write_png(path, image);
    return read_all(path);
  }

  void put_frame(int number) const {
    put(name(number, ".depth.png"), png(static_cast<std::uint16_t>(500 + number)));
    put(name(number, ".pose.txt"), matrix_text(pose_of(number)));
  }

  static std::string name(int number, const std::string& suffix) {
    std::string digits = std::to_string(number);
    return "frame-" + std::string(6 - digits.size(), '0') + digits + suffix;
  }

  [[nodiscard]] FrameWatch watch(std::set<std::string> taken = {}) const {
    FrameWatchConfig config;
    config.taken = std::move(taken);
    return {dir.path(), config};
  }

  // All that is complete now, in the order in which it comes.
  std::vector<int> complete(FrameWatch& watch) {
    std::vector<int> numbers;
    for (;;) {
      const FolderLook look = watch.look(now);
      for (const BadFrame& frame : look.bad) bad.push_back(frame);
      if (!look.frame) return numbers;
      numbers.push_back(static_cast<int>(look.frame->number));
    }
  }

  // Lets the files lie there for this long.
  std::vector<int> complete_after(FrameWatch& watch, std::chrono::milliseconds time) {
    (void)complete(watch);
    now += time;
    return complete(watch);
  }

  TemporaryFolder dir, elsewhere;
  FrameWatch::Time now{std::chrono::hours(1)};
  std::vector<BadFrame> bad;
};

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
    EXPECT_EQ(look.frame->frame.identity, frame_identity(frames, cases));
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
  const TemporaryFolder own;
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

TEST_F(WatchedFolder, ManyTakenFramesAreLookedAtAgainInTurns) {
  constexpr int kFrames = 600;  // 256 a look
  for (int number = 0; number < kFrames; ++number) put_frame(number);
  FrameWatch watched = watch();
  EXPECT_EQ(complete(watched).size(), std::size_t{kFrames});
  for (const int changed : {0, 300, kFrames - 1}) {
    put(name(changed, ".depth.png"), png(777));
    std::size_t looks = 0;
    for (; watched.waiting() == 0 && looks < 4; ++looks) EXPECT_FALSE(watched.look(now).frame);
    EXPECT_LE(looks, 3U) << changed;
    EXPECT_EQ(watched.waiting(), 1U);
    now += 3s;
    EXPECT_FALSE(watched.look(now).frame);
    EXPECT_EQ(watched.waiting(), 0U);
  }
  EXPECT_EQ(watched.bad(), (Counts{{"changed", 3}}));
  std::size_t looks = 1;
  for (; !watched.is_settled() && looks < 9; ++looks) EXPECT_FALSE(watched.look(now).frame);
  EXPECT_EQ(looks, 3U);
}

TEST_F(WatchedFolder, WhatComesMeanwhileIsInTheNextList) {
  for (const int number : {5, 6, 8}) put_frame(number);
  FrameWatch watched = watch();
  const auto next = [&] {
    const FolderLook found = watched.look(now);
    return found.frame ? static_cast<int>(found.frame->number) : -1;
  };
  EXPECT_EQ(next(), 5);
  put_frame(3);
  std::filesystem::remove(dir.path() / name(6, ".depth.png"));
  EXPECT_EQ(next(), 8);
  EXPECT_EQ(next(), 3);
  EXPECT_EQ(next(), -1);
  EXPECT_EQ(watched.taken_count(), 3U);
  EXPECT_EQ(watched.taken().size(), 3U);
  EXPECT_EQ(watched.waiting(), 0U);
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

// That which was taken, or else the first by name; the other is told of once.
TEST_F(WatchedFolder, OfTwoImagesOfANumberOneCounts) {
  const auto put_twin = [&](const std::string& digits) {
    put("frame-" + digits + ".depth.png", png(600));
    put("frame-" + digits + ".pose.txt", matrix_text(pose_of(5)));
  };
  put("camera-intrinsics.txt", "11 0 3\n0 12 2\n0 0 1\n");
  for (const int number : {0, 1}) put_frame(number);
  FrameWatch watched = watch();
  EXPECT_EQ(complete(watched), (Numbers{0, 1}));
  put_twin("0");
  put_twin("0000001");
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(complete_after(watched, 3s).empty());
  ASSERT_EQ(bad.size(), 2U);
  EXPECT_EQ(bad[0].name, "frame-0.depth.png");
  EXPECT_EQ(bad[1].name, "frame-0000001.depth.png");
  EXPECT_EQ(bad[0].fault.verdict, FrameVerdict::changed);
  EXPECT_EQ(watched.bad(), (Counts{{"changed", 2}}));
  EXPECT_EQ(watched.taken_count(), 2U);
  EXPECT_EQ(watched.waiting(), 0U);

  put("frame-99999999999999999999.depth.png", png(600));
  EXPECT_TRUE(complete_after(watched, 3s).empty());
  ASSERT_EQ(bad.size(), 3U);
  EXPECT_EQ(bad[2].fault.what.substr(dir.path().string().size() + 1),
            "frame-99999999999999999999.depth.png: the number of the frame has more than 64 bits");
  std::filesystem::remove(dir.path() / "frame-99999999999999999999.depth.png");

  FrameWatch fresh = watch();
  EXPECT_EQ(complete(fresh), (Numbers{0, 1}));
  EXPECT_EQ(fresh.taken_count(), 2U);
  EXPECT_EQ(fresh.bad(), (Counts{{"changed", 2}}));

  std::filesystem::remove(dir.path() / "frame-0.depth.png");
  std::filesystem::remove(dir.path() / "frame-0000001.depth.png");
  EXPECT_TRUE(complete_after(watched, 3s).empty());
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

// Masks are in a folder of the frames' folder, confidences elsewhere.
class WatchedMasks : public WatchedFolder {
 protected:
  WatchedMasks() {
    fs::create_directory(dir.path() / "masks");
    fs::create_directory(elsewhere.path() / "sure");
  }

  // The bytes of an image of these values, row after row again and again.
  [[nodiscard]] std::string gray8(const std::vector<int>& values, int width = 8,
                                  int height = 6) const {
    Gray8Image image{width, height, {}};
    for (std::size_t k = 0; k < static_cast<std::size_t>(width * height); ++k) {
      image.pixels.push_back(static_cast<std::uint8_t>(values[k % values.size()]));
    }
    const fs::path path = elsewhere.path() / "mask.png";
    write_png(path, image);
    return read_all(path);
  }

  void put_mask(int number, std::string_view bytes) const {
    put("masks/" + name(number, ".depth.png"), bytes);
  }

  void put_confidences(int number, std::string_view bytes) const {
    elsewhere.file("sure/" + name(number, ".depth.png"), bytes);
  }

  [[nodiscard]] FrameWatch masked_watch(std::set<std::string> taken = {},
                                        bool has_confidences = false) const {
    FrameWatchConfig config;
    config.taken = std::move(taken);
    config.masks.emplace_back(dir.path() / "masks");
    if (has_confidences) config.masks.emplace_back(elsewhere.path() / "sure", std::uint8_t{2});
    return {dir.path(), config};
  }

  // What is said of frames at the end.
  static Counts given_up(FrameWatch& watch) {
    Counts counts;
    for (const BadFrame& frame : watch.give_up())
      ++counts[std::string(frame_verdict_name(frame.fault.verdict))];
    return counts;
  }

  const std::string left = gray8({255, 255, 255, 0, 0, 0, 0, 0});
};

// Depth image, pose and mask in each order, in place and by a rename: the last makes it complete.
TEST_F(WatchedMasks, AFrameNeedsItsMaskWheneverThatComes) {
  FrameWatch watched = masked_watch();
  std::array<int, 3> order{0, 1, 2};
  int number = 0;
  do {
    for (const bool is_renamed : {false, true}) {
      const std::array<std::pair<std::string, std::string>, 3> files{
          {{name(number, ".depth.png"), png(500)},
           {name(number, ".pose.txt"), matrix_text(pose_of(number))},
           {"masks/" + name(number, ".depth.png"), left}}};
      for (const int i : order) {
        const auto& [file, bytes] = files[static_cast<std::size_t>(i)];
        EXPECT_EQ(complete_after(watched, 3s), Numbers{}) << number << " " << file;
        put(is_renamed ? "part" : file, bytes);
        if (is_renamed) fs::rename(dir.path() / "part", dir.path() / file);
      }
      EXPECT_EQ(complete(watched), Numbers{number});
      ++number;
    }
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_EQ(number, 12);
  EXPECT_TRUE(bad.empty());
}

TEST_F(WatchedMasks, AFrameNeedsItsConfidencesToo) {
  FrameWatch watched = masked_watch({}, true);
  put_frame(0);
  put_confidences(0, gray8({0, 1, 1, 1, 2, 2, 3, 255}));
  EXPECT_EQ(complete_after(watched, 3s), Numbers{});
  put_mask(0, left);
  const FolderLook look = watched.look(now);
  ASSERT_TRUE(look.frame);
  EXPECT_EQ(look.frame->masked_pixels, 4U * 6U);  // each pixel once
  put_frame(1);
  put_mask(1, left);
  EXPECT_EQ(complete_after(watched, 3s), Numbers{});
  const std::vector<BadFrame> given_up = watched.give_up();
  ASSERT_EQ(given_up.size(), 1U);
  EXPECT_NE(given_up[0].fault.what.find("sure/frame-000001.depth.png"), std::string::npos)
      << given_up[0].fault.what;
}

TEST_F(WatchedMasks, BadMasksAreCountedOnceAndTakenWhenTheyBecomeGood) {
  std::string damaged = left;
  damaged[left.size() / 2] ^= 1;
  write_png(elsewhere.path() / "rgb.png",
            RgbImage{8, 6, std::vector<std::uint8_t>(std::size_t{8 * 6 * 3})});
  const std::vector<std::pair<std::string, std::string>> faults{
      {"unreadable", left.substr(0, left.size() - 1)},
      {"unreadable", ""},
      {"unreadable", damaged},
      {"unreadable", png(500)},  // 16 bits: a depth image
      {"unreadable", read_all(elsewhere.path() / "rgb.png")},
      {"wrong_size", gray8({0, 1}, 9, 6)},
      {"wrong_size", gray8({0, 1}, 6, 8)}};
  Counts expected;
  for (std::size_t i = 0; i < faults.size(); ++i) {
    put_frame(static_cast<int>(i));
    put_mask(static_cast<int>(i), faults[i].second);
    ++expected[faults[i].first];
  }
  FrameWatch watched = masked_watch();
  EXPECT_EQ(complete_after(watched, 1999ms), Numbers{});
  EXPECT_TRUE(bad.empty());
  EXPECT_TRUE(given_up(watched).empty());
  now += 1ms;
  EXPECT_EQ(complete_after(watched, 1h), Numbers{});
  ASSERT_EQ(bad.size(), faults.size());
  std::size_t cases = 0;
  for (; cases < faults.size(); ++cases) {
    EXPECT_EQ(frame_verdict_name(bad[cases].fault.verdict), faults[cases].first)
        << bad[cases].fault.what;
    const std::string file = "masks/" + name(static_cast<int>(cases), ".depth.png");
    EXPECT_NE(bad[cases].fault.what.find(file), std::string::npos) << bad[cases].fault.what;
  }
  EXPECT_EQ(cases, 7U);
  EXPECT_EQ(watched.bad(), expected);
  EXPECT_TRUE(given_up(watched).empty());
  EXPECT_TRUE(watched.taken().empty());
  for (std::size_t i = 0; i < faults.size(); ++i) {
    put_mask(static_cast<int>(i), left);
    EXPECT_EQ(complete(watched), Numbers{static_cast<int>(i)});
  }
  EXPECT_TRUE(watched.bad().empty());
}

TEST_F(WatchedMasks, WhatNeverComesIsBadInTheEnd) {
  for (const int number : {0, 1, 2, 3}) put_frame(number);
  put_mask(0, left);
  fs::remove(dir.path() / name(2, ".pose.txt"));  // and no mask
  put(name(3, ".depth.png"), png(500).substr(0, 60));
  FrameWatch watched = masked_watch();
  EXPECT_EQ(complete(watched), Numbers{0});
  EXPECT_EQ(complete_after(watched, 1999ms), Numbers{});
  EXPECT_TRUE(given_up(watched).empty());  // somebody may be writing yet
  now += 1ms;
  EXPECT_EQ(complete(watched), Numbers{});
  EXPECT_EQ(watched.bad(), (Counts{{"unreadable", 1}}));
  EXPECT_EQ(watched.waiting(), 2U);
  EXPECT_TRUE(watched.is_settled());
  const std::vector<BadFrame> given_up_now = watched.give_up();
  ASSERT_EQ(given_up_now.size(), 2U);
  EXPECT_EQ(given_up_now[1].fault.verdict, FrameVerdict::no_pose);
  EXPECT_EQ(given_up_now[0].number, 1U);
  EXPECT_EQ(frame_verdict_name(given_up_now[0].fault.verdict), "no_mask");
  EXPECT_NE(given_up_now[0].fault.what.find("masks/frame-000001.depth.png"), std::string::npos);
  EXPECT_EQ(watched.bad(), (Counts{{"no_mask", 1}, {"no_pose", 1}, {"unreadable", 1}}));
  EXPECT_EQ(watched.waiting(), 0U);
  EXPECT_TRUE(watched.give_up().empty());
  EXPECT_EQ(complete_after(watched, 1h), Numbers{});
  put_mask(1, left);
  EXPECT_EQ(complete(watched), Numbers{1});
  EXPECT_EQ(watched.bad(), (Counts{{"no_pose", 1}, {"unreadable", 1}}));
}

// Masks are no part of what a frame is known by.
TEST_F(WatchedMasks, ATakenFrameStaysTakenWhateverItsMask) {
  for (const int number : {0, 1, 2}) {
    put_frame(number);
    put_mask(number, left);
  }
  FrameWatch first = masked_watch();
  EXPECT_EQ(complete(first), (Numbers{0, 1, 2}));
  const std::set<std::string> taken = first.taken();
  put_mask(0, gray8({0, 1}));
  put_mask(1, "no mask");
  fs::remove(dir.path() / "masks" / name(2, ".depth.png"));
  FrameWatch second = masked_watch(taken), confident = masked_watch(taken, true);
  for (FrameWatch* watched : {&first, &second, &confident}) {
    EXPECT_EQ(complete_after(*watched, 3s), Numbers{});
    EXPECT_EQ(watched->waiting(), 0U);
    EXPECT_TRUE(watched->bad().empty());
    EXPECT_TRUE(given_up(*watched).empty());
    EXPECT_EQ(watched->taken(), taken);
  }
  // With other contents it is not the frame that was taken.
  put(name(2, ".depth.png"), png(777));
  EXPECT_EQ(complete_after(second, 3s), Numbers{});
  EXPECT_EQ(second.bad(), (Counts{{"changed", 1}}));
}

}  // namespace
}  // namespace viewgain
