// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/temporary_folder.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/formats/frame_watch.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/formats/sensor_toml.hpp"

namespace viewgain::test {

using Counts = std::map<std::string, std::size_t>;
using Numbers = std::vector<int>;

inline Sensor small_sensor() {
  Sensor sensor = sensor_preset("sr4000");
  sensor.camera = {8, 6, 10, 10, 3.5, 2.5};
  return sensor;
}

inline Pose pose_of(int number) { return look_at({0.5, 0.1 * number, 0.4}, {0, 0, 0}); }

inline std::string matrix_text(const Pose& pose) {
  std::string text;
  for (std::size_t i = 0; i < 12; ++i) {
    text += std::to_string(pose.m[i]) + (i % 4 == 3 ? "\n" : " ");
  }
  return text + "0 0 0 1\n";
}

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

}  // namespace viewgain::test
