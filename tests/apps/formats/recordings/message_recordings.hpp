// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "apps/formats/recordings/message_writer.hpp"
#include "apps/program_runner.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain::test {

using Kind = McapText::Kind;

inline constexpr std::uint32_t kWidth = 48, kHeight = 36;
inline constexpr std::size_t kImages = 5;
inline constexpr const char* kTopic = "/camera/depth/image_raw";
inline constexpr std::array<double, 7> kStill{0.1, 0, 0, 0, 0, 0, 1};

inline double image_time(std::size_t i) { return 100.05 + 0.1 * static_cast<double>(i); }

inline std::uint16_t depth_mm(std::size_t i, std::size_t k) {
  return k == 5 ? std::uint16_t{0} : static_cast<std::uint16_t>(600 + k % kWidth + 20 * i);
}

// Rows of 16UC1, of so many bytes more than the pixels take.
inline std::string rows_mm(std::size_t i, bool is_big_endian = false, std::size_t padding = 0) {
  std::string rows;
  for (std::size_t k = 0; k < kWidth * kHeight; ++k) {
    const std::uint16_t value = depth_mm(i, k);
    const char low = static_cast<char>(value & 255U), high = static_cast<char>(value >> 8U);
    rows += is_big_endian ? std::string{high, low} : std::string{low, high};
    if (k % kWidth == kWidth - 1) rows += std::string(padding, '\x7f');
  }
  return rows;
}

/// What a CameraInfo says.
struct Camera {
  std::string model = "plumb_bob";
  std::vector<double> d{};
  std::array<std::uint32_t, 2> size{kWidth, kHeight}, binning{};
  std::array<std::uint32_t, 4> roi{};  // x, y, height, width
  double stereo = 0;                   // P's Tx
  std::array<double, 4> k{61, 62, 23, 17};
};

/// Recordings of an arm with a camera, and calls of import on them.
class MessageRecordings : public ProgramTest {
 protected:
  MessageRecordings() { write_small_sensor(); }

  // The arm's link moves along x at 1 m/s and turns; the optical frame is fixed to it.
  static void add_transforms(McapText& text, double from = 100, double to = 101) {
    text.transform("/tf_static", 0, "link", "optical", kStill);
    for (double t = from; t <= to + 1e-9; t += 0.1) {
      const double half = 0.05 * (t - 100);
      text.transform("/tf", t, "base", "link",
                     {t - 100, 0, 0.5, 0, 0, std::sin(half), std::cos(half)});
    }
  }
  static void add_info(McapText& text, const Camera& camera = {},
                       const std::string& topic = "/camera/depth/camera_info") {
    MessageFields info = text.fields();
    info.header(100, "optical").put(camera.size[1]).put(camera.size[0]).text(camera.model);
    info.put(static_cast<std::uint32_t>(camera.d.size())).doubles(camera.d);
    info.doubles(
        std::array<double, 9>{camera.k[0], 0, camera.k[2], 0, camera.k[1], camera.k[3], 0, 0, 1});
    info.doubles(std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1});
    info.doubles(std::array<double, 12>{60, 0, 23.5, camera.stereo, 0, 60, 17.5, 0, 0, 0, 1, 0});
    for (const std::uint32_t value : camera.binning) info.put(value);
    for (const std::uint32_t value : camera.roi) info.put(value);
    info.put(std::uint8_t{0});
    text.add(topic, "sensor_msgs/msg/CameraInfo", info);
  }
  static void add_images(McapText& text, const std::string& topic = kTopic) {
    for (std::size_t i = 0; i < kImages; ++i) {
      text.image(topic, image_time(i), "optical", kWidth, kHeight, "16UC1", rows_mm(i), 2 * kWidth);
    }
  }
  static McapText good(Kind kind = Kind::little_cdr) {
    McapText text(kind);
    add_transforms(text);
    add_info(text);
    add_images(text);
    return text;
  }

  static Strings call(Strings more = {}) {
    return joined({"import", "rec.mcap", "--sensor", "small.toml", "--out", "frames"}, more);
  }
  [[nodiscard]] json import(const McapText& text, Strings more = {},
                            const std::string& warning = {}) const {
    write("rec.mcap", text.bytes());
    more.emplace_back("--json");
    const ProgramResult result = run(call(more));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err.empty(), warning.empty()) << result.err;
    EXPECT_NE(result.err.find(warning), std::string::npos) << result.err;
    return json::parse(result.exit_code == 0 ? result.out : "{}");
  }
  void refuse(const McapText& text, const std::string& word, Strings more = {}) const {
    write("rec.mcap", text.bytes());
    expect_refused(call(more), word);
  }

  void expect_frames(const FrameSequence& frames) const {
    ASSERT_EQ(frames.images.size(), kImages);
    for (std::size_t i = 0; i < kImages; ++i) {
      const Pose& pose = frames.poses[i];
      const double along = image_time(i) - 100, angle = 0.1 * along;
      EXPECT_NEAR(pose.m[3], along + 0.1 * std::cos(angle), 1e-9) << i;
      EXPECT_NEAR(pose.m[7], 0.1 * std::sin(angle), 1e-9) << i;
      EXPECT_NEAR(pose.m[4], std::sin(angle), 1e-9) << i;
      const DepthFrame frame = load_frame(frames, i);
      for (std::size_t k = 0; k < frame.depth.size(); ++k) {
        ASSERT_NEAR(frame.depth[k], 0.001 * depth_mm(i, k), 1e-6) << i << ' ' << k;
      }
    }
  }
};

}  // namespace viewgain::test
