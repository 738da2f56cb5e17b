// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Units and set-ups that are allowed and seldom meant: which commands say so, and of what.

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "apps/program_runner.hpp"
#include "program/commands/frames/frame_tally.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/grid/vdb_io.hpp"

namespace viewgain {
namespace {

constexpr int kWidth = 48, kHeight = 36;  // [px]

// Views of a cube of 0.2 m in a room, and a map of them.
class Implausible : public test::ProgramTest {
 protected:
  Implausible() {
    write_cube();
    write_small_sensor();
    run_well({"simulate", "cube.off", "--poses", "orbit:6,0.6,27", "--sensor", "small.toml",
              "--size", "0.2", "--place", "center", "--background", "1.5", "--out", "frames"});
  }

  [[nodiscard]] static Strings integrate(const Strings& more = {},
                                         const std::string& frames = "frames") {
    return test::joined(
        {"integrate", frames, "--voxel", "0.025", "--workspace", kSmall, "--out", "map.vdb"}, more);
  }

  // Every command that a sensor, an obstacle or a region goes into, on frames and on a map.
  [[nodiscard]] static std::vector<Strings> commands(bool with_views) {
    std::vector<Strings> calls{
        {"model", "frames", "--voxel", "0.025", "--workspace", kSmall, "--pictures", "off", "--out",
         "run"},
        {"model", "frames", "--watch", "--voxel", "0.025", "--workspace", kSmall, "--out", "plan"},
        {"next", "map.vdb"},
        {"next", "map.vdb", "--generator", "sphere", "--count", "20", "--gain", "surface", "--top",
         "all", "--out", "new.txt"},
        {"score", "map.vdb", "--poses", "sphere:20,0.6"}};
    if (!with_views) calls.push_back(integrate());
    return calls;
  }

  // What the command says in warnings; whether it finds a view is another matter.
  [[nodiscard]] std::string warnings(const Strings& call) const {
    fs::remove_all(dir / "plan");
    fs::remove_all(dir / "run");
    const test::ProgramResult result = run(call);
    EXPECT_NE(result.exit_code, -1);
    return result.err;
  }

  void expect_said(const Strings& call, const std::string& words) const {
    const std::string said = warnings(call);
    const std::size_t at = said.find(words);
    EXPECT_NE(at, std::string::npos) << call[0] << ": " << said;
    EXPECT_EQ(said.find(words, at + 1), std::string::npos) << "twice: " << said;
  }

  // Masks in mask/, white where the object is.
  void write_masks(bool of_object) const {
    const FrameSequence frames = open_frames(dir / "frames");
    fs::create_directories(dir / "mask");
    for (const auto& image : frames.images) {
      const GrayImage depth = read_gray_png(image, kWidth, kHeight);
      Gray8Image mask{kWidth, kHeight, {}};
      for (const auto unit : depth.pixels) {
        const bool is_object = unit > 0 && unit < 8000;
        mask.pixels.push_back(is_object == of_object ? 255 : 0);
      }
      write_png(dir / "mask" / image.filename(), mask);
    }
  }

