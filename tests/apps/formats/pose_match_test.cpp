// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Which line of poses.txt belongs to which image.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/frame_watch.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/formats/sensor_toml.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using test::expect_error;
using Words = std::vector<std::string>;
// By image, in the order of their numbers: the line, or why there is none.
using Lines = std::vector<int>;

constexpr int kNoPose = -1, kNoImage = -2;

Words count(int first, int last, const std::string& before = "") {
  Words words;
  for (int i = first; i <= last; ++i) words.push_back(before + std::to_string(i));
  return words;
}

Words without(Words words, std::size_t index) {
  words.erase(words.begin() + static_cast<std::ptrdiff_t>(index));
  return words;
}

Lines identity(int count) {
  Lines lines;
  for (int i = 0; i < count; ++i) lines.push_back(i);
  return lines;
}

class MatchedPoses : public testing::Test {
 protected:
  // Line i has the position (i, 0, 0).
  void put(const Words& images, const Words& times, const std::string& toml = "") {
    dir = folder.path() / std::to_string(folders++);
    fs::create_directory(dir);
    Sensor sensor = sensor_preset("sr4000");
    sensor.camera.width = 4, sensor.camera.height = 2;
    write_sensor_toml(dir / "sensor.toml", sensor);
    folder.file((dir / "frames.toml").string(), "depth_scale = 1e-4\n" + toml);
    for (const std::string& image : images) put_image(image);
    std::string text = "# lines\n";
    for (std::size_t i = 0; i < times.size(); ++i) text += line(times[i], i);
    folder.file((dir / "poses.txt").string(), text);
  }

  static std::string line(const std::string& time, std::size_t i) {
    return time + " " + std::to_string(i) + " 0 0 0 0 0 1\n";
  }

  void put_image(const std::string& number) const {
    const std::string digits = number.size() < 6 ? std::string(6 - number.size(), '0') : "";
    write_png(dir / ("frame-" + digits + number + ".depth.png"),
              GrayImage{4, 2, std::vector<std::uint16_t>(8, 9000)});
  }

  [[nodiscard]] Lines read() const {
    const FrameSequence frames = open_frames(dir);
    Lines lines;
    for (std::size_t i = 0; i < frames.images.size(); ++i) {
      const FrameReading reading = read_frame(frames, i);
      lines.push_back(reading.fault.verdict == FrameVerdict::no_pose ? kNoPose
                      : reading.fault.verdict == FrameVerdict::unreadable
                          ? kNoImage
                          : line_of(frames.poses[i]));
    }
    return lines;
  }

  // What follow gets of the same folder, while somebody may be writing and at the end.
  [[nodiscard]] Lines watched() const {
    FrameWatch watch(dir, {});
    FrameWatch::Time now{1h};
    std::map<std::uint64_t, int> lines;
    for (const auto step : {0s, 2s, 2s}) {
      now += step;
      for (FolderLook look = watch.look(now); look.frame; look = watch.look(now)) {
        lines[look.frame->number] = line_of(look.frame->T_world_camera);
      }
    }
    for (const BadFrame& bad : watch.give_up()) {
      lines[bad.number] = bad.fault.verdict == FrameVerdict::no_pose ? kNoPose : kNoImage;
    }
    Lines in_order;
    for (const auto& [number, line] : lines) in_order.push_back(line);
    return in_order;
  }

  static int line_of(const Pose& pose) { return static_cast<int>(pose.translation().x()); }

  void expect(const Lines& expected) const {
    EXPECT_EQ(read(), expected);
    EXPECT_EQ(watched(), expected);
  }

  void expect_refused(const std::string& word) const {
    expect_error(ErrorCode::format, word, [&] { (void)read(); });
    expect_error(ErrorCode::format, "frames.toml", [&] { (void)read(); });
  }

  test::TemporaryFolder folder;
  fs::path dir;
  int folders = 0;
};

TEST_F(MatchedPoses, ByNumberWhereLinesHaveTheImages) {
  for (const int first : {0, 1, 50, 2000}) {
    put(count(first, first + 7), count(first, first + 7));
    expect(identity(8));
  }
  // What is missing in the middle, of images or of both, moves no other.
  put(without(count(0, 7), 3), count(0, 7));
  expect({0, 1, 2, kNoImage, 4, 5, 6, 7});
  put(without(count(1, 8), 3), without(count(1, 8), 3));
  expect(identity(7));
  put({"3"}, {"3"});
  expect({0});
}

