// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// OctoMap trees and point clouds on the command line.

#include <cstdio>
#include <string>

#include "apps/program_runner.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain {
namespace {

class ForeignMaps : public test::ProgramTest {
 protected:
  ForeignMaps() { write_small_sensor(); }

  json run_json(Strings arguments) const {
    arguments.push_back("--json");
    return json::parse(run_well(arguments));
  }

  // A wall at x = 1 as seen from the origin.
  static std::string pcd(const std::string& viewpoint = "") {
    std::string file =
        "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1682\n"
        "HEIGHT 1\n" +
        viewpoint + "POINTS 1682\nDATA ascii\n";
    for (int y = -20; y <= 20; ++y) {
      for (int z = -20; z <= 20; ++z) {
        char line[100];
        std::snprintf(line, sizeof line, "1.01 %.3f %.3f\n", 0.02 * y + 0.005, 0.02 * z + 0.005);
        file += line;
      }
    }
    return file + "nan nan nan\n";
  }
};

TEST_F(ForeignMaps, AMapGoesToATreeAndBack) {
  write_cube();
  run_well({"simulate", "cube.off", "--poses", "orbit:3,0.6,27", "--sensor", "small.toml", "--size",
            "0.3", "--place", "center", "--out", "frames"});
  run_well({"integrate", "frames", "--voxel", "0.02", "--workspace", "-0.2,-0.2,-0.2,0.2,0.2,0.2",
            "--out", "map.vdb"});
  const json map = run_json({"info", "map.vdb"});
  const json there = run_json({"convert", "map.vdb", "tree.ot"});
  EXPECT_GT(there.at("lost_beliefs"), 100);
  EXPECT_EQ(there.at("lost_views"), 3);
  const json back = run_json({"convert", "tree.ot", "back.vdb", "--workspace",
                              "-0.2,-0.2,-0.2,0.2,0.2,0.2", "--prior-sigma", "0.03"});
  EXPECT_EQ(back.at("lost_beliefs"), 0);
  EXPECT_EQ(back.at("prior_sigma"), 0.03);
  for (const char* key : {"unknown", "free", "occupied", "dims", "voxel_size"}) {
    EXPECT_EQ(back.at(key), map.at(key)) << key;
  }
  // The same answers whether the tree is read or its map.
  EXPECT_EQ(run_json({"info", "tree.ot"}).at("occupied"), map.at("occupied"));
  const auto scored = [&](Strings call) {
    call.emplace_back("--json");
    const auto result = run(call);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.err.find(call[1] + " has only voxel states"), std::string::npos) << result.err;
    return json::parse(result.out);
  };
  const json prior =
      scored({"score", "tree.ot", "--poses", "sphere:20,0.6", "--sensor", "small.toml"});
  EXPECT_EQ(prior.at("prior_sigma"), map.at("prior_sigma"));
  const json from_tree = scored({"score", "tree.ot", "--poses", "sphere:20,0.6", "--sensor",
                                 "small.toml", "--prior-sigma", "0.03"});
  run_well({"convert", "tree.ot", "small.vdb"});
  const json from_map = scored({"score", "small.vdb", "--poses", "sphere:20,0.6", "--sensor",
                                "small.toml", "--prior-sigma", "0.03"});
  EXPECT_EQ(from_tree.at("best"), from_map.at("best"));
  for (const char* what : {"score", "next"}) {
    Strings call{what, "small.vdb", "--sensor", "small.toml", "--cost-per-metre", "1"};
    if (call[0] == "score") call.insert(call.end(), {"--poses", "sphere:20,0.6"});
    const auto result = run(call);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find("the map has no views"), std::string::npos) << result.err;
    call.insert(call.end(), {"--from", "0,0,1", "--json"});
    EXPECT_EQ(run(call).exit_code, 0) << run(call).err;
  }
  expect_refused({"convert", "map.vdb", "x.ot", "--sensor", "small.toml"}, "--sensor");
  // A prior that is surer than a reading is pointed out.
  Strings score{"score", "map.vdb", "--poses", "sphere:20,0.6", "--prior-sigma", "0.0001"};
  EXPECT_NE(run(score).err.find("warning: the prior sigma is 0.0001 m"), std::string::npos);
  // A tree is continued; frames straight into a tree.
  const json continued = run_json({"integrate", "frames", "--map", "tree.ot", "--out", "again.ot"});
  EXPECT_EQ(continued.at("prior_sigma"), map.at("prior_sigma"));
  EXPECT_EQ(run_json({"info", "again.ot"}).at("free"), continued.at("free"));
  EXPECT_NE(run_well({"convert", "map.vdb", "tree.ot"}).find("not stored in the tree: beliefs of"),
            std::string::npos);
}

