// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Calls that would overwrite an input, or cannot mean what they say: one line on stderr, exit code
// 2, and every byte of the folder is as it was.

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;
using Strings = std::vector<std::string>;

struct Refused {
  Strings arguments;
  std::string word;  // that the message must have
};

Strings joined(Strings first, const Strings& more) {
  first.insert(first.end(), more.begin(), more.end());
  return first;
}

class RefusedCalls : public test::ProgramTest {
 protected:
  RefusedCalls() {
    write_cube();
    write_small_sensor();
    run_well(joined(simulate("cube.off", "frames"), {"--orbit", "1,0.6,27"}));
    run_well(integrate("frames", "map.vdb"));
    run_well({"convert", "map.vdb", "tree.ot"});
    write("poses.txt", read("frames/poses.txt"));
    write("near.txt", read("frames/poses.txt"));
    write("reach.toml", "poses = \"near.txt\"\n");
    write("far.toml", "[[shell]]\ncenter = [0, 0, 0]\nmin_radius = 50.0\nmax_radius = 60.0\n");
    write("point.off", "OFF\n3 1 0\n1 1 1\n1 1 1\n1 1 1\n3 0 1 2\n");
    write("cloud.ply",
          "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
          "property float z\nend_header\n0 0 1\n");
    write_recording("recorded", "60 0 23.5\n0 60 17.5\n0 0 1\n");
    write_recording("negative", "-60 0 23.5\n0 60 17.5\n0 0 1\n");
    write_recording("word", "60 0 23.5\n0 sixty 17.5\n0 0 1\n");
    write("sensors/sensor.toml", read("small.toml"));
    write("foreign/map.vdb", read("map.vdb"));
    write("foreign_views/views/00.png", "a picture of mine");
    write("mixed/frame-000007.depth.png", "a frame of mine");
    for (const char* name :
         {"poses.txt", "sensor.toml", "simulated.txt", "frame-000000.depth.png"}) {
      write("mixed/" + std::string(name), read("frames/" + std::string(name)));
    }
    std::string wide = read("small.toml");
    wide.replace(wide.find("width = 48"), 10, "width = 16384");
    wide.replace(wide.find("height = 36"), 11, "height = 16384");
    write("wide.toml", wide);
    fs::create_directory(dir / "sub");
    fs::create_symlink("map.vdb", dir / "to_map.png");
    fs::create_symlink("map.vdb", dir / "to_map.vdb");
    fs::create_symlink("frames/frame-000000.depth.png", dir / "to_frame.vdb");
    fs::create_symlink("cloud.ply", dir / "to_cloud.vdb");
    fs::create_hard_link(dir / "poses.txt", dir / "also_poses.csv");
  }

  // The frames as a camera's driver leaves them, a sensor file of the user's beside them.
  void write_recording(const std::string& folder, const std::string& intrinsics) const {
    write(folder + "/frame-000000.depth.png", read("frames/frame-000000.depth.png"));
    write(folder + "/frame-000000.pose.txt", "1 0 0 9\n0 1 0 9\n0 0 1 9\n0 0 0 1\n");
    write(folder + "/camera-intrinsics.txt", intrinsics);
    write(folder + "/sensor.toml", read("small.toml"));
  }

  static Strings simulate(const std::string& mesh, const std::string& out) {
    return {"simulate", mesh,         "--sensor", "small.toml", "--size",
            "0.3",      "--recenter", "on",       "--out",      out};
  }
  static Strings integrate(const std::string& frames, const std::string& out) {
    return {"integrate", frames, "--voxel", "0.05", "--workspace", "-0.2,-0.2,-0.2,0.2,0.2,0.2",
            "--out",     out};
  }
  static Strings score(const Strings& more) {
    return joined({"score", "map.vdb", "--sensor", "small.toml"}, more);
  }
  static Strings score_sphere(const Strings& more) {
    return joined(score({"--sphere", "10,0.6"}), more);
  }
  static Strings candidates(const Strings& more) {
    return joined({"candidates", "map.vdb", "--generator", "sphere", "--sensor", "small.toml"},
                  more);
  }
  static Strings reconstruct(const std::string& mesh, const std::string& out) {
    return {"reconstruct", mesh, "--sensor", "small.toml", "--voxel", "0.02", "--out", out};
  }

  void expect_refused(const std::vector<Refused>& calls, std::size_t least) const {
    const auto before = contents();
    std::size_t cases = 0;
    for (const Refused& call : calls) {
      const test::ProgramResult result = run(call.arguments);
      std::string shown = "viewgain";
      for (const std::string& argument : call.arguments) shown += " '" + argument + "'";
      EXPECT_EQ(result.exit_code, 2) << shown << "\n" << result.err;
      EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << shown << "\n"
                                                                           << result.err;
      EXPECT_NE(result.err.find(call.word), std::string::npos)
          << shown << "\n"
          << call.word << " is not in " << result.err;
      EXPECT_EQ(result.out, "") << shown;
      EXPECT_TRUE(contents() == before) << shown << " has changed the folder";
      ++cases;
    }
    EXPECT_GE(cases, least);
  }
};

