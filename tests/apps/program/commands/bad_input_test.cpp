// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "apps/program_runner.hpp"

namespace viewgain {
namespace {

class BadInputTest : public test::ProgramTest {
 protected:
  BadInputTest() {
    write_cube();
    write_small_sensor();
  }

  // A map of a few voxels and its frames.
  void make_map() const {
    run_well({"simulate", "cube.off", "--poses", "orbit:1,0.6,27", "--sensor", "small.toml",
              "--size", "0.3", "--place", "center", "--out", "frames"});
    run_well({"integrate", "frames", "--voxel", "0.05", "--workspace", "-0.2,-0.2,-0.2,0.2,0.2,0.2",
              "--out", "map.vdb"});
  }
};

Strings simulate(const Strings& more) {
  return test::joined({"simulate", "cube.off", "--sensor", "small.toml", "--out", "new_frames",
                       "--poses", "orbit:2,0.6,27"},
                      more);
}

Strings integrate(const Strings& more, const std::string& frames = "frames") {
  return test::joined({"integrate", frames, "--out", "new.vdb"}, more);
}

Strings score(const Strings& more) {
  return test::joined({"score", "map.vdb", "--sensor", "small.toml", "--out", "new.csv"}, more);
}

TEST_F(BadInputTest, CommandLine) {
  expect_refused({{{}, "subcommand"},
                  {{"scor"}, "subcommand"},
                  {{"score"}, "MAP"},
                  {{"info", "map.vdb", "--nonsense"}, "--nonsense"},
                  {{"info", "map.vdb", "--threads", "two"}, "--threads"},
                  {simulate({"--up", "w"}), "--up"},
                  {simulate({"--noise", "maybe"}), "--noise"},
                  {simulate({"--noise", "scale"}), "--noise scale"},
                  {simulate({"--frames-per-view", "0"}), "--frames-per-view"},
                  {simulate({"--support-plane", "nan"}), "support plane"},
                  {{"reconstruct", "cube.off", "--sensor", "small.toml", "--voxel", "1", "--size",
                    "2000", "--out", "large"},
                   "in millimetres? (--size)"},
                  {integrate({"--voxel", "abc"}), "--voxel"},
                  {{"score", "map.vdb", "--seed", "-1"}, "--seed"},
                  {{"score", "map.vdb", "--seed", "18446744073709551616"}, "--seed"}});
}

TEST_F(BadInputTest, Frames) {
  make_map();
  const Strings workspace{"--workspace", "-0.2,-0.2,-0.2,0.2,0.2,0.2"};
  const auto voxel = [&workspace](const std::string& size) {
    return test::joined(integrate({"--voxel", size}), workspace);
  };
  write("empty_dir/readme", "");
  write("cut/poses.txt", "0 0 0 0 0 0 0 1\n");
  write("cut/sensor.toml", read("frames/sensor.toml"));
  write("cut/frames.toml", read("frames/frames.toml"));
  const std::string png = read("frames/frame-000000.depth.png");
  write("cut/frame-000000.depth.png", png.substr(0, png.size() / 2));
  write("nosensor/poses.txt", read("frames/poses.txt"));
  write("nosensor/frame-000000.depth.png", png);
  write("recorded/frame-000000.depth.png", png);
  write("recorded/frame-000000.pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n");
  write("negative/frame-000000.depth.png", png);
  write("negative/frame-000000.pose.txt", "1 0 0 9\n0 1 0 9\n0 0 1 9\n0 0 0 1\n");
  write("negative/camera-intrinsics.txt", "-60 0 23.5\n0 60 17.5\n0 0 1\n");
  write("masks/readme", "");
  expect_refused(
      {{integrate({}), "--voxel"},
       {voxel("0"), "voxel"},
       {voxel("4e-9"), "voxels"},
       {integrate({"--voxel", "0.02", "--workspace", "0.2,0,0,0.1,1,1"}), "inside out"},
       {integrate({"--voxel", "0.02", "--prior-sigma", "-1"}), "prior"},
       {integrate({"--voxel", "0.02", "--depth-scale", "0"}), "--depth-scale"},
       {integrate({"--voxel", "0.02", "--sensor", "sr4000"}), "48 x 36"},
       {integrate({"--voxel", "0.02"}, "nowhere"), "nowhere"},
       {integrate({"--voxel", "0.02", "--sensor", "small.toml"}, "empty_dir"), "empty_dir"},
       {integrate({"--voxel", "0.02"}, "cut"), "frame-000000.depth.png"},
       {integrate({"--voxel", "0.02"}, "nosensor"), "--sensor"},
       {integrate({"--voxel", "0.02", "--sensor", "small.toml"}, "recorded"),
        "frame-000000.pose.txt"},
       {integrate({"--voxel", "0.02", "--sensor", "small.toml"}, "negative"),
        "negative/camera-intrinsics.txt: "},
       {integrate({"--voxel", "0.02", "--confidence", "masks"}), "masks"},
       {integrate({"--voxel", "0.02", "--confidence", "masks,0"}), "1..255"},
       {{"integrate", "frames", "--voxel", "0.02", "--out", "no/such/dir/map.vdb"}, "no/such/dir"},
       {integrate({"--map", "none.vdb"}), "none.vdb"}});
}

TEST_F(BadInputTest, Scores) {
  make_map();
  write("bad.txt", "0 0 0 1 0 0 0 1\n1 0 0 1 0 0 0\n");
  const Strings sphere{"--poses", "sphere:10,0.6"};
  const auto with = [&sphere](const Strings& more) { return score(test::joined(more, sphere)); };
  expect_refused({{score({}), "--poses"},
                  {score({"--sphere", "10,0.6"}), "--poses sphere:N,RADIUS"},
                  {score({"--poses", "sphere:0,0.6"}), "--poses sphere:0,0.6"},
                  {score({"--poses", "bad.txt"}), "2"},
                  {with({"--gain", "best"}), "combined"},
                  {with({"--criterion", "trace"}), "--criterion trace requires --gain paper"},
                  {with({"--gain", "surface", "--hazard", "-1"}), "--hazard -1"},
                  {with({"--gain", "surface", "--hazard", "rates"}), "--hazard"},
                  {with({"--gain", "surface", "--hazard", "none.VDB"}), "none.VDB"},
                  {with({"--gain", "surface", "--hazard", "map.vdb"}), "grids of floats"},
                  {{"score", "map.vdb", "--sensor", "small.toml", "--poses", "sphere:10,0.6",
                    "--gain", "surface", "--hazard", "p.vdb", "--out", "p.vdb"},
                   "would overwrite a file of --hazard p.vdb"},
                  {with({"--gain", "surface", "--hazard", "size=0"}), "--hazard size 0"},
                  {with({"--gain", "paper", "--hazard", "1"}), "--gain surface"},
                  {with({"--gain", "surface", "--hazard", "cube.off"}), ".vdb"},
                  {with({"--gain", "surface", "--support-plane", "nan"}), "--support-plane nan"},
                  {with({"--report", "report.txt"}), "report"},
                  {with({"--weight", "0,0,0,1,1,1"}), "--weight"},
                  {with({"--max-range", "1"}), "max_range in a sensor's file"},
                  {{"score", "map.vdb", "--sensor", "small.toml", "--poses", "sphere:10,0.6",
                    "--out", "no/such/scores.csv"},
                   "no/such/scores.csv"}});
}

// By name, path and link, and through the files that a file names.
TEST_F(BadInputTest, WhatIsReadIsNotWritten) {
  make_map();
  write("poses.txt", read("frames/poses.txt"));
  write("near.txt", read("frames/poses.txt"));
  write("reach.toml", "poses = \"near.txt\"\n");
  std::filesystem::create_symlink("map.vdb", dir / "to_map.png");
  std::filesystem::create_symlink("frames/frame-000000.depth.png", dir / "to_frame.vdb");
  std::filesystem::create_hard_link(dir / "poses.txt", dir / "also_poses.csv");
  const Strings sphere{"score", "map.vdb", "--sensor", "small.toml", "--poses", "sphere:10,0.6"};
  const Strings poses{"score", "map.vdb", "--sensor", "small.toml", "--poses", "poses.txt"};
  expect_refused(
      {{test::joined(sphere, {"--out", "frames/../map.vdb"}), "MAP map.vdb"},
       {test::joined(sphere, {"--out", "small.toml"}), "--sensor small.toml"},
       {test::joined(sphere, {"--picture", "to_map.png"}), "MAP map.vdb"},
       {test::joined(sphere, {"--out", "new.png", "--picture", "./new.png"}),
        "--picture ./new.png"},
       {test::joined(sphere, {"--out", ""}), "--out"},
       {test::joined(sphere, {"--out", "-"}), "--out -"},
       {test::joined(poses, {"--out", "also_poses.csv"}), "--poses poses.txt"},
       {{"next", "map.vdb", "--generator", "sphere", "--sensor", "small.toml", "--reach",
         "reach.toml", "--out", "near.txt"},
        "--reach reach.toml"},
       {{"integrate", "frames", "--voxel", "0.05", "--out", "to_frame.vdb"}, "FRAMES_DIR frames"},
       {{"simulate", "cube.off", "--poses", "frames/poses.txt", "--sensor", "small.toml", "--out",
         "frames"},
        "--poses frames/poses.txt"}});
}

}  // namespace
}  // namespace viewgain