TEST_F(ForeignMaps, EndingsAreLargeOrSmallAndOthersRefused) {
  BeliefGrid grid({0.1, {{0, 0, 0}, {1, 1, 1}}, {}, 0.05});
  grid.set({3, 4, 5}, 1.0F);
  save_vdb(grid, dir / "a.vdb");
  for (const char* name : {"a.OT", "b.Ot", "c.ot"}) {
    run_well({"convert", "a.vdb", name});
    EXPECT_TRUE(read(name).starts_with("# Octomap OcTree file")) << name;
    EXPECT_EQ(run_json({"info", name}).at("occupied"), 1) << name;
  }
  run_well({"convert", "a.OT", "b.VDB"});
  EXPECT_EQ(run_json({"info", "b.VDB"}).at("occupied"), 1);
  expect_refused({"convert", "a.vdb", "a.BT"}, "files can only be read");
  for (const char* name : {"a.txt", "a", "a.vdb2", ".vdb", "a.vdb.gz"}) {
    expect_refused({"convert", "a.vdb", name}, "must have the ending .vdb or .ot");
  }
  write("a.pcd", pcd());
  expect_refused({"integrate", "--cloud", "a.pcd", "--origin", "0,0,0", "--sensor", "small.toml",
                  "--voxel", "0.1", "--out", "map.txt"},
                 "must have the ending .vdb or .ot");
  // What is no file of its own has no ending.
  EXPECT_EQ(run({"convert", "a.vdb", "/dev/null"}).exit_code, 0);
}

TEST_F(ForeignMaps, CloudsAreIntegrated) {
  write("a.pcd", pcd());
  const Strings map{"--voxel",    "0.02",        "--sensor",
                    "small.toml", "--workspace", "-0.1,-1,-1,1.2,1,1"};
  const auto integrate = [&](Strings arguments) {
    arguments.insert(arguments.begin(), "integrate");
    arguments.insert(arguments.end(), map.begin(), map.end());
    return run_json(arguments);
  };
  const json a = integrate({"--cloud", "a.pcd", "--origin", "0,0,0", "--out", "a.vdb"});
  EXPECT_EQ(a.at("clouds"), 1);
  EXPECT_FALSE(a.contains("frames"));
  EXPECT_TRUE(a.at("depth_scale").is_null());
  EXPECT_EQ(a.at("readings"), 1681);
  EXPECT_EQ(a.at("readings_inside"), 1681);
  EXPECT_EQ(a.at("invalid"), 1);
  EXPECT_EQ(a.at("occupied"), 1681);
  EXPECT_GT(a.at("free"), 20000);
  EXPECT_EQ(a.at("views"), 1);
  // VIEWPOINT and a pose at the origin say the same.
  write("v.pcd", pcd("VIEWPOINT 0 0 0 1 0 0 0\n"));
  const json v = integrate({"--cloud", "v.pcd", "--out", "v.vdb"});
  EXPECT_EQ(v.at("occupied"), a.at("occupied"));
  EXPECT_EQ(v.at("free"), a.at("free"));
  write("poses.txt", "0 0 0 0 0 0 0 1\n");
  EXPECT_EQ(integrate({"--cloud", "a.pcd", "--poses", "poses.txt", "--out", "p.vdb"}).at("hash"),
            v.at("hash"));
  // Where only the origin is known the view looks at the points: a gain that counts what views
  // show from near finds some; one that looks along z finds none.
  write("at.txt", "0 1.1 -1.5 0 -0.70710678118654757 0 0 0.70710678118654757\n");  // along the wall
  const auto seen_from_near = [&](const char* file) {
    return run_json({"score", file, "--poses", "at.txt", "--gain", "proximity_count"})
        .at("best")[0]
        .at("proximity_count")
        .get<double>();
  };
  EXPECT_GT(seen_from_near("a.vdb"), 0);
  EXPECT_EQ(seen_from_near("v.vdb"), 0);
  // Two clouds in the sensor's frame; the second sensor stands 0.2 m beside the first.
  write("two.txt", "0 0 0 0 0 0 0 1\n1 0 0.2 0 0 0 0 1\n");
  const json two =
      integrate({"--cloud", "a.pcd", "--cloud", "a.pcd", "--poses", "two.txt", "--out", "two.vdb"});
  EXPECT_EQ(two.at("clouds"), 2);
  EXPECT_EQ(two.at("views"), 2);
  EXPECT_EQ(two.at("occupied"), 41 * 51);
  // The workspace by default holds all readings.
  const json seen = run_json({"integrate", "--cloud", "a.pcd", "--origin", "0,0,0", "--voxel",
                              "0.02", "--sensor", "small.toml", "--out", "s.vdb"});
  EXPECT_EQ(seen.at("readings_inside"), 1681);
  EXPECT_NE(run_well({"integrate", "--cloud", "a.pcd", "--origin", "0,0,0", "--voxel", "0.02",
                      "--sensor", "small.toml", "--out", "s.vdb"})
                .find("1 clouds (small): 1,681 measured points"),
            std::string::npos);
  // A workspace that ends before the wall has nothing but free space, and that is said.
  const auto carved =
      run({"integrate", "--cloud", "a.pcd", "--origin", "0,0,0", "--voxel", "0.02", "--sensor",
           "small.toml", "--workspace", "-0.1,-1,-1,0.8,1,1", "--out", "carved.vdb"});
  EXPECT_EQ(carved.exit_code, 0);
  EXPECT_NE(carved.err.find("the cloud only marks free space"), std::string::npos) << carved.err;
}