// As version 0.1.0 read them: times that are none of the images' numbers.
TEST_F(MatchedPoses, ByOrderWhereCountsAndFirstNumbersFit) {
  for (const Words& times :
       {Words{"0", "5", "10", "15"}, Words{"0.0", "0.5", "1", "1.5"}, Words{"7", "7", "7", "7"},
        Words{"1700000000", "1700000001", "1700000002", "1700000003"},
        Words{"1305031102.1758", "1305031102.2", "1305031102.3", "1305031102.5"}}) {
    put(count(0, 3), times);
    expect(identity(4));
    put(without(count(0, 3), 2), times);
    EXPECT_EQ(read(), (Lines{0, 1, kNoImage, 3})) << times[0];
  }
}

TEST_F(MatchedPoses, ShiftedNumbersAreRefused) {
  const Words seconds{"0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8"};
  std::size_t cases = 0;
  const std::vector<std::pair<Words, Words>> folders_of{
      {count(1, 8), count(0, 7)},                           // from 1, and from 0
      {count(0, 7), count(1, 8)},                           // the other way round
      {count(1, 8), seconds},                               // from 1, by order
      {count(1, 8), count(0, 8)},                           // an image fewer than lines
      {count(0, 7), count(0, 11)},                          // more lines
      {count(0, 7), count(0, 5)},                           // more images
      {without(count(0, 7), 3), count(0, 6)},               // lines are numbered on
      {without(count(0, 7), 3), without(seconds, 3)},       // likewise, of times
      {count(0, 6), without(count(0, 7), 3)},               // images are
      {without(count(0, 8), 3), without(count(0, 8), 5)}};  // of either another
  for (const auto& [images, times] : folders_of) {
    put(images, times);
    expect_refused("first_frame");
    ++cases;
  }
  EXPECT_EQ(cases, 10U);
}

// The user's word decides.
TEST_F(MatchedPoses, TheFirstFrameCanBeStated) {
  put(count(1, 8), count(0, 7), "first_frame = 1\n");
  expect(identity(8));
  put(count(1, 8), count(0, 7), "first_frame = 0\n");
  expect({kNoImage, 1, 2, 3, 4, 5, 6, 7, kNoPose});
  put(count(4, 5), count(0, 3), "first_frame = 3\n");
  expect({kNoImage, 1, 2, kNoImage});
}

TEST_F(MatchedPoses, ByTimeWhereImagesHaveStamps) {
  // Of 30 Hz, the poses twice as often and from before.
  Words ns, us, ms, seconds, of_poses_in_ns;
  for (int i = 0; i < 6; ++i) {
    const std::uint64_t stamp = 1700000000123456789U + 33333333U * static_cast<std::uint64_t>(i);
    ns.push_back(std::to_string(stamp));
    us.push_back(std::to_string(stamp / 1000));
    ms.push_back(std::to_string(stamp / 1000000));
  }
  for (int k = -3; k < 15; ++k) {
    const std::uint64_t stamp =
        1700000000123456789U + static_cast<std::uint64_t>(16666667 * (k + 3)) - 3 * 16666667U;
    std::string digits = std::to_string(stamp);
    of_poses_in_ns.push_back(digits);
    seconds.push_back(digits.insert(10, "."));
  }
  for (const Words& images : {ns, us, ms}) {
    for (const Words& times : {seconds, of_poses_in_ns}) {
      put(images, times);
      expect({3, 5, 7, 9, 11, 13});
    }
  }
  // From the start of the recording, in ms.
  put({"0", "33", "67", "100", "133"}, {"0.0", "0.033", "0.067", "0.1", "0.133", "0.167"});
  expect(identity(5));
  // One without a pose in time.
  Words gap = seconds;
  gap.erase(gap.begin() + 6, gap.begin() + 9);
  put(ns, gap);
  expect({3, 5, kNoPose, 6, 8, 10});
}

