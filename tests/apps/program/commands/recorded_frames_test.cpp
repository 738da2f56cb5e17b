// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// `viewgain reconstruct` and `next` on a folder of frames, as a user would run them.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"
#include "program/cli/json.hpp"
#include "viewgain/core/pose_io.hpp"

namespace viewgain {
namespace {

const Strings kMapFlags{"--voxel", "0.01", "--workspace", "-0.2,-0.2,-0.2,0.2,0.2,0.2"};

class RecordedFrames : public test::ProgramTest {
 protected:
  RecordedFrames() {
    write_cube();
    write_half_sensor();
    run_well({"simulate", "cube.off", "--orbit", "3,0.6,27,0,46", "--sensor", "tof.toml", "--size",
              "0.2", "--recenter", "on", "--noise", "on", "--out", "frames"});
  }

  json reconstruct(const std::string& out, const Strings& more = {}) const {
    const Strings arguments = test::joined({"reconstruct", "frames", "--out", out, "--json"},
                                           test::joined(kMapFlags, more));
    return json::parse(run_well(arguments));
  }

  // What the folder of a run holds of its own.
  [[nodiscard]] std::string hash_of(const std::string& map) const {
    return json::parse(run_well({"info", map, "--json"})).at("hash").get<std::string>();
  }
};

TEST_F(RecordedFrames, SettingsHaveEveryFlagThatCanChangeTheAnswer) {
  const json settings = reconstruct(
      "run", {"--pictures", "off", "--coarsest", "1", "--fine", "0,0,0,1,1,1", "--obstacle",
              "0.9,0.9,0.9,1,1,1", "--hazard", "5", "--object-size", "0.3"})["settings"];
  EXPECT_EQ(settings["out_of_range"], "carve");
  EXPECT_EQ(settings["hazard"], "5");
  EXPECT_EQ(settings["object_size"], 0.3);
  EXPECT_EQ(settings["seed"], 1);
  // Where results go, how fast, what is shown; the body is in the sensor.
  const std::set<std::string> elsewhere{"help",   "json",   "threads",     "out",    "save_maps",
                                        "trace",  "quiet",  "save_config", "config", "pictures",
                                        "report", "resume", "beside",      "body"};
  const std::string both = run_well({"reconstruct", "--help"});
  std::istringstream help(both.substr(both.rfind("Usage: ")));  // of frames
  std::size_t flags = 0;
  for (std::string line; std::getline(help, line);) {
    const std::size_t begin = line.find_first_not_of(' ');
    if (begin == std::string::npos || line[begin] != '-') continue;
    const std::size_t dashes = line.find("--");
    std::string name = line.substr(dashes + 2, line.find_first_of(" ,", dashes) - dashes - 2);
    std::replace(name.begin(), name.end(), '-', '_');
    if (elsewhere.contains(name)) continue;
    EXPECT_TRUE(settings.contains(name == "obstacle" ? "obstacles" : name)) << line;
    ++flags;
  }
  EXPECT_EQ(flags + 2, settings.size());  // the frames have no flag; the prior follows from others
}

// Map, surface and next views are those that the other subcommands make of the same frames.
TEST_F(RecordedFrames, ReconstructIsIntegrateSurfaceAndNextInOne) {
  const json run = reconstruct("run", {"--pictures", "off"});
  EXPECT_EQ(run["views"], 3);
  EXPECT_EQ(run["stop_reason"], "no_frames");
  EXPECT_EQ(list("run"), (Strings{"config.toml", "map.vdb", "next.txt", "points.ply", "run.json",
                                  "surface.ply", "views.txt"}));
  EXPECT_EQ(json::parse(read("run/run.json")), run);
  const json repeated = json::parse(run_well({"reconstruct", "--config", "run/config.toml", "--out",
                                              "again", "--pictures", "off", "--json", "--quiet"}));
  EXPECT_EQ(repeated["next"], run["next"]);
  EXPECT_EQ(repeated["settings"], run["settings"]);
  run_well(test::joined({"integrate", "frames", "--out", "map.vdb"}, kMapFlags));
  EXPECT_EQ(run["map_hash"], hash_of("map.vdb"));
  run_well({"surface", "map.vdb", "--out", "s.ply", "--points", "p.ply"});
  EXPECT_EQ(read("run/surface.ply"), read("s.ply"));
  EXPECT_EQ(read("run/points.ply"), read("p.ply"));
  const std::vector<Pose> views = read_tum(dir / "run/views.txt").poses;
  const std::vector<Pose> poses = read_tum(dir / "frames/poses.txt").poses;
  ASSERT_EQ(views.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT((views[i].translation() - poses[i].translation()).norm(), 1e-12);
    EXPECT_LT((views[i].rotation() - poses[i].rotation()).norm(), 1e-12);
  }

  run_well({"next", "run/map.vdb", "--out", "n.txt"});
  EXPECT_EQ(read("n.txt"), read("run/next.txt"));
  // Frames that the map has are known as such.
  const json again = json::parse(
      run_well({"integrate", "frames", "--map", "run/map.vdb", "--out", "same.vdb", "--json"}));
  EXPECT_EQ(again["skipped"], 3);
}

// The box and its voxels, as integrate says them, where nobody named one.
TEST_F(RecordedFrames, TheMapThatWasMadeIsTold) {
  const Strings map{"frames", "--voxel", "0.02"};
  const auto first_lines = [](const std::string& text) {
    return text.substr(0, text.find('\n', text.find('\n') + 1));
  };
  const std::string told =
      first_lines(run_well(test::joined({"integrate", "--out", "map.vdb"}, map)));
  EXPECT_TRUE(told.starts_with("workspace ")) << told;
  EXPECT_EQ(first_lines(run_well(test::joined({"next"}, map))), told);
  EXPECT_EQ(first_lines(
                run_well(test::joined({"reconstruct", "--pictures", "off", "--out", "run"}, map))),
            told);
  const json of_map = json::parse(run_well({"info", "map.vdb", "--json"}));
  const json next = json::parse(run_well(test::joined({"next", "--json"}, map)));
  for (const char* key : {"workspace", "dims", "unknown", "free", "occupied"}) {
    EXPECT_EQ(next[key], of_map[key]) << key;
  }
}

// Frames that carve alone leave nothing to plan on, unless they show the table.
TEST_F(RecordedFrames, AMapWithoutASurfaceIsToldOf) {
  const std::string kWords = "no voxel is occupied: does the workspace hold the object";
  // Before the cube and beside it.
  const Strings beside{"--voxel", "0.02", "--workspace", "0.15,-0.1,0,0.3,0.1,0.15"};
  const test::ProgramResult integrated =
      run(test::joined({"integrate", "frames", "--out", "map.vdb"}, beside));
  EXPECT_EQ(integrated.exit_code, 0) << integrated.err;
  EXPECT_NE(integrated.err.find(kWords), std::string::npos) << integrated.err;
  const test::ProgramResult next = run(test::joined({"next", "frames"}, beside));
  EXPECT_EQ(next.exit_code, 2);
  EXPECT_EQ(next.err.find("warning"), std::string::npos) << next.err;
  EXPECT_NE(next.err.find(kWords), std::string::npos) << next.err;

  run_well({"simulate", "cube.off", "--orbit", "3,0.6,40,0,46", "--sensor", "tof.toml", "--size",
            "0.2", "--recenter", "on", "--support-plane", "-0.1", "--out", "table"});
  const test::ProgramResult table = run({"next", "table", "--voxel", "0.02", "--workspace",
                                         "0.15,-0.1,-0.1,0.3,0.1,0.1", "--support-plane", "-0.1"});
  EXPECT_EQ(table.exit_code, 0) << table.err;
  EXPECT_EQ(table.err.find(kWords), std::string::npos) << table.err;
  EXPECT_NE(table.out.find(" 0 occupied"), std::string::npos) << table.out;
}

// Units that were mistaken for metres are named, whatever they make of the map.
TEST_F(RecordedFrames, MillimetresAreToldOf) {
  run_well({"simulate", "cube.off", "--orbit", "6,0.6,10", "--sensor", "tof.toml", "--size", "0.2",
            "--recenter", "on", "--background", "0", "--out", "units"});
  const auto said = [this](const Strings& more) {
    return run(test::joined({"integrate", "units", "--out", "units.vdb"}, more)).err;
  };
  const auto expect = [](const std::string& text, const std::string& word) {
    EXPECT_NE(text.find(word), std::string::npos) << text;
  };
  expect(said({"--voxel", "5"}), "--voxel 5 m leaves 2 voxels");
  expect(said({"--voxel", "0.005", "--depth-scale", "1e-3"}),
         "if the depth scale is 10 times smaller");
  expect(said({"--voxel", "0.005", "--depth-scale", "2e-4"}),
         "if the depth scale is 2 times smaller");
  expect(said({"--voxel", "0.01", "--depth-scale", "4e-4", "--workspace",
               "-0.2,-0.2,-0.2,0.2,0.2,0.2"}),
         "if the depth scale is 4 times smaller");
  PoseList list = read_tum(dir / "units/poses.txt");
  for (Pose& pose : list.poses) pose = {pose.rotation(), 1000 * pose.translation()};
  write_tum(dir / "units/poses.txt", list.poses);
  expect(said({"--voxel", "0.01"}), "the poses are in millimetres");
}

// Where the workspace holds the cameras, and where it does not.
TEST_F(RecordedFrames, NextStaysInTheRoomThatFramesWereTakenIn) {
  run_well({"simulate", "cube.off", "--orbit", "16,0.6,10,0,46", "--sensor", "tof.toml", "--size",
            "0.2", "--recenter", "on", "--noise", "on", "--out", "round"});
  const auto views_within = [this](const std::string& half, const Strings& more) {
    const std::string corner = half + "," + half + "," + half;
    const std::string workspace = "-" + half + ",-" + half + ",-" + half + "," + corner;
    const Strings arguments{"next",           "round",   "--distance", "0.56",  "--body",
                            "0.01,0.01,0.01", "--voxel", "0.02",       "--top", "1000",
                            "--workspace",    workspace, "--json"};
    return json::parse(run_well(test::joined(arguments, more)));
  };
  const auto farthest = [](const json& next) {
    double most = 0;
    for (const json& view : next["next"]) {
      for (std::size_t a = 0; a < 3; ++a) {
        most = std::max(most, std::abs(view["T_world_camera"][a][3].get<double>()));
      }
    }
    return most;
  };
  const json room = views_within("0.62", {});
  EXPECT_GT(room["next"].size(), 0U);
  EXPECT_GT(room["dropped"]["unreachable"], 0);
  EXPECT_LE(farthest(room), 0.62);
  // Who says where the camera may be is believed.
  write("all.toml", "[[half_space]]\nnormal = [0, 0, 1]\noffset = -9\n");
  const json anywhere = views_within("0.62", {"--reach", "all.toml"});
  EXPECT_FALSE(anywhere["dropped"].contains("unreachable"));
  EXPECT_GT(anywhere["candidates"], room["candidates"]);
  EXPECT_GT(farthest(anywhere), 0.62);
  const json from_outside = views_within("0.4", {});
  EXPECT_FALSE(from_outside["dropped"].contains("unreachable"));
  EXPECT_GT(farthest(from_outside), 0.4);
}

TEST_F(RecordedFrames, NextSaysInWordsWhatItFound) {
  reconstruct("run", {"--pictures", "off"});
  const std::string text = run_well({"next", "run/map.vdb", "--top", "2"});
  EXPECT_NE(text.find("3 views so far"), std::string::npos) << text;
  EXPECT_NE(text.find("gain [nat]"), std::string::npos) << text;
  EXPECT_NE(text.find("boundary "), std::string::npos) << text;
  // Nothing can be reached: that is an answer.
  write("nowhere.toml", "[[box]]\nmin = [90, 90, 90]\nmax = [91, 91, 91]\n");
  const std::string none =
      run({"next", "run/map.vdb", "--reach", "nowhere.toml", "--out", "none.txt"}).out;
  EXPECT_NE(none.find("no view is possible; dropped: "), std::string::npos) << none;
  EXPECT_NE(none.find("unreachable"), std::string::npos) << none;
  EXPECT_EQ(read("none.txt"), "# timestamp tx ty tz qx qy qz qw\n");
}

TEST_F(RecordedFrames, ReportAndPicturesShowTheFrames) {
  if (!has_report_page()) GTEST_SKIP() << "built without npm";
  const json run = reconstruct("run", {"--report", "on"});
  EXPECT_EQ(list("run/views"), (Strings{"00.png", "01.png", "02.png"}));
  const std::string page = read("run/report.html");
  EXPECT_NE(page.find("\"truth\":null"), std::string::npos);
  EXPECT_NE(page.find("frame-000002.depth.png"), std::string::npos);
  EXPECT_EQ(run["per_view"].size(), 3U);
}

TEST_F(RecordedFrames, WhatOnlyAMeshOrAMapHasIsRefused) {
  reconstruct("run", {"--pictures", "off"});
  std::filesystem::create_directories(dir / "empty");
  const Strings frames = test::joined({"reconstruct", "frames", "--out", "new"}, kMapFlags);
  expect_refused(
      {{test::joined(frames, {"--size", "0.2"}), "--size: goes with MESH, not FRAMES_DIR (see"},
       {test::joined(frames, {"--policy", "random"}), "--policy"},
       {test::joined(frames, {"--max-views", "2"}), "--max-views"},
       {test::joined(frames, {"--noise", "on"}), "--noise"},
       {test::joined(frames, {"--pose-noise", "0.01,1"}), "--pose-noise"},
       {test::joined(frames, {"--pose-sigma", "0.01,1"}), "--pose-sigma"},
       {test::joined(frames, {"--pose-sigma", "0,1", "--register", "on"}), "--pose-sigma"},
       {test::joined(frames, {"--on-contradiction", "keep"}), "requires --register on"},
       {test::joined(frames, {"--gain", "frontier_count"}), "--gain"},
       {test::joined(frames, {"--mask", "empty"}), "empty"},
       {{"reconstruct", "empty", "--voxel", "0.01", "--out", "new"}, "empty"},
       {{"reconstruct", "frames", "--voxel", "0.01", "--workspace", "5,5,5,6,6,6", "--out", "new"},
        "none of"},
       {{"reconstruct", "cube.off", "--voxel", "0.01", "--out", "new"}, "--sensor"},
       {{"reconstruct", "cube.off", "--voxel", "0.01", "--sensor", "tof.toml", "--size", "0.2",
         "--mask", "empty", "--out", "new"},
        "--mask: goes with FRAMES_DIR, not MESH"},
       {{"reconstruct", "frames", "--vxel", "0.01"}, "did you mean --voxel?"},
       {{"next", "run/map.vdb", "--voxel", "0.01"}, "--voxel"},
       {{"next", "frames"}, "--voxel"},
       {{"next", "run/map.vdb", "--generator", "dome", "--overlap", "0.5"}, "--overlap"},
       {{"next", "run/map.vdb", "--gain", "paper", "--object-size", "0.5"}, "--object-size"},
       {{"next", "run/map.vdb", "--out", "run/map.vdb"}, "map.vdb"},
       {{"next", "none.vdb"}, "none.vdb"}});
}

}  // namespace
}  // namespace viewgain
