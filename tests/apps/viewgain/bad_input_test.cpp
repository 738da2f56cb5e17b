// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"

namespace viewgain {
namespace {

using Strings = std::vector<std::string>;

struct BadInput {
  Strings arguments;
  std::string word;  // that the message must have
};

class BadInputTest : public test::ProgramTest {
 protected:
  BadInputTest() {
    write_cube();
    write_small_sensor();
  }

  // A map of a few voxels and its frames.
  void make_map() const {
    run_well({"simulate", "cube.off", "--orbit", "1,0.6,27", "--sensor", "small.toml", "--size",
              "0.3", "--recenter", "on", "--out", "frames"});
    run_well({"integrate", "frames", "--voxel", "0.05", "--workspace", "-0.2,-0.2,-0.2,0.2,0.2,0.2",
              "--out", "map.vdb"});
  }

  // Exit code 2, one line on stderr with the word, nothing on stdout, no file made or left.
  void expect_refused(const std::vector<BadInput>& inputs, std::size_t count) const {
    std::size_t cases = 0;
    const Strings before = list();
    for (const BadInput& input : inputs) {
      const auto result = run(input.arguments);
      std::string shown = "viewgain";
      for (const std::string& argument : input.arguments) shown += ' ' + argument;
      EXPECT_EQ(result.exit_code, 2) << shown << "\n" << result.err;
      EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << shown << "\n"
                                                                           << result.err;
      EXPECT_EQ(result.err.substr(0, 10), "viewgain: ") << shown;
      EXPECT_NE(result.err.find(input.word), std::string::npos)
          << shown << "\n"
          << input.word << " is not in " << result.err;
      EXPECT_EQ(result.out, "") << shown;
      EXPECT_EQ(list(), before) << shown;
      ++cases;
    }
    EXPECT_EQ(cases, count);
  }
};

Strings simulate(const std::string& mesh, const Strings& more = {}) {
  Strings arguments{"simulate", mesh, "--sensor", "small.toml", "--out", "new_frames"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  if (std::find(more.begin(), more.end(), "--orbit") == more.end() &&
      std::find(more.begin(), more.end(), "--poses") == more.end()) {
    arguments.insert(arguments.end(), {"--orbit", "2,0.6,27"});
  }
  return arguments;
}

Strings integrate(const Strings& more, const std::string& frames = "frames") {
  Strings arguments{"integrate", frames, "--out", "new.vdb"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

Strings score(const Strings& more, const std::string& map = "map.vdb",
              const std::string& sensor = "small.toml") {
  Strings arguments{"score", map, "--sensor", sensor, "--out", "new.csv"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST_F(BadInputTest, CommandLine) {
  expect_refused({{{}, "subcommand"},
                  {{"scor"}, "subcommand"},
                  {{"score"}, "MAP"},
                  {{"info", "map.vdb", "--nonsense"}, "--nonsense"},
                  {{"info", "map.vdb", "--threads", "two"}, "--threads"},
                  {simulate("cube.off", {"--up", "w"}), "--up"},
                  {simulate("cube.off", {"--noise", "maybe"}), "--noise"},
                  {simulate("cube.off", {"--flying-pixels", "3"}), "--flying-pixels"},
                  {simulate("cube.off", {"--frames-per-view", "0"}), "--frames-per-view"},
                  {simulate("cube.off", {"--calibrate", "yes"}), "--calibrate"},
                  {simulate("cube.off", {"--support-plane", "nan"}), "support plane"},
                  {simulate("cube.off", {"--wiggling", "0.01"}), "no modulation frequency"},
                  {integrate({"--voxel", "abc"}), "--voxel"}},
                 13);
}

TEST_F(BadInputTest, Meshes) {
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
  write("empty.off", "");
  write("nofaces.off", "OFF\n3 0 0\n" + points);
  write("nan.off", "OFF\n3 1 0\n0 nan 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  write("huge.off", "OFF\n4000000000 1 0\n" + points + "3 0 1 2\n");
  write("huge.ply",
        "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 "
        "0\n");
  write("range.off", "OFF\n3 1 0\n" + points + "3 0 1 3\n");
  write("cut.off", "OFF\n8 6 0\n0 0 0\n");
  write("mesh.doc", "OFF\n");
  expect_refused({{simulate("none.off"), "none.off"},
                  {simulate("empty.off"), "empty"},
                  {simulate("nofaces.off"), "no faces"},
                  {simulate("nan.off"), "not finite"},
                  {simulate("huge.off"), "huge.off"},
                  {simulate("huge.ply"), "huge.ply:"},
                  {simulate("range.off"), "out of range"},
                  {simulate("cut.off"), "cut.off"},
                  {simulate("mesh.doc"), ".off, .obj, .stl, .ply"},
                  {simulate("cube.off", {"--size", "-1"}), "--size -1"},
                  {simulate("cube.off", {"--size", "nan"}), "--size nan"},
                  {simulate("cube.off", {"--background", "-1"}), "background"}},
                 12);
}

TEST_F(BadInputTest, Poses) {
  write("bad.txt", "0 0 0 1 0 0 0 1\n# a comment\n1 0 0 1 0 0 zero 1\n");
  write("short.txt", "0 0 0 1 0 0 0 1\n1 0 0 1 0 0 0\n");
  write("nan.txt", "0 nan 0 1 0 0 0 1\n");
  write("none.txt", "# nothing but a comment\n\n");
  expect_refused({{simulate("cube.off", {"--poses", "bad.txt"}), "3"},
                  {simulate("cube.off", {"--poses", "short.txt"}), "2"},
                  {simulate("cube.off", {"--poses", "nan.txt"}), "nan.txt"},
                  {simulate("cube.off", {"--poses", "none.txt"}), "none.txt"},
                  {simulate("cube.off", {"--poses", "missing.txt"}), "missing.txt"},
                  {simulate("cube.off", {"--orbit", "0,0.6,27"}), "--orbit"},
                  {simulate("cube.off", {"--orbit", "3,-0.6,27"}), "--orbit"},
                  {simulate("cube.off", {"--orbit", "3,0.6"}), "--orbit"},
                  {simulate("cube.off", {"--orbit", "3,x,27"}), "--orbit"},
                  {simulate("cube.off", {"--orbit", "2.5,0.6,27"}), "--orbit"},
                  {simulate("cube.off", {"--orbit", "2,0.6,27", "--poses", "bad.txt"}), "--poses"}},
                 11);
}

TEST_F(BadInputTest, Sensors) {
  write("wrong.toml", "name = \"x\"\n");
  write("broken.toml", "name = [\n");
  Strings unknown = simulate("cube.off");
  std::replace(unknown.begin(), unknown.end(), std::string("small.toml"), std::string("sr5000"));
  const auto with = [](const std::string& sensor) {
    Strings arguments = simulate("cube.off");
    std::replace(arguments.begin(), arguments.end(), std::string("small.toml"), sensor);
    return arguments;
  };
  expect_refused({{with("sr5000"), "sr4000"},
                  {with("sr5000"), "azure_kinect_nfov"},
                  {with("none.toml"), "none.toml"},
                  {with("wrong.toml"), "min_range"},
                  {with("broken.toml"), "broken.toml"}},
                 5);
}

TEST_F(BadInputTest, Frames) {
  make_map();
  const Strings workspace{"--workspace", "-0.2,-0.2,-0.2,0.2,0.2,0.2"};
  const auto voxel = [&workspace](const std::string& size) {
    Strings arguments = integrate({"--voxel", size});
    arguments.insert(arguments.end(), workspace.begin(), workspace.end());
    return arguments;
  };
  write("empty_dir/readme", "");
  write("cut/poses.txt", read("frames/poses.txt"));
  write("cut/sensor.toml", read("frames/sensor.toml"));
  const std::string png = read("frames/frame-000000.depth.png");
  write("cut/frame-000000.depth.png", png.substr(0, png.size() / 2));
  write("less/poses.txt", read("frames/poses.txt") + read("frames/poses.txt"));
  write("less/sensor.toml", read("frames/sensor.toml"));
  write("less/frame-000000.depth.png", png);
  write("nosensor/poses.txt", read("frames/poses.txt"));
  write("nosensor/frame-000000.depth.png", png);
  write("recorded/frame-000000.depth.png", png);
  write("recorded/frame-000000.pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n");
  expect_refused(
      {{integrate({}), "--voxel"},
       {voxel("0"), "voxel"},
       {voxel("-0.01"), "voxel"},
       {voxel("nan"), "voxel"},
       {voxel("4e-9"), "voxels"},
       {integrate({"--voxel", "0.02", "--workspace", "0.2,0,0,0.1,1,1"}), "inside out"},
       {integrate({"--voxel", "0.02", "--workspace", "0,0,0,1,1"}), "--workspace"},
       {integrate({"--voxel", "0.02", "--workspace", "0,0,0,1,1,nan"}), "--workspace"},
       {integrate({"--voxel", "0.02", "--prior-sigma", "-1"}), "prior"},
       {integrate({"--voxel", "0.02", "--depth-scale", "0"}), "--depth-scale"},
       {integrate({"--voxel", "0.02", "--carve", "boxes"}), "--carve"},
       {integrate({"--voxel", "0.02", "--sensor", "sr4000"}), "48x36"},
       {integrate({"--voxel", "0.02"}, "nowhere"), "nowhere"},
       {integrate({"--voxel", "0.02", "--sensor", "small.toml"}, "empty_dir"), "empty_dir"},
       {integrate({"--voxel", "0.02"}, "cut"), "frame-000000.depth.png"},
       {integrate({"--voxel", "0.02"}, "less"), "frame-000001.depth.png"},
       {integrate({"--voxel", "0.02"}, "nosensor"), "--sensor"},
       {integrate({"--voxel", "0.02", "--sensor", "small.toml"}, "recorded"),
        "frame-000000.pose.txt"},
       {{"integrate", "frames", "--voxel", "0.02", "--out", "no/such/dir/map.vdb"}, "no/such/dir"},
       {integrate({"--map", "none.vdb"}), "none.vdb"}},
      20);
}

TEST_F(BadInputTest, Maps) {
  make_map();
  const std::string map = read("map.vdb");
  write("cut.vdb", map.substr(0, map.size() / 2));
  write("empty.vdb", "");
  write("foreign.vdb", read("cube.off"));
  expect_refused({{{"info", "none.vdb"}, "none.vdb"},
                  {{"info", "cut.vdb"}, "cut.vdb"},
                  {{"info", "empty.vdb", "--hash"}, "empty.vdb"},
                  {{"info", "foreign.vdb"}, "foreign.vdb"},
                  {{"info", "map.vdb", "--criterion", "entropy"}, "log_diagonal"},
                  {score({"--sphere", "10,0.6"}, "none.vdb"), "none.vdb"},
                  {score({"--sphere", "10,0.6"}, "cut.vdb"), "cut.vdb"},
                  {score({"--sphere", "10,0.6"}, "foreign.vdb"), "foreign.vdb"}},
                 8);
}

TEST_F(BadInputTest, Scores) {
  make_map();
  write("bad.txt", "0 0 0 1 0 0 0 1\n1 0 0 1 0 0 0\n");
  const Strings sphere{"--sphere", "10,0.6"};
  const auto with = [&sphere](Strings more) {
    more.insert(more.end(), sphere.begin(), sphere.end());
    return score(more);
  };
  expect_refused(
      {{score({}), "--sphere"},
       {with({"--dome", "10,0.6"}), "--dome"},
       {score({"--sphere", "0,0.6"}), "--sphere"},
       {score({"--sphere", "-5,0.6"}), "--sphere"},
       {score({"--sphere", "10,-0.6"}), "--sphere"},
       {score({"--sphere", "10,0"}), "--sphere"},
       {score({"--sphere", "10,0.6,1,1"}), "--sphere"},
       {score({"--dome", "10"}), "--dome"},
       {score({"--dome", "10,nan"}), "--dome"},
       {score({"--poses", "bad.txt"}), "2"},
       {score({"--poses", "none.txt"}), "none.txt"},
       {score({"--sphere", "10,0.6"}, "map.vdb", "sr5000"), "kinect_v1"},
       {with({"--criterion", "entropy"}), "log_determinant"},
       {with({"--gain", "best"}), "combined"},
       {with({"--gain", "combined", "--criterion", "trace"}), "trace"},
       {with({"--gain", "surface", "--hazard", "-1"}), "--hazard -1"},
       {with({"--gain", "surface", "--hazard", "rates"}), "--hazard"},
       {with({"--gain", "surface", "--hazard", "none.VDB"}), "none.VDB"},
       {with({"--gain", "surface", "--hazard", "map.vdb"}), "floats"},
       {{"score", "map.vdb", "--sensor", "small.toml", "--sphere", "10,0.6", "--gain", "surface",
         "--hazard", "p.vdb", "--out", "p.vdb"},
        "is, or holds, a file of --hazard p.vdb"},
       {with({"--gain", "surface", "--object-size", "0"}), "--object-size 0"},
       {with({"--gain", "surface", "--set", "2"}), "paper"},
       {with({"--gain", "surface", "--refinement-weight", "1"}), "combined"},
       {with({"--hazard", "1"}), "--gain"},
       {with({"--gain", "surface", "--hazard", "cube.off"}), ".vdb"},
       {with({"--gain", "surface", "--support-plane", "nan"}), "--support-plane nan"},
       {with({"--gain", "combined", "--refinement-weight", "-1"}), "--refinement-weight"},
       {with({"--stride", "0"}), "stride"},
       {with({"--weight", "0,0,0,1,1,1"}), "--weight"},
       {with({"--weight", "1,0,0,0,1,1,2"}), "inside out"},
       {with({"--weight", "0,0,0,1,1,1,-2"}), "weight"},
       {with({"--prior-sigma", "-1"}), "prior"},
       {with({"--min-range", "6"}), "range"},
       {with({"--max-range", "nan"}), "range"},
       {{"score", "map.vdb", "--sensor", "small.toml", "--sphere", "10,0.6", "--out",
         "no/such/scores.csv"},
        "no/such/scores.csv"}},
      35);
}

}  // namespace
}  // namespace viewgain