TEST_F(MatchedPoses, ClocksThatDoNotOverlapAreRefused) {
  const Words images{"1700000100000000000", "1700000101000000000", "1700000102000000000"};
  const Words times{"1700000000.0", "1700000001.0", "1700000002.0"};
  put(images, times);
  expect_refused("do not overlap");
  expect_refused("1700000000.000 to 1700000002.000 s");
  expect_refused("pose_time_offset = 100.000");
  EXPECT_EQ(watched(), (Lines{kNoPose, kNoPose, kNoPose}));
  put(images, times, "pose_time_offset = 100.0\n");
  expect(identity(3));
  put(images, {"0", "1", "2"});
  expect_refused("do not overlap");
  put(images, {"one", "two", "three"}, "pose_time_offset = 100.0\n");
  expect_error(ErrorCode::format, "poses.txt", [&] { (void)read(); });
}

// Beside a robot: images and lines come one by one, in any order.
TEST_F(MatchedPoses, GrowingFoldersAreMatchedAsTheyGrow) {
  struct Stream {
    Words images, times;
  };
  std::size_t cases = 0;
  for (const auto& [images, times] :
       {Stream{count(0, 4), count(0, 4)}, Stream{count(1, 5), count(1, 5)},
        Stream{count(0, 4), {"0.5", "1.1", "1.6", "2.1", "2.7"}},
        Stream{count(0, 4), {"0", "5", "10", "15", "20"}},
        Stream{{"1700000000000000000", "1700000001000000000", "1700000002000000000",
                "1700000003000000000", "1700000004000000000"},
               {"1700000000.01", "1700000001.01", "1700000002.01", "1700000003.01",
                "1700000004.01"}}}) {
    for (const bool is_image_first : {true, false}) {
      put({}, {});
      FrameWatch watch(dir, {});
      FrameWatch::Time now{1h};
      Lines taken;
      std::string text;
      const auto look = [&] {
        for (FolderLook found = watch.look(now); found.frame; found = watch.look(now)) {
          taken.push_back(line_of(found.frame->T_world_camera));
        }
      };
      for (std::size_t i = 0; i < images.size(); ++i) {
        if (is_image_first) put_image(images[i]);
        look();
        now += 5s;
        look();
        EXPECT_EQ(taken, identity(static_cast<int>(i)));
        text += line(times[i], i);
        folder.file((dir / "poses.txt").string(), text);
        if (!is_image_first) {
          look();
          put_image(images[i]);
        }
        look();
        EXPECT_EQ(taken, identity(static_cast<int>(i) + 1));
      }
      ++cases;
    }
  }
  EXPECT_EQ(cases, 10U);
}

// The pose of a neighbour is nobody's. An image that is only late changes nothing.
TEST_F(MatchedPoses, GrowingFoldersWithShiftedNumbersAreRefused) {
  put({"1"}, {"0", "1"});
  FrameWatch watch(dir, {});
  FrameWatch::Time now{1h};
  EXPECT_FALSE(watch.look(now).frame);
  now += 1s;
  EXPECT_FALSE(watch.look(now).frame);
  put_image("0");
  EXPECT_EQ(watch.look(now).frame->number, 0U);
  EXPECT_EQ(watch.look(now).frame->number, 1U);
  // One that was there and is gone counts still.
  for (const char* gone : {"0", "1"}) {
    fs::remove(dir / ("frame-00000" + std::string(gone) + ".depth.png"));
  }
  put_image("2");
  EXPECT_FALSE(watch.look(now).frame);
  now += 5s;
  EXPECT_FALSE(watch.look(now).frame);

  // Also in a later call.
  put({"2"}, {"0", "1", "2"});
  FrameWatchConfig config;
  for (const char* name : {"frame-000000.depth.png", "frame-000001.depth.png"}) {
    config.taken.insert("0123456789abcdef " + std::string(name));
  }
  FrameWatch later(dir, config);
  EXPECT_EQ(later.look(now).frame->number, 2U);

  put({"1"}, {"0", "1"});
  FrameWatch shifted(dir, {});
  EXPECT_FALSE(shifted.look(now).frame);
  now += 2s;
  expect_error(ErrorCode::format, "first_frame", [&] { (void)shifted.look(now); });
}

}  // namespace
}  // namespace viewgain