TEST_F(ForeignMaps, WrongUseIsRefused) {
  write("a.pcd", pcd());
  write("cut.pcd", pcd().substr(0, 500));
  write("cut.ot", "# Octomap OcTree file\nid OcTree\nsize 1\nres 0.1\ndata\n");
  write("poses.txt", "0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n");
  run_well({"integrate", "--cloud", "a.pcd", "--origin", "0,0,0", "--voxel", "0.05", "--sensor",
            "small.toml", "--out", "map.vdb"});
  const auto integrate = [](Strings more) {
    more.insert(more.begin(), "integrate");
    more.insert(more.end(), {"--voxel", "0.05", "--out", "new.vdb"});
    return more;
  };
  const Strings cloud{"--cloud", "a.pcd", "--sensor", "small.toml"};
  const auto with_cloud = [&](Strings more) {
    more.insert(more.begin(), cloud.begin(), cloud.end());
    return integrate(more);
  };
  expect_refused(integrate({}), "FRAMES_DIR or --cloud");
  expect_refused(with_cloud({"frames"}), "FRAMES_DIR or --cloud");
  expect_refused(with_cloud({}), "no VIEWPOINT");
  expect_refused(integrate({"--cloud", "a.pcd", "--origin", "0,0,0"}), "--cloud requires --sensor");
  expect_refused(with_cloud({"--origin", "0,0"}), "--origin");
  expect_refused(with_cloud({"--origin", "0,0,0", "--poses", "poses.txt"}), "--poses");
  expect_refused(with_cloud({"--poses", "poses.txt"}),
                 "the file must have one pose per cloud; clouds: 1, poses: 2");
  expect_refused(with_cloud({"--origin", "0,0,0", "--depth-scale", "1"}), "--depth-scale");
  expect_refused(with_cloud({"--origin", "0,0,90"}), "no cloud has a point in the sensor's range");
  expect_refused(integrate({"frames", "--origin", "0,0,0"}), "requires --cloud");
  expect_refused(integrate({"--cloud", "cut.pcd", "--sensor", "small.toml", "--origin", "0,0,0"}),
                 "cut.pcd:");
  expect_refused(integrate({"--cloud", "none.ply", "--sensor", "small.toml", "--origin", "0,0,0"}),
                 "none.ply");
  expect_refused({"info", "cut.ot"}, "the tree is truncated");
  expect_refused({"info", "none.bt"}, "none.bt");
  expect_refused({"convert", "cut.ot", "new.vdb"}, "the tree is truncated");
  expect_refused({"convert", "map.vdb", "new.bt"}, "files can only be read");
  expect_refused({"convert", "map.vdb", "new.ot", "--workspace", "0,0,0,1,1,1"}, "--workspace");
  expect_refused({"convert", "map.vdb", "new.ot", "--prior-sigma", "1"}, "--prior-sigma");
  expect_refused({"convert", "map.vdb"}, "OUT");
}

}  // namespace
}  // namespace viewgain
