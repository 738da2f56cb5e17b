// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// `viewgain import` on recordings that the formats' own writers have written: see
// make_recordings.py. The camera moves at 1 m/s, and images and transforms come at other moments.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain {
namespace {

constexpr std::size_t kFrames = 12;
constexpr std::array kRecordings{"arm_zstd.mcap", "arm_lz4.mcap", "split",
                                 "arm.db3",       "arm_bz2.bag",  "arm_lz4.bag"};

// T_world_camera at t [s] behind the recording's first second.
Pose pose_at(double t) {
  const double a = t / 0.6;
  return look_at({0.6 * std::cos(a), 0.6 * std::sin(a), 0.2 + 0.03 * t}, {0, 0, 0});
}

double time_of_frame(std::size_t number) {
  return 0.25 * static_cast<double>(number - 1) + 0.5 / 30;
}

using Voxels = std::set<std::array<std::int32_t, 3>>;

// Voxels that only one of them has, as a share of the first one's.
double difference(const Voxels& a, const Voxels& b) {
  std::size_t others = 0;
  for (const auto& voxel : a) others += b.contains(voxel) ? 0 : 1;
  for (const auto& voxel : b) others += a.contains(voxel) ? 0 : 1;
  return static_cast<double>(others) / static_cast<double>(a.size());
}

class ReferenceRecordings : public test::ProgramTest {
 protected:
  static std::string data(const std::string& name) {
    return std::string(VIEWGAIN_DATA) + "/recordings/" + name;
  }

  [[nodiscard]] test::ProgramResult import(const std::string& source, Strings more = {}) const {
    return run(test::joined(
        {"import", source, "--sensor", data("frames/sensor.toml"), "--out", "frames", "--json"},
        more));
  }

  [[nodiscard]] Voxels map_of(const std::string& frames) const {
    run_well({"integrate", frames, "--voxel", "0.011", "--workspace=-0.3,-0.3,-0.3,0.3,0.3,0.3",
              "--out", "map.vdb", "--json"});
    Voxels voxels;
    load_vdb(dir / "map.vdb").for_each_occupied([&](const auto& voxel) {
      voxels.insert({voxel.voxel.x, voxel.voxel.y, voxel.voxel.z});
    });
    return voxels;
  }

