// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// `viewgain model` on a folder of frames, and `next` on what it leaves, as a user would run them.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain {
namespace {

const Strings kMapFlags{"--voxel", "0.01", "--workspace", "-0.2,-0.2,-0.2,0.2,0.2,0.2"};

class RecordedFrames : public test::ProgramTest {
 protected:
  RecordedFrames() {
    write_cube();
    write_half_sensor();
    run_well({"simulate", "cube.off", "--poses", "orbit:3,0.6,27,0,46", "--sensor", "tof.toml",
              "--size", "0.2", "--place", "center", "--noise", "on", "--out", "frames"});
  }

  json model(const std::string& out, const Strings& more = {}) const {
    const Strings arguments =
        test::joined({"model", "frames", "--out", out, "--json"}, test::joined(kMapFlags, more));
    return json::parse(run_well(arguments));
  }

  // What the folder of a run holds of its own.
  [[nodiscard]] std::string hash_of(const std::string& map) const {
    return json::parse(run_well({"info", map, "--json"})).at("hash").get<std::string>();
  }
};

TEST_F(RecordedFrames, SettingsHaveEveryFlagThatCanChangeTheAnswer) {
  const json settings =
      model("run", {"--pictures", "off", "--scales", "1", "--fine", "0,0,0,1,1,1", "--obstacle",
                    "0.9,0.9,0.9,1,1,1", "--hazard", "size=0.3,5"})["settings"];
  EXPECT_EQ(settings["out_of_range"], "carve");
  EXPECT_EQ(settings["hazard"], "size=0.3,5");
  EXPECT_EQ(settings["seed"], 1);
  // Where results go, how fast, what is shown; the body is in the sensor.
  const std::set<std::string> elsewhere{"out",  "save_maps", "pictures",  "report", "resume",
                                        "body", "watch",     "max_views", "stop"};
  std::istringstream help(run_well({"model", "--help"}));
  std::size_t flags = 0;
  for (std::string line; std::getline(help, line);) {
    if (!line.starts_with("  --")) continue;
    std::string name = line.substr(4, line.find(' ', 4) - 4);
    std::replace(name.begin(), name.end(), '-', '_');
    if (elsewhere.contains(name)) continue;
    if (name == "obstacle") name = "obstacles";
    EXPECT_TRUE(settings.contains(name == "scales" ? "coarsest" : name)) << line;
    ++flags;
  }
  // The frames have no flag, the prior follows from others, four flags have two numbers.
  EXPECT_EQ(flags + 6, settings.size());
}

// Map, surface and next views are those that the other subcommands make of the same frames.
TEST_F(RecordedFrames, ModelIsIntegrateSurfaceAndNextInOne) {
  const json run = model("run", {"--pictures", "off"});
  EXPECT_EQ(run["views"], 3);
  EXPECT_EQ(run["stop_reason"], "no_frames");
  EXPECT_EQ(list("run"), (Strings{"config.toml", "map.vdb", "next.json", "next.txt", "points.ply",
                                  "run.json", "surface.ply", "views.txt"}));
  EXPECT_EQ(json::parse(read("run/run.json")), run);
  const json repeated = json::parse(run_well({"model", "--config", "run/config.toml", "--out",
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
  EXPECT_EQ(
      first_lines(run_well(test::joined({"model", "--pictures", "off", "--out", "run"}, map))),
      told);
  // A run's folder stands for its map.
  const json of_map = json::parse(run_well({"info", "map.vdb", "--json"}));
  const json of_run = json::parse(run_well({"info", "run", "--json"}));
  for (const char* key : {"workspace", "dims", "unknown", "free", "occupied", "hash"}) {
    EXPECT_EQ(of_run[key], of_map[key]) << key;
  }
}

// Frames that carve alone leave nothing to plan on, unless they show the table.
TEST_F(RecordedFrames, AMapWithoutASurfaceIsToldOf) {
  const std::string kWords = "no voxel is occupied. Does the workspace contain the object";
  // Before the cube and beside it.
  const Strings beside{"--voxel", "0.02", "--workspace", "0.15,-0.1,0,0.3,0.1,0.15"};
  const test::ProgramResult integrated =
      run(test::joined({"integrate", "frames", "--out", "map.vdb"}, beside));
  EXPECT_EQ(integrated.exit_code, 0) << integrated.err;
  EXPECT_NE(integrated.err.find(kWords), std::string::npos) << integrated.err;
  const Strings model{"model", "frames", "--pictures", "off", "--out", "run"};
  const test::ProgramResult made = run(test::joined(model, beside));
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_NE(made.err.find(kWords), std::string::npos) << made.err;

  run_well({"simulate", "cube.off", "--poses", "orbit:3,0.6,40,0,46", "--sensor", "tof.toml",
            "--size", "0.2", "--place", "center", "--support-plane", "-0.1", "--out", "table"});
  const test::ProgramResult table =
      run({"model", "table", "--voxel", "0.02", "--workspace", "0.15,-0.1,-0.1,0.3,0.1,0.1",
           "--support-plane", "-0.1", "--pictures", "off", "--out", "run"});
  EXPECT_EQ(table.exit_code, 0) << table.err;
  EXPECT_EQ(table.err.find(kWords), std::string::npos) << table.err;
  EXPECT_NE(table.out.find(" 0 occupied"), std::string::npos) << table.out;
}

// Units that were mistaken for metres are named, whatever they make of the map.
TEST_F(RecordedFrames, MillimetresAreToldOf) {
  run_well({"simulate", "cube.off", "--poses", "orbit:6,0.6,10", "--sensor", "tof.toml", "--size",
            "0.2", "--place", "center", "--background", "0", "--out", "units"});
  const auto said = [this](const Strings& more) {
    return run(test::joined({"integrate", "units", "--out", "units.vdb"}, more)).err;
  };
  const auto expect = [](const std::string& text, const std::string& word) {
    EXPECT_NE(text.find(word), std::string::npos) << text;
  };
  expect(said({"--voxel", "5"}),
         "at --voxel 5 m, the longest side of the workspace has only 2 voxels");
  expect(said({"--voxel", "0.005", "--depth-scale", "1e-3"}),
         "Perhaps the correct depth scale is 10 times smaller");
  expect(said({"--voxel", "0.005", "--depth-scale", "2e-4"}),
         "Perhaps the correct depth scale is 2 times smaller");
  expect(said({"--voxel", "0.01", "--depth-scale", "4e-4", "--workspace",
               "-0.2,-0.2,-0.2,0.2,0.2,0.2"}),
         "Perhaps the correct depth scale is 4 times smaller");
  PoseList list = read_tum(dir / "units/poses.txt");
  for (Pose& pose : list.poses) pose = {pose.rotation(), 1000 * pose.translation()};
  write_tum(dir / "units/poses.txt", list.poses);
  expect(said({"--voxel", "0.01"}), "the poses are in millimetres");
}

// Where the workspace holds the cameras, and where it does not.
TEST_F(RecordedFrames, NextStaysInTheRoomThatFramesWereTakenIn) {
  run_well({"simulate", "cube.off", "--poses", "orbit:16,0.6,10,0,46", "--sensor", "tof.toml",
            "--size", "0.2", "--place", "center", "--noise", "on", "--out", "round"});
  const auto views_within = [this](const std::string& half, const Strings& more) {
    const std::string corner = half + "," + half + "," + half;
    const std::string workspace = "-" + half + ",-" + half + ",-" + half + "," + corner;
    const Strings arguments{"model",          "round",   "--distance", "0.56",  "--body",
                            "0.01,0.01,0.01", "--voxel", "0.02",       "--top", "1000",
                            "--workspace",    workspace, "--pictures", "off",   "--out",
                            "round_run",      "--json"};
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
  model("run", {"--pictures", "off"});
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
  const json run = model("run", {"--report", "on"});
  EXPECT_EQ(list("run/views"), (Strings{"00.png", "01.png", "02.png"}));
  const std::string page = read("run/report.html");
  EXPECT_NE(page.find("\"truth\":null"), std::string::npos);
  EXPECT_NE(page.find("frame-000002.depth.png"), std::string::npos);
  EXPECT_EQ(run["per_view"].size(), 3U);
}

TEST_F(RecordedFrames, WhatOnlyAMeshOrAMapHasIsRefused) {
  model("run", {"--pictures", "off"});
  std::filesystem::create_directories(dir / "empty");
  const Strings frames = test::joined({"model", "frames", "--out", "new"}, kMapFlags);
  expect_refused(
      {{test::joined(frames, {"--size", "0.2"}), "--size: model has no such flag"},
       {test::joined(frames, {"--policy", "random"}), "--policy"},
       {test::joined(frames, {"--max-views", "2"}), "--max-views"},
       {test::joined(frames, {"--noise", "on"}), "--noise"},
       {test::joined(frames, {"--pose-noise", "0.01,1"}), "--noise pose="},
       {test::joined(frames, {"--register", "0,1"}), "--register 0"},
       {test::joined(frames, {"--register", "maybe"}), "--register maybe"},
       {test::joined(frames, {"--on-contradiction", "keep"}), "requires --register on"},
       {test::joined(frames, {"--gain", "frontier_count"}), "--gain"},
       {test::joined(frames, {"--mask", "empty"}), "empty"},
       {{"model", "empty", "--voxel", "0.01", "--out", "new"}, "empty"},
       {{"model", "frames", "--voxel", "0.01", "--workspace", "5,5,5,6,6,6", "--out", "new"},
        "none of"},
       {{"reconstruct", "cube.off", "--voxel", "0.01", "--out", "new"}, "--sensor"},
       {{"reconstruct", "cube.off", "--voxel", "0.01", "--sensor", "tof.toml", "--size", "0.2",
         "--mask", "empty", "--out", "new"},
        "--mask: reconstruct has no such flag"},
       {{"reconstruct", "frames", "--voxel", "0.01", "--sensor", "tof.toml", "--out", "new"},
        "viewgain model frames"},
       {{"model", "frames", "--vxel", "0.01"}, "did you mean --voxel?"},
       {{"follow", "frames"}, "viewgain model FRAMES_DIR --watch"},
       {{"candidates", "run"}, "viewgain next MAP --top all"},
       {{"next", "run/map.vdb", "--voxel", "0.01"}, "--voxel"},
       {{"next", "frames"}, "viewgain model frames"},
       {{"next", "run/map.vdb", "--gain", "paper", "--hazard", "size=0.5"}, "--hazard"},
       {{"next", "run/map.vdb", "--out", "run/map.vdb"}, "map.vdb"},
       {{"next", "none.vdb"}, "none.vdb"}});
}

}  // namespace
}  // namespace viewgain
