// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// `model --watch` beside a program that writes masks of the robot's arm, or confidences, with its
// frames.

#include <cstddef>
#include <filesystem>
#include <string>

#include "apps/program_runner.hpp"
#include "support/pose_file_text.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain {
namespace {

using test::matrix_text;

constexpr std::size_t kFrames = 6;
constexpr int kWidth = 48, kHeight = 36;  // [px]

// Views of a cube: in "clean" as they are; those that come into "live" show an arm, too.
class WatchMasks : public test::ProgramTest {
 protected:
  WatchMasks() {
    write_cube();
    write_small_sensor();
    run_well({"simulate", "cube.off", "--poses", "orbit:" + std::to_string(kFrames) + ",0.6,27",
              "--sensor", "small.toml", "--size", "0.2", "--place", "center", "--out", "clean"});
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

  static Strings watch(const Strings& more = {"--mask", "live/masks"}) {
    return test::joined(call("model", "live", "plan", more), {"--watch"});
  }

  // What `model --watch` with these flags says in the end.
  json watch_well(const Strings& more) const {
    return json::parse(run_well(test::joined(watch(more), {"--json", "--quiet"})));
  }

  // By `integrate`, which counts what `model` counts for its gain.
  json integrate(const std::string& frames, const Strings& more) const {
    return json::parse(run_well(test::joined(call("integrate", frames, "map.vdb", more),
                                             {"--depth-scale", "1e-4", "--json", "--quiet"})));
  }

  Strings images, poses, masks, confidences;  // the files' bytes
};

TEST_F(WatchMasks, AMaskedArmIsNoPartOfTheMap) {
  for (std::size_t i = 0; i < kFrames; ++i) {
    put(i);
    put_mask(i);
    write("sure/" + name(i) + ".depth.png", confidences[i]);
  }
  write("live/done", "");
  const json expected = integrate("clean", {"--mask", "live/masks"});
  for (const Strings& flags : {Strings{"--mask", "live/masks"}, Strings{"--confidence", "sure,2"},
                               Strings{"--mask", "live/masks", "--confidence", "sure,2"}}) {
    const json said = watch_well(flags);
    EXPECT_EQ(said["frames"], kFrames);
    EXPECT_EQ(said["hash"], expected["hash"]) << flags[0];
    EXPECT_GT(said["masked_pixels"], 0);
    EXPECT_EQ(said["masked_pixels"], integrate("live", flags)["masked_pixels"]) << flags[0];
    fs::remove_all(dir / "plan");
  }
  for (const Strings& flags : {Strings{}, Strings{"--confidence", "sure"}}) {
    // An arm that moves with the camera is no part of the scene.
    const test::ProgramResult result = run(test::joined(watch(flags), {"--json", "--quiet"}));
    EXPECT_NE(result.err.find("lie in space that other frames saw as free"), std::string::npos);
    const json said = json::parse(result.out);
    EXPECT_NE(said["hash"], expected["hash"]);
    EXPECT_EQ(said["masked_pixels"], 0);
    fs::remove_all(dir / "plan");
  }
  const std::string text = run_well(test::joined(watch(), {"--quiet"}));
  EXPECT_NE(text.find("pixels removed by masks: "), std::string::npos) << text;
}

TEST_F(WatchMasks, RefusesFoldersThatCannotHoldMasks) {
  put(0);
  write("live/done", "");
  expect_refused_with(watch({}), {{{"--mask", "live"}, "live"},
                                  {{"--confidence", "live/masks/.."}, "--confidence"},
                                  {{"--mask", "nowhere"}, "nowhere"},
                                  {{"--mask", ""}, "--mask"},
                                  {{"--mask", "plan"}, "--out plan"},
                                  {{"--confidence", "sure,0"}, "0"},
                                  {{"--confidence", "sure,256"}, "256"}});
}

}  // namespace
}  // namespace viewgain
