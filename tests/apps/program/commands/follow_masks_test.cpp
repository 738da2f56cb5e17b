// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// `follow` beside a program that writes masks of the robot's arm, or confidences, with its frames.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "apps/program/commands/pose_file_text.hpp"
#include "apps/program_runner.hpp"
#include "program/cli/json.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/formats/png.hpp"

namespace viewgain {
namespace {

using test::matrix_text;

constexpr std::size_t kFrames = 6;
constexpr int kWidth = 48, kHeight = 36;  // [px]

// Views of a cube: in "clean" as they are; those that come into "live" show an arm, too.
class FollowMasks : public test::ProgramTest {
 protected:
  FollowMasks() {
    write_cube();
    write_small_sensor();
    run_well({"simulate", "cube.off", "--orbit", std::to_string(kFrames) + ",0.6,27", "--sensor",
              "small.toml", "--size", "0.2", "--recenter", "on", "--out", "clean"});
    const FrameSequence frames = open_frames(dir / "clean");
    for (std::size_t i = 0; i < kFrames; ++i) {
      GrayImage depth = read_gray_png(frames.images[i], kWidth, kHeight);
      Gray8Image mask{kWidth, kHeight, {}}, confidence = mask;
      for (std::size_t k = 0; k < depth.pixels.size(); ++k) {
        const bool is_arm = k / kWidth >= 22 + i && k % kWidth >= 10 + i;
        if (is_arm) depth.pixels[k] = 4200;  // 0.42 m: in the workspace
        mask.pixels.push_back(is_arm ? 255 : 0);
        confidence.pixels.push_back(is_arm ? 1 : 2);
      }
      images.push_back(bytes_of(depth));
      masks.push_back(bytes_of(mask));
      confidences.push_back(bytes_of(confidence));
      poses.push_back(matrix_text(frames.poses[i]));
    }
    write("live/sensor.toml", read("small.toml"));
    write("live/depth-scale.txt", "1e-4\n");
    fs::create_directories(dir / "live/masks");
    fs::create_directories(dir / "sure");
  }

  template <typename Image>
  std::string bytes_of(const Image& image) const {
    write_png(dir / "image.png", image);
    return read("image.png");
  }

  static std::string name(std::size_t number) { return "frame-00000" + std::to_string(number); }

  void put(std::size_t number) const {
    write("live/" + name(number) + ".depth.png", images[number]);
    write("live/" + name(number) + ".pose.txt", poses[number]);
  }

  void put_mask(std::size_t number) const { put_mask(number, masks[number]); }
  void put_mask(std::size_t number, const std::string& bytes) const {
    write("live/masks/" + name(number) + ".depth.png", bytes);
  }

  static Strings call(const std::string& subcommand, const std::string& frames,
                      const std::string& out, const Strings& more) {
    return test::joined({subcommand, frames, "--voxel", "0.025", "--workspace",
                         "-0.2,-0.2,-0.2,0.2,0.2,0.2", "--jump-edge-filter", "off", "--out", out},
                        more);
  }

  static Strings follow(const Strings& more = {"--mask", "live/masks"}) {
    return call("follow", "live", "plan", more);
  }

  // What `follow` with these flags says in the end.
  json follow_well(const Strings& more) const {
    return json::parse(run_well(test::joined(follow(more), {"--json", "--quiet"})));
  }

  // By `integrate`, which counts what `follow` counts for its gain.
  json integrate(const std::string& frames, const Strings& more) const {
    return json::parse(run_well(
        test::joined(call("integrate", frames, "map.vdb", more),
                     {"--calibrate-hazard", "on", "--depth-scale", "1e-4", "--json", "--quiet"})));
  }