  // The true frames with other poses.
  void write_posed_frames(const std::string& name, double late) const {
    fs::copy(data("frames"), dir / name);
    for (std::size_t number = 1; number <= kFrames; ++number) {
      const auto m = pose_at(time_of_frame(number) + late).m;
      std::string text;
      for (std::size_t i = 0; i < 12; ++i) text += std::to_string(m[i]) + " ";
      const std::string file = "/frame-0000" + std::string(number < 10 ? "0" : "");
      write(name + file + std::to_string(number) + ".pose.txt", text + "0 0 0 1\n");
    }
  }
};

TEST_F(ReferenceRecordings, GiveTheMapOfTheirFrames) {
  const Voxels good = map_of(data("frames"));
  ASSERT_GT(good.size(), 300U);
  const FrameSequence expected = open_frames(data("frames"));
  for (const std::string name : kRecordings) {
    const test::ProgramResult result = import(data(name));
    ASSERT_EQ(result.exit_code, 0) << name << result.err;
    const json report = json::parse(result.out);
    EXPECT_EQ(report["frames"], kFrames) << name;
    EXPECT_EQ(report["bad"], (json{{"no_pose", 2}})) << name;
    EXPECT_EQ(report["world"], "world") << name;
    EXPECT_EQ(report["intrinsics"], (json{70, 70, 31.5, 23.5})) << name;  // P's, not K's
    const FrameSequence frames = open_frames(dir / "frames");
    ASSERT_EQ(frames.images.size(), kFrames) << name;
    for (std::size_t i = 0; i < kFrames; ++i) {
      EXPECT_EQ(frames.images[i].filename(), expected.images[i].filename());
      const Pose off = expected.poses[i].inverse() * frames.poses[i];
      EXPECT_LE(off.translation().norm(), 0.0004) << name << ' ' << i;  // the chord of the circle
      EXPECT_LE(std::abs(off.m[1]) + std::abs(off.m[2]) + std::abs(off.m[6]), 1e-4) << name;
      const DepthFrame frame = load_frame(frames, i), known = load_frame(expected, i);
      // The recording of 32FC1 has four other pixels, and a finer unit.
      const bool is_float = name == "arm_lz4.mcap";
      for (std::size_t k = is_float ? 4 : 0; k < known.depth.size(); ++k) {
        ASSERT_NEAR(frame.depth[k], known.depth[k], 1e-6) << name << ' ' << i << ' ' << k;
      }
      if (!is_float) continue;
      EXPECT_EQ(frame.depth[0], DepthFrame::kOutOfRange);
      for (const std::size_t k : {1U, 2U, 3U}) EXPECT_EQ(frame.depth[k], DepthFrame::kInvalid);
    }
    const double off = difference(good, map_of("frames"));
    RecordProperty("difference_" + name, std::to_string(off));
    EXPECT_LE(off, 0.02) << name;
  }
}

// What the recordings are made to tell.
TEST_F(ReferenceRecordings, NearestTransformsAndLogTimesGiveOtherMaps) {
  const Voxels good = map_of(data("frames"));
  for (const double late : {0.0, 0.5 / 30, 0.08}) {
    write_posed_frames("late", late);
    const double off = difference(good, map_of("late"));
    RecordProperty("difference_" + std::to_string(late), std::to_string(off));
    EXPECT_TRUE(late == 0 ? off < 0.02 : off > 0.1) << late << ": " << off;
    fs::remove_all(dir / "late");
  }
}

TEST_F(ReferenceRecordings, ThatAreCutAreReadAsFarAsTheyGo) {
  for (const std::string name : kRecordings) {
    if (name == "split") continue;
    const std::string ending = fs::path(name).extension();
    fs::copy_file(data(name), dir / ("cut" + ending));
    fs::resize_file(dir / ("cut" + ending), fs::file_size(dir / ("cut" + ending)) * 6 / 10);
    const test::ProgramResult result = import("cut" + ending);
    ASSERT_EQ(result.exit_code, 0) << name << result.err;
    const json report = json::parse(result.out);
    EXPECT_GT(report["frames"], kFrames / 3) << name;
    EXPECT_LT(report["frames"], kFrames) << name;
    const std::string used =
        ending == ".db3" ? "the part before the damage is used" : "the complete records are used";
    EXPECT_NE(result.err.find(used), std::string::npos) << result.err;
    fs::remove(dir / ("cut" + ending));
  }
  // Of a split recording the second half alone has no static transforms.
  fs::create_directories(dir / "half");
  fs::copy_file(data("split/arm_10.mcap"), dir / "half/arm_10.mcap");
  EXPECT_NE(import("half").err.find("no transform leads to the frame"), std::string::npos);
}

TEST_F(ReferenceRecordings, DamagedChunksAreLeftOutAndSaid) {
  const auto import_damaged = [&](const std::string& name, std::size_t at) {
    write("damaged.mcap", "");
    fs::copy_file(data(name), dir / "damaged.mcap", fs::copy_options::overwrite_existing);
    std::string bytes = read("damaged.mcap");
    bytes[at] = static_cast<char>(bytes[at] ^ 1);
    write("damaged.mcap", bytes);
    return import("damaged.mcap");
  };
  // The only chunk, and a later one of several.
  test::ProgramResult result = import_damaged("split/arm_9.mcap", 12000);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("checksum does not match"), std::string::npos) << result.err;
  result = import_damaged("arm_zstd.mcap", 14000);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("left out"), std::string::npos) << result.err;
  const std::size_t frames = json::parse(result.out)["frames"];
  EXPECT_GE(frames, kFrames / 3);
  EXPECT_LT(frames, kFrames);
}

}  // namespace
}  // namespace viewgain
