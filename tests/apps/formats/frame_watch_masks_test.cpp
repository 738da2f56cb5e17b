// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// A folder of frames and folders of their masks, into which somebody writes, with a clock of the
// test's own.
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/formats/watched_folder.hpp"
#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "viewgain/formats/frame_watch.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/png.hpp"

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

// Masks are in a folder of the frames' folder, confidences elsewhere.
class WatchedMasks : public test::WatchedFolder {
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
