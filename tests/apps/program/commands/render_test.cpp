// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <set>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"
#include "program/cli/json.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/png.hpp"

namespace viewgain {
namespace {

// How many colours a picture has.
std::size_t colours(const RgbImage& image) {
  std::set<std::array<std::uint8_t, 3>> found;
  for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
    found.insert({image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]});
  }
  return found.size();
}

class Render : public test::ProgramTest {
 protected:
  Render() {
    write_cube();
    write_half_sensor();
  }
  // A run of two views of the cube.
  void make_run(const std::string& name, const std::vector<std::string>& more = {}) const {
    run_well(
        test::joined({"reconstruct", "cube.off", "--size", "0.3", "--sensor", "tof.toml", "--voxel",
                      "0.01", "--out", name, "--max-views", "2", "--json", "--quiet"},
                     more));
  }
  [[nodiscard]] RgbImage rendered(std::vector<std::string> call) const {
    call.insert(call.begin(), "render");
    call.insert(call.end(), {"--out", "picture.png"});
    run_well(call);
    return read_rgb_png(dir / "picture.png");
  }
};

TEST_F(Render, EachKindIsAPictureOfTheSizeThatWasAsked) {
  make_run("run");
  const std::vector<std::vector<std::string>> kinds{
      {"run", "--what", "map"},
      {"run/map.vdb", "--what", "surface"},
      {"run", "--what", "sigma"},
      {"run", "--what", "sigma", "--ellipsoids", "2"},
      {"run", "--what", "gain", "--sphere", "50,0.6"},
      {"run", "--what", "surface", "--azimuth", "120", "--elevation", "-10"}};
  std::vector<RgbImage> pictures;
  for (std::vector<std::string> call : kinds) {
    call.insert(call.end(), {"--width", "320"});
    pictures.push_back(rendered(call));
    EXPECT_EQ(pictures.back().width, 320);
    EXPECT_EQ(pictures.back().height, 240);
    EXPECT_GT(colours(pictures.back()), 50U) << call[2];
    for (std::size_t i = 0; i + 1 < pictures.size(); ++i) {
      EXPECT_NE(pictures[i].pixels, pictures.back().pixels) << i << ", " << call[2];
    }
  }
  EXPECT_EQ(pictures.size(), 6U);
}

TEST_F(Render, SaysWhatItCannotDraw) {
  make_run("run", {"--pictures", "off"});
  const test::Refusals cases{
      {{"run", "--what", "gain"}, "--sphere"},
      {{"run", "--what", "map", "--ellipsoids", "2"}, "--ellipsoids goes with --what sigma"},
      {{"run", "--what", "sigma", "--ellipsoids", "0"}, "--ellipsoids"},
      {{"no-such-run", "--what", "map"}, "no-such-run"},
      {{"cube.off", "--what", "map"}, "cube.off"}};
  expect_refused_with({"render", "--out", "picture.png"}, cases);
  expect_refused({"render", "run", "--what", "map", "--out", "map.jpg"}, ".png");
}

TEST_F(Render, WhatCannotBeShownOrReadIsNamed) {
  make_run("run");
  // What is read is not written, and odd names are bad input.
  const std::string before = read("run/views/00.png");
  for (const std::vector<std::string>& call :
       {std::vector<std::string>{"run", "--what", "map", "--out", "run/views/00.png"},
        {std::string(300, 'n'), "--what", "map", "--out", "odd.png"}}) {
    std::vector<std::string> all = call;
    all.insert(all.begin(), "render");
    const test::ProgramResult result = run(all);
    EXPECT_EQ(result.exit_code, 2) << result.err;
  }
  EXPECT_EQ(read("run/views/00.png"), before);
}

TEST_F(Render, MapsRememberTheirSensor) {
  make_run("run");
  const json info = json::parse(run_well({"info", "run/map.vdb", "--json"}));
  const std::string sensor = info.at("sensor");
  EXPECT_FALSE(sensor.empty());
  // A map of two does not say which.
  run_well({"simulate", "cube.off", "--orbit", "1,0.6,20", "--size", "0.3", "--sensor", "d435",
            "--out", "frames"});
  const test::ProgramResult two =
      run({"integrate", "frames", "--map", "run/map.vdb", "--out", "two.vdb"});
  EXPECT_EQ(two.exit_code, 0);
  EXPECT_NE(two.err.find("not from this d435"), std::string::npos) << two.err;
  EXPECT_TRUE(json::parse(run_well({"info", "two.vdb", "--json"})).at("sensor").is_null());

  // It goes through convert, not into a tree.
  run_well({"convert", "run/map.vdb", "again.vdb"});
  EXPECT_EQ(json::parse(run_well({"info", "again.vdb", "--json"})).at("sensor"), sensor);
  run_well({"convert", "run/map.vdb", "tree.ot"});
  const test::ProgramResult none = run({"score", "tree.ot", "--sphere", "20,0.6"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.err.find("--sensor"), std::string::npos) << none.err;
}

}  // namespace
}  // namespace viewgain
