// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include "apps/program_runner.hpp"
#include "support/pose_file_text.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain {
namespace {

// simulate -> integrate -> info -> score on a cube, each as a user would run it.
class Workflow : public test::ProgramTest {
 protected:
  Workflow() {
    write_cube();
    write_small_sensor();
  }

  void simulate(const std::string& out, const Strings& more = {}) const {
    run_well(test::joined({"simulate", "cube.off", "--poses", "orbit:3,0.6,27,0,46", "--sensor",
                           "small.toml", "--size", "0.3", "--place", "center", "--out", out},
                          more));
  }

  void integrate(const std::string& frames, const std::string& map,
                 const Strings& more = {}) const {
    run_well(test::joined({"integrate", frames, "--voxel", "0.02", "--workspace",
                           "-0.2,-0.2,-0.2,0.2,0.2,0.2", "--out", map},
                          more));
  }

  [[nodiscard]] std::string hash(const std::string& map) const {
    return json::parse(run_well({"info", map, "--json"}))["hash"].get<std::string>();
  }
};

TEST_F(Workflow, RecordedFramesGiveTheSameMap) {
  simulate("frames");
  integrate("frames", "own.vdb");

  // The same frames as a recording: gaps in the numbers, matrices, intrinsics in a file, and a
  // sensor whose own intrinsics are wrong.
  const PoseList poses = read_tum(dir / "frames" / "poses.txt");
  std::filesystem::create_directories(dir / "recorded");
  for (std::size_t i = 0; i < poses.poses.size(); ++i) {
    const std::string number = i == 0 ? "000000" : i == 1 ? "000050" : "001000";
    std::filesystem::copy(dir / "frames" / ("frame-00000" + std::to_string(i) + ".depth.png"),
                          dir / "recorded" / ("frame-" + number + ".depth.png"));
    write("recorded/frame-" + number + ".pose.txt", test::matrix_text(poses.poses[i]));
  }
  write("recorded/camera-intrinsics.txt",
        "\xef\xbb\xbf"
        "60 0 23.5\n0 60 17.5\n0 0 1\n");
  std::string sensor = read("small.toml");
  for (const std::string wrong : {"fx = 60", "fy = 60", "cx = 23", "cy = 17"}) {
    sensor.replace(sensor.find(wrong) + 5, 2, "99");
  }
  write("wrong.toml", sensor);
  integrate("recorded", "recorded.vdb", {"--sensor", "wrong.toml", "--depth-scale", "1e-4"});
  EXPECT_EQ(hash("recorded.vdb"), hash("own.vdb"));

  // Without the scale the depths are ten times too long: all readings lie out of range.
  expect_refused({"integrate", "recorded", "--sensor", "wrong.toml", "--voxel", "0.02",
                  "--workspace", "-0.2,-0.2,-0.2,0.2,0.2,0.2", "--out", "none.vdb"},
                 "0.001 m per unit");
  EXPECT_NE(run_well({"integrate", "recorded", "--sensor", "wrong.toml", "--voxel", "0.02",
                      "--depth-scale", "1e-4", "--out", "own.vdb"})
                .find("depth images: 1e-04 m per unit"),
            std::string::npos);
}

TEST_F(Workflow, AMapKeepsItsLayout) {
  simulate("frames");
  integrate("frames", "once.vdb");
  for (const Strings& conflict : std::vector<Strings>{
           {"--voxel", "0.03"}, {"--workspace", "0,0,0,1,1,1"}, {"--prior-sigma", "0.5"}}) {
    expect_refused_with({"integrate", "frames", "--map", "once.vdb", "--out", "new.vdb"},
                        {{conflict, "once.vdb has a different value, "}});
  }
}

// A folder that grows can be given again and again.
TEST_F(Workflow, FramesThatAMapHasAreSkipped) {
  simulate("frames", {"--frames-per-view", "2", "--noise", "on"});
  const auto grow = [this](const Strings& more) {
    return json::parse(run_well(test::joined({"integrate", "frames", "--json"}, more)));
  };
  integrate("frames", "all.vdb");
  // As a camera's driver leaves them, half of them first.
  const std::string poses = read("frames/poses.txt");
  std::filesystem::rename(dir / "frames", dir / "later");
  const auto move = [this](const std::string& file) {
    std::filesystem::create_directories(dir / "frames");
    std::filesystem::copy(dir / "later" / file, dir / "frames" / file);
  };
  const auto up_to = [&](std::size_t frames) {
    std::size_t end = 0;
    for (std::size_t line = 0; line <= frames; ++line) end = poses.find('\n', end) + 1;
    write("frames/poses.txt", poses.substr(0, end));
  };
  const auto names = [](std::size_t i) { return "frame-00000" + std::to_string(i) + ".depth.png"; };
  for (const char* file : {"sensor.toml", "frames.toml"}) move(file);
  for (std::size_t i = 0; i < 3; ++i) move(names(i));
  up_to(3);
  integrate("frames", "map.vdb");
  for (std::size_t i = 3; i < 6; ++i) move(names(i));
  up_to(6);
  json grown = grow({"--map", "map.vdb", "--out", "map.vdb"});
  EXPECT_EQ(grown["frames"], 3);
  EXPECT_EQ(grown["skipped"], 3);
  EXPECT_EQ(grown["views"], 6);
  EXPECT_EQ(hash("map.vdb"), hash("all.vdb"));
  // All of them, another time: through convert, too, and the file says its sensor still.
  run_well({"convert", "map.vdb", "again.vdb"});
  grown = grow({"--map", "again.vdb", "--out", "again.vdb"});
  EXPECT_EQ(grown["frames"], 0);
  EXPECT_EQ(grown["skipped"], 6);
  EXPECT_TRUE(grown["seconds_per_frame"].is_null());
  EXPECT_EQ(read("again.vdb"), read("map.vdb"));
  EXPECT_EQ(json::parse(run_well({"info", "again.vdb", "--json"})).at("sensor"), "small");
  // Through the library, too.
  save_vdb(load_vdb(dir / "map.vdb").clone(), dir / "library.vdb");
  EXPECT_EQ(grow({"--map", "library.vdb", "--out", "library.vdb"})["skipped"], 6);
  EXPECT_EQ(read("library.vdb"), read("map.vdb"));
  EXPECT_NE(run_well({"integrate", "frames", "--map", "map.vdb", "--out", "map.vdb"})
                .find("frames skipped because the map has them: 6"),
            std::string::npos);
  // Another image of the same name is another frame, and so is one from another pose.
  write("frames/" + names(1), read("frames/" + names(4)));
  std::string moved = poses;
  moved.replace(moved.rfind("\n", moved.size() - 2) + 1, std::string::npos, "5 0 0 -0.6 0 0 0 1\n");
  write("frames/poses.txt", moved);
  grown = grow({"--map", "map.vdb", "--out", "new.vdb"});
  EXPECT_EQ(grown["frames"], 2);
  EXPECT_EQ(grown["skipped"], 4);
  // A tree does not remember.
  run_well({"convert", "map.vdb", "tree.ot"});
  EXPECT_EQ(grow({"--map", "tree.ot", "--out", "new.vdb"})["skipped"], 0);
}

TEST_F(Workflow, FlagsChangeTheAnswerAsTheySay) {
  simulate("frames");
  integrate("frames", "map.vdb");
  const auto best = [this](const Strings& more) {
    return json::parse(run_well(test::joined({"score", "map.vdb", "--poses", "frames/poses.txt",
                                              "--sensor", "small.toml", "--json", "--top", "1"},
                                             more)))
        .at("best")
        .at(0);
  };
  const auto paper = [&best](const Strings& more) {
    return best(test::joined({"--gain", "paper"}, more));
  };
  const double gain = paper({}).at("gain");
  EXPECT_EQ(paper({}).at("rays"), 48 * 36);
  EXPECT_NEAR(paper({"--weight", "-1,-1,-1,1,1,1,0", "--weight", "-1,-1,-1,1,1,1,1"}).at("gain"),
              gain, 1e-9 * gain);
  for (const Strings& flag : {Strings{"--prior-sigma", "0.5"}, Strings{"--criterion", "trace"},
                              Strings{"--criterion", "log_determinant"}}) {
    EXPECT_NE(paper(flag).at("gain"), gain) << flag[0];
  }

  const json surface = best({"--gain", "surface"}), combined = best({"--gain", "combined"});
  EXPECT_EQ(best({}), combined);
  EXPECT_EQ(surface.at("gain"), surface.at("area"));
  const auto missing = [](const json& view) {
    std::string names;
    for (const auto& [name, value] : view.items()) names += value.is_null() ? name + " " : "";
    return names;
  };
  EXPECT_EQ(missing(paper({})), "area refinement_saturated ");
  EXPECT_EQ(missing(surface),
            "exploration refinement posterior_entropy refinement_saturated unknown_voxels "
            "occupied_voxels ");
  EXPECT_EQ(missing(combined), "exploration refinement posterior_entropy unknown_voxels ");
  EXPECT_GT(combined.at("gain"), 0.0);
  EXPECT_GT(best({"--gain", "surface", "--hazard", "20"}).at("area"),
            best({"--gain", "surface", "--hazard", "1"}).at("area"));
  EXPECT_EQ(best({"--gain", "surface", "--hazard", "0"}).at("area"), 0.0);
  EXPECT_EQ(best({"--gain", "surface", "--support-plane", "9"}).at("rays"), 48 * 36);
  EXPECT_NE(best({"--gain", "surface", "--hazard", "size=1"}).at("area"), surface.at("area"));

  // A cube that stands off the origin is seen by the orbit only when it is moved there.
  const auto readings = [this](const Strings& more) {
    return json::parse(run_well(test::joined(
                           {"simulate", "cube.off", "--poses", "orbit:2,0.6,20", "--sensor",
                            "small.toml", "--out", "other_frames", "--json", "--background", "0"},
                           more)))
        .at("readings")
        .get<int>();
  };
  EXPECT_GT(readings({"--place", "center", "--size", "0.35"}),
            readings({"--place", "center", "--size", "0.1"}));
  EXPECT_NE(readings({"--place", "center", "--size", "0.35"}), readings({"--size", "0.35"}));
}

}  // namespace
}  // namespace viewgain