  Strings images, poses, masks, confidences;  // the files' bytes
};

TEST_F(FollowMasks, AMaskedArmIsNoPartOfTheMap) {
  for (std::size_t i = 0; i < kFrames; ++i) {
    put(i);
    put_mask(i);
    write("sure/" + name(i) + ".depth.png", confidences[i]);
  }
  write("live/done", "");
  const json expected = integrate("clean", {"--mask", "live/masks"});
  for (const Strings& flags :
       {Strings{"--mask", "live/masks"}, Strings{"--confidence", "sure", "--least-confidence", "2"},
        Strings{"--mask", "live/masks", "--confidence", "sure", "--least-confidence", "2"}}) {
    const json said = follow_well(flags);
    EXPECT_EQ(said["frames"], kFrames);
    EXPECT_EQ(said["hash"], expected["hash"]) << flags[0];
    EXPECT_GT(said["masked_pixels"], 0);
    EXPECT_EQ(said["masked_pixels"], integrate("live", flags)["masked_pixels"]) << flags[0];
    fs::remove_all(dir / "plan");
  }
  for (const Strings& flags : {Strings{}, Strings{"--confidence", "sure"}}) {
    const json said = follow_well(flags);
    EXPECT_NE(said["hash"], expected["hash"]);
    EXPECT_EQ(said["masked_pixels"], 0);
    fs::remove_all(dir / "plan");
  }
  const std::string text = run_well(test::joined(follow(), {"--quiet"}));
  EXPECT_NE(text.find("pixels taken away by masks: "), std::string::npos) << text;
}

TEST_F(FollowMasks, WhatHasNoGoodMaskIsLeftOutAndSaid) {
  for (std::size_t i = 0; i < 5; ++i) put(i);
  put_mask(0);
  put_mask(2, bytes_of(Gray8Image{10, 8, std::vector<std::uint8_t>(80)}));
  put_mask(3, images[3]);  // 16 bits
  put_mask(4, masks[4].substr(0, masks[4].size() - 1));
  write("live/done", "");
  const test::ProgramResult result = run(follow());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const json bad{{"no_mask", 1}, {"wrong_size", 1}, {"unreadable", 2}};
  for (const auto& [reason, number] :
       {std::pair("no_mask", 1), {"wrong_size", 2}, {"unreadable", 3}, {"unreadable", 4}}) {
    const std::string file = "live/masks/" + name(static_cast<std::size_t>(number)) + ".depth.png";
    const std::size_t at = result.err.find(file);
    ASSERT_NE(at, std::string::npos) << file;
    EXPECT_NE(result.err.find("(" + std::string(reason) + ")", at), std::string::npos) << reason;
  }
  EXPECT_NE(result.out.find("left out: 1 no_mask, 2 unreadable, 1 wrong_size"), std::string::npos)
      << result.out;
  const json next = json::parse(read("plan/next.json"));
  EXPECT_EQ(next["bad"], bad);
  EXPECT_EQ(next["waiting"], 0);
  EXPECT_EQ(next["frames"], 1);
  EXPECT_EQ(load_map_of_sensor(dir / "plan/state.vdb").frames,
            std::set<std::string>{frame_identity(open_frames(dir / "live"), 0)});

  // When their masks are good they go in.
  put(5);
  for (std::size_t i = 1; i < kFrames; ++i) put_mask(i);
  const json said = follow_well({"--mask", "live/masks"});
  EXPECT_EQ(said["added"], kFrames - 1);
  EXPECT_EQ(said["bad"], json::object());
  EXPECT_EQ(said["hash"], integrate("clean", {"--mask", "live/masks"})["hash"]);
}

TEST_F(FollowMasks, AFolderWithoutMasksIsAnError) {
  put(0);
  put(1);
  write("live/done", "");
  const test::ProgramResult result =
      run(test::joined(follow({"--confidence", "sure"}), {"--quiet"}));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("without a frame; bad: 2 no_mask"), std::string::npos) << result.err;
  EXPECT_FALSE(fs::exists(dir / "plan"));
}

// As `integrate --map` has it: what is in stays as it is, the flags are for what comes.
TEST_F(FollowMasks, OtherFlagsAreForWhatComes) {
  for (std::size_t i = 0; i < 3; ++i) {
    put(i);
    put_mask(i);
  }
  write("live/done", "");
  const json first = follow_well({"--mask", "live/masks"});
  EXPECT_EQ(first["hash"], integrate("live", {"--mask", "live/masks"})["hash"]);
  // With other masks, or none, the frames are the same.
  put_mask(0, bytes_of(Gray8Image{kWidth, kHeight, std::vector<std::uint8_t>(kWidth * kHeight)}));
  put_mask(1, "damaged");
  for (const Strings& flags :
       {Strings{"--mask", "live/masks"}, Strings{"--confidence", "sure"}, Strings{}}) {
    const json said = follow_well(flags);
    EXPECT_EQ(said["added"], 0);
    EXPECT_EQ(said["bad"], json::object());
    EXPECT_EQ(said["hash"], first["hash"]);
  }
  for (std::size_t i = 3; i < kFrames; ++i) put(i);
  const json last = follow_well({});
  EXPECT_EQ(last["added"], 3);
  EXPECT_EQ(last["masked_pixels"], 0);
  const json continued = integrate("live", {"--map", "map.vdb"});
  EXPECT_EQ(continued["skipped"], 3);
  EXPECT_EQ(last["hash"], continued["hash"]);
}

TEST_F(FollowMasks, RefusesFoldersThatCannotHoldMasks) {
  put(0);
  write("live/done", "");
  expect_refused_with(follow({}), {{{"--mask", "live"}, "live"},
                                   {{"--confidence", "live/masks/.."}, "--confidence"},
                                   {{"--mask", "nowhere"}, "nowhere"},
                                   {{"--mask", ""}, "--mask"},
                                   {{"--mask", "plan"}, "--out plan"},
                                   {{"--confidence", "sure", "--least-confidence", "0"}, "0"},
                                   {{"--confidence", "sure", "--least-confidence", "256"}, "256"}});
}

}  // namespace
}  // namespace viewgain