TEST_F(RefusedCalls, LeaveEveryByteAsItWas) {
  expect_refused(
      {// Outputs over inputs, by name, path, link and through the files that a file names.
       {candidates({"--out", "map.vdb"}), "MAP map.vdb"},
       {candidates({"--out", "small.toml"}), "--sensor small.toml"},
       {candidates({"--reach", "reach.toml", "--out", "reach.toml"}), "--reach reach.toml"},
       {candidates({"--reach", "reach.toml", "--out", "near.txt"}), "--reach reach.toml"},
       {score_sphere({"--out", "small.toml"}), "--sensor small.toml"},
       {score_sphere({"--out", "map.vdb"}), "MAP map.vdb"},
       {score_sphere({"--out", "sub/../map.vdb"}), "MAP map.vdb"},
       {score_sphere({"--picture", "to_map.png"}), "MAP map.vdb"},
       {score_sphere({"--out", "new.png", "--picture", "./new.png"}), "--picture ./new.png"},
       {score({"--poses", "poses.txt", "--out", "poses.txt"}), "--poses poses.txt"},
       {score({"--poses", "poses.txt", "--out", "also_poses.csv"}), "--poses poses.txt"},
       {{"convert", "map.vdb", "./map.vdb"}, "IN map.vdb"},
       {{"convert", "map.vdb", "to_map.vdb"}, "IN map.vdb"},
       {{"convert", "tree.ot", dir / "tree.ot"}, "IN tree.ot"},
       {integrate("frames", "to_frame.vdb"), "FRAMES_DIR frames"},
       {{"integrate", "--cloud", "cloud.ply", "--origin", "0,0,0", "--voxel", "0.05", "--sensor",
         "small.toml", "--out", "to_cloud.vdb"},
        "--cloud cloud.ply"},
       {joined(simulate("cube.off", "frames"), {"--poses", "frames/poses.txt"}),
        "--poses frames/poses.txt"},
       {{"simulate", "cube.off", "--orbit", "1,0.6,27", "--sensor", "frames/sensor.toml", "--out",
         "frames"},
        "--sensor frames/sensor.toml"},
       {joined(simulate("cube.off", "cube.off"), {"--orbit", "1,0.6,27"}), "cube.off"},
       {reconstruct("cube.off", "cube.off"), "cube.off"},
       // Folders that hold what no earlier call has left.
       {joined(simulate("cube.off", "recorded"), {"--orbit", "1,0.6,27"}), "recorded/"},
       {joined(simulate("cube.off", "sensors"), {"--orbit", "1,0.6,27"}), "sensors/sensor.toml"},
       {joined(simulate("cube.off", "mixed"), {"--orbit", "1,0.6,27"}),
        "mixed/frame-000007.depth.png"},
       {reconstruct("cube.off", "foreign"), "foreign: holds map.vdb"},
       {reconstruct("cube.off", "foreign_views"), "views/00.png"},
       // Values that are none.
       {score_sphere({"--seed", "-1"}), "--seed"},
       {score_sphere({"--seed", "18446744073709551616"}), "--seed"},
       {candidates({"--seed", "-1", "--out", "new.txt"}), "--seed"},
       {candidates({"--seed", "18446744073709551616", "--out", "new.txt"}), "--seed"},
       {score_sphere({"--prior-sigma", ""}), "--prior-sigma"},
       {score_sphere({"--max-range", ""}), "--max-range"},
       {score_sphere({"--out", ""}), "--out"},
       {score_sphere({"--out="}), "--out"},
       {score({"--poses", ""}), "--poses"},
       {{"info", "map.vdb", "--threads", ""}, "--threads"},
       {{"info", "map.vdb", "--region", ""}, "--region"},
       {score_sphere({"--picture", "new.jpg"}), ".png"},
       {score_sphere({"--out", "-"}), "--out -"},
       {integrate("frames", "-"), "--out -"},
       {joined(simulate("cube.off", "-"), {"--orbit", "1,0.6,27"}), "--out -"},
       {{"foo"}, "foo"},
       // Files that say nothing, or too much.
       {integrate("recorded", "new.vdb"), "--depth-scale"},
       {{"integrate", "recorded", "--voxel", "0.05", "--depth-scale", "1e-9", "--out", "new.vdb"},
        "1e-09 m per unit"},
       {integrate("negative", "new.vdb"), "negative/camera-intrinsics.txt: camera: fx"},
       {integrate("word", "new.vdb"), "word/camera-intrinsics.txt:2"},
       {joined(simulate("point.off", "new"), {"--orbit", "1,0.6,27"}), "point.off"},
       {reconstruct("point.off", "new"), "point.off"},
       {joined(simulate("cube.off", "new"), {"--orbit", "1,50,27"}), "cube.off: no pose"},
       {candidates({"--reach", "far.toml", "--out", "new.txt"}), "unreachable"},
       {{"simulate", "cube.off", "--orbit", "1,0.6,27", "--sensor", "wide.toml", "--out", "new"},
        "wide.toml: line 6: key \"camera.width\""}},
      40);
}

}  // namespace
}  // namespace viewgain