  static constexpr const char* kSmall = "-0.2,-0.2,-0.2,0.2,0.2,0.2";
};

TEST_F(Implausible, WhatIsRightIsNotDoubted) {
  run_well(integrate());
  write("frames/done", "");
  for (Strings call : commands(false)) {
    call.insert(call.end(), {"--obstacle", "-0.5,-0.5,-0.3,0.5,0.5,-0.25"});
    EXPECT_EQ(warnings(call).find("warning"), std::string::npos) << warnings(call);
  }
}

TEST_F(Implausible, SensorsInOtherUnits) {
  const Sensor right = load_sensor((dir / "small.toml").string());
  const auto with = [&](auto change) {
    Sensor sensor = right;
    change(sensor);
    write_sensor_toml(dir / "frames/sensor.toml", sensor);
  };
  write("frames/done", "");
  with([](Sensor& s) { s.noise = ConstantNoise{2, 0.005}; });
  (void)run(integrate());
  for (const Strings& call : commands(false))
    expect_said(call, "(sigma_axial) must be for lengths in");
  with([](Sensor& s) { s.body_size = {65, 65, 76}; });
  (void)run(integrate());
  for (const Strings& call : commands(false)) expect_said(call, "body is 65 x 65 x 76 m");
  with([](Sensor& s) { s.pose_sigma = {0.002, 0.5}; });
  expect_said(integrate(), "28.65 degrees");
  // It explains everything: nothing else is blamed.
  with([](Sensor& s) { s.camera.fx = s.camera.fy = 4.2; });
  for (const Strings& call : {integrate(), commands(true)[0], commands(true)[2]}) {
    expect_said(call, "Focal lengths must be in pixels, not in millimetres");
    EXPECT_EQ(warnings(call).find("times"), std::string::npos);
  }
  expect_said({"simulate", "cube.off", "--poses", "orbit:2,0.6,27", "--sensor",
               "frames/sensor.toml", "--size", "0.2", "--out", "other"},
              "Focal lengths must be in pixels");
}

TEST_F(Implausible, FlagsInOtherUnits) {
  run_well(integrate());
  write("frames/done", "");
  write("reach.toml", "[[box]]\nmin = [200.0, -500.0, 0.0]\nmax = [900.0, 500.0, 800.0]\n");
  for (const Strings& call : commands(true)) {
    expect_said(test::joined(call, {"--reach", "reach.toml"}), "--reach reach.toml: ");
    expect_said(test::joined(call, {"--hazard", "size=200"}), "--hazard size: ");
  }
  for (const Strings& call : commands(false)) {
    expect_said(test::joined(call, {"--obstacle", "400,-500,-300,500,500,-250"}),
                "Is the obstacle in metres?");
  }
  for (const Strings& call : commands(false)) {
    expect_said(test::joined(call, {"--support-plane", "-300"}), "--support-plane: ");
  }
  expect_said(integrate({"--register", "5,0.5"}), "standard deviation of poses is 5 m");
}

TEST(RefusedFrames, AreSaidWhereRegistrationLeavesOutMost) {
  const auto said = [](std::size_t used, std::size_t refused) {
    return app::refused_text({{FrameVerdict::used, used},
                              {FrameVerdict::contradicts, refused},
                              {FrameVerdict::wrong_size, 50}});
  };
  EXPECT_NE(said(1, 13).find("13 of 14 frames contradict the other frames"), std::string::npos);
  EXPECT_NE(said(1, 3), "");
  EXPECT_EQ(said(1, 2), "");
  EXPECT_EQ(said(10, 10), "");  // as of a recorded room that overlaps little
  EXPECT_EQ(said(5, 0), "");
}

TEST_F(Implausible, ARoomsClosedMeshIsSolid) {
  run_well(integrate());
  write("frames/done", "");
  write("room.off",
        "OFF\n8 6 0\n-2 -2 -2\n2 -2 -2\n2 2 -2\n-2 2 -2\n-2 -2 2\n2 -2 2\n2 2 2\n-2 2 2\n"
        "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n");
  for (Strings call : commands(true)) {
    if (call[0] == "score") call.insert(call.end(), {"--feasible", "on"});
    expect_said(test::joined(call, {"--obstacle", "room.off"}),
                "views were taken inside an obstacle");
  }
  // The map itself is as good with it.
  EXPECT_EQ(warnings(integrate({"--obstacle", "room.off"})), "");
}

TEST_F(Implausible, MasksThatShowTheObjectInWhite) {
  write("frames/done", "");
  write_masks(true);
  for (const char* workspace : {kSmall, "-1.6,-1.6,-1.6,1.6,1.6,1.6"}) {
    for (const Strings& way : {Strings{"integrate", "frames"}, Strings{"model", "frames"},
                               Strings{"model", "frames", "--watch"}}) {
      fs::remove_all(dir / "out.vdb");
      const std::string said =
          warnings(test::joined(way, {"--voxel", "0.05", "--workspace", workspace, "--mask", "mask",
                                      "--out", "out.vdb"}));
      EXPECT_NE(said.find("invert the masks"), std::string::npos) << way[0] << said;
      EXPECT_EQ(said.find("depth scale"), std::string::npos) << way[0] << said;
      EXPECT_EQ(said.find("camera to world"), std::string::npos) << way[0] << said;
    }
  }
  // Without a workspace none is left to make one round.
  write_masks(true);
  expect_said({"integrate", "frames", "--voxel", "0.05", "--mask", "mask", "--out", "new.vdb"},
              "invert the masks");
  write_masks(false);
  EXPECT_EQ(warnings(integrate({"--mask", "mask"})), "");
}

TEST_F(Implausible, HazardRatesOfAnotherPlaceOrUnit) {
  run_well(integrate());
  const BeliefGrid map = load_vdb(dir / "map.vdb");
  const auto rates_of = [&](const BeliefGrid& grid) {
    HazardConfig::Volume volume;
    volume.box = VoxelBox::from_dims(grid.min_index(), grid.dims());
    volume.rates.assign(static_cast<std::size_t>(volume.box.volume()), 2.0F);
    save_hazard_vdb(volume, grid, dir / "rates.vdb");
    return Strings{"next", "map.vdb", "--hazard", "rates.vdb"};
  };
  const auto grid_of = [](double voxel, double half, double x) {
    return BeliefGrid(
        GridConfig{voxel, {{x - half, -half, -half}, {x + half, half, half}}, {}, 0.1});
  };
  EXPECT_EQ(warnings(rates_of(map)), "");
  EXPECT_EQ(warnings(rates_of(grid_of(0.1, 0.2, 0))), "");
  expect_refused(rates_of(grid_of(2.5, 20, 0)),
                 "have voxels of 2.5 m, but the map has voxels of 0.025 m");
  expect_refused(rates_of(grid_of(0.00025, 0.002, 0)), "have voxels of 0.00025 m");
  expect_refused(rates_of(grid_of(0.025, 0.2, 5)), "all hazard rates lie outside the map");
}

}  // namespace
}  // namespace viewgain
