// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The whole loop as a user would run it, on small objects: what it leaves, that it ends well on
// degenerate ones, that a run can be repeated, that bad input is refused.

#include <algorithm>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain {
namespace {

class Reconstruct : public test::ProgramTest {
 protected:
  Reconstruct() {
    write_cube();
    write_half_sensor();
  }

  // Coarse enough for a test: 88x72 px, 64³ voxels.
  [[nodiscard]] static Strings arguments(const std::string& mesh, const Strings& more) {
    Strings result{"reconstruct", mesh,    "--sensor", "tof.toml", "--voxel",
                   "0.00625",     "--out", "run",      "--json"};
    result.insert(result.end(), more.begin(), more.end());
    if (std::find(more.begin(), more.end(), "--size") == more.end()) {
      result.insert(result.end(), {"--size", "0.35"});  // the cube's own is 2 m
    }
    return result;
  }
  [[nodiscard]] json reconstruct(const std::string& mesh, const Strings& more = {}) const {
    const test::ProgramResult result = run(arguments(mesh, more));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.exit_code == 0 ? json::parse(result.out) : json();
  }
};

TEST_F(Reconstruct, TakesThePlansViewsBeforeItPlansAnew) {
  const json result = reconstruct(
      "cube.off", {"--max-views", "6", "--size", "0.2", "--plan", "3,2", "--cost-per-metre", "10"});
  ASSERT_EQ(result["views"], 6);
  std::size_t planned = 0, decided = 0;
  const json& views = result["per_view"];
  for (std::size_t i = 1; i < views.size(); ++i) {
    const bool is_of_plan = views[i]["generator"] == "plan";
    ++(is_of_plan ? planned : decided);
    // Two of a plan at most, the first of which was decided on.
    if (is_of_plan) {
      EXPECT_EQ(views[i - 1]["generator"], "boundary");
      EXPECT_EQ(views[i]["candidates"], 1);
    }
    EXPECT_GT(views[i]["predicted_area"].get<double>(), 0);
  }
  EXPECT_GE(planned, 1U);
  EXPECT_GE(decided, 3U);
  const json settings = json::parse(read("run/run.json"))["settings"];
  EXPECT_EQ(settings["plan"], 3);
  EXPECT_EQ(settings["take"], 2);
  for (const auto& [more, part] : std::vector<std::pair<Strings, std::string>>{
           {{"--plan", "2,3"}, "--plan 2,3"},
           {{"--plan", "3", "--policy", "random"}, "--policy gain"},
           {{"--plan", "3", "--gain", "unknown_count"}, "--policy gain"},
           {{"--policy", "random", "--gain", "unknown_count"}, "--policy gain"}}) {
    const test::ProgramResult refused = run(arguments("cube.off", more));
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find(part), std::string::npos) << refused.err;
  }
}

TEST_F(Reconstruct, LeavesAConsistentFolder) {
  const json result =
      reconstruct("cube.off", {"--max-views", "3", "--save-maps", "on", "--size", "0.2"});
  EXPECT_EQ(result["stop_reason"], "max_views");
  EXPECT_EQ(result["views"], 3);
  ASSERT_EQ(result["per_view"].size(), 3U);
  EXPECT_EQ(list("run"), (Strings{"config.toml", "map.vdb", "maps", "points.ply", "run.json",
                                  "surface.ply", "views", "views.txt"}));
  EXPECT_EQ(list("run/maps"), (Strings{"00.txt", "00.vdb", "01.txt", "01.vdb", "02.vdb"}));
  for (std::size_t view = 1; view < 3; ++view) {  // what it was chosen among
    const PoseList candidates = read_tum(dir / ("run/maps/0" + std::to_string(view - 1) + ".txt"));
    EXPECT_EQ(candidates.poses.size(), result["per_view"][view]["candidates"]);
  }
  EXPECT_EQ(list("run/views"), (Strings{"00.amplitude.png", "00.png", "01.amplitude.png", "01.png",
                                        "02.amplitude.png", "02.png"}));
  const json run_file = json::parse(read("run/run.json"));
  for (const auto& [key, value] : result.items()) {
    EXPECT_EQ(run_file.at(key), value) << key;
  }
  EXPECT_EQ(run_file["settings"]["policy"], "gain");
  EXPECT_FALSE(run_file["settings"].contains("threads"));
  // The map's hash, its views and views.txt are the run's.
  EXPECT_EQ(
      json::parse(run_well({"info", "run/map.vdb", "--json"}))["hash"].get<std::string>() + "\n",
      run_file["map_hash"].get<std::string>() + "\n");
  const PoseList views = read_tum(dir / "run/views.txt");
  ASSERT_EQ(views.poses.size(), 3U);
  double travelled = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const json& view = result["per_view"][i];
    for (int r = 0; r < 3; ++r) {
      EXPECT_NEAR(view["pose"][r][3].get<double>(), views.poses[i].translation()[r], 1e-9);
    }
    if (i > 0) {
      travelled += (views.poses[i].translation() - views.poses[i - 1].translation()).norm();
      EXPECT_EQ(view["generator"], "boundary");
      EXPECT_GT(view["candidates"].get<int>(), 0);
      EXPECT_GT(view["predicted_gain"].get<double>(), 0);
      EXPECT_GT(view["predicted_area"].get<double>(), 0);
      EXPECT_LT(view["predicted_area"].get<double>(), 6 * 0.2 * 0.2);
    }
    EXPECT_GT(view["realised_area"].get<double>(), 0);
    EXPECT_NEAR(view["travelled"].get<double>(), travelled, 1e-9);
  }
  EXPECT_EQ(result["per_view"][0]["generator"], "start");
  EXPECT_TRUE(result["per_view"][0]["predicted_area"].is_null());
  EXPECT_EQ(result["gain_model"], "combined");
}

TEST_F(Reconstruct, SettingsHaveEveryFlagThatCanChangeTheAnswer) {
  // Plans and scales are settings where there are any.
  (void)reconstruct("cube.off", {"--max-views", "1", "--pictures", "off", "--size", "0.2", "--plan",
                                 "2", "--scales", "1", "--fine", "0,0,0,1,1,1"});
  const json run_file = json::parse(read("run/run.json"));
  const std::map<std::string, std::string> other_keys{{"generator", "generators"},
                                                      {"count", "sphere_poses"},
                                                      {"from", "start"},
                                                      {"stop", "stop_area"},
                                                      {"scales", "coarsest"}};
  // Where results go, how fast; the seed is beside the settings, the body in the sensor; obstacles
  // are there where there are any.
  const std::set<std::string> elsewhere{"out",      "save_maps", "pictures", "seed", "body",
                                        "obstacle", "report",    "resume",   "poses"};
  std::istringstream help(run_well({"reconstruct", "--help"}));
  std::size_t flags = 0;
  for (std::string line; std::getline(help, line);) {
    if (!line.starts_with("  --")) continue;
    std::string name = line.substr(4, line.find(' ', 4) - 4);
    std::replace(name.begin(), name.end(), '-', '_');
    if (elsewhere.contains(name)) continue;
    if (other_keys.contains(name)) name = other_keys.at(name);
    EXPECT_TRUE(run_file["settings"].contains(name)) << line;
    ++flags;
  }
  // The mesh has no flag, two settings follow from others; a flag may have several.
  const std::set<std::string> more{"mesh",          "prior_sigma", "stop_gain_is_relative",
                                   "stop_gain",     "stop_idle",   "stop_promises",
                                   "stop_coverage", "take",        "finest",
                                   "flying_pixels", "scale_error", "pose_noise",
                                   "pose_sigma"};
  for (const std::string& key : more) EXPECT_TRUE(run_file["settings"].contains(key)) << key;
  EXPECT_EQ(flags + more.size(), run_file["settings"].size());
}

TEST_F(Reconstruct, KnownObstaclesHideTheObjectAndAreNoPartOfIt) {
  const Strings setting{"--max-views", "3", "--pictures", "off", "--size", "0.15"};
  const json without = reconstruct("cube.off", setting);
  write("wall.off",
        "OFF\n8 6 0\n-0.084 -0.08 -0.08\n-0.078 -0.08 -0.08\n-0.084 0.08 -0.08\n-0.078 0.08 -0.08\n"
        "-0.084 -0.08 0.08\n-0.078 -0.08 0.08\n-0.084 0.08 0.08\n-0.078 0.08 0.08\n"
        "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n");
  Strings with = setting;
  const std::string box = "0.078,-0.08,-0.08,0.084,0.08,0.08";
  for (const std::string& more :
       {std::string("--obstacle"), box, std::string("--obstacle"), std::string("wall.off")}) {
    with.push_back(more);
  }
  const json result = reconstruct("cube.off", with);
  EXPECT_EQ(json::parse(read("run/run.json"))["settings"]["obstacles"], (Strings{box, "wall.off"}));
  EXPECT_NE(result["per_view"][2]["pose"], without["per_view"][2]["pose"]);
  // They stand 3 mm off two faces of the cube, which nobody can see then.
  EXPECT_LT(result["coverage"].get<double>(), without["coverage"].get<double>());
  for (const char* side :
       {"-0.085,-0.08,-0.08,-0.0785,0.08,0.08", "0.0785,-0.08,-0.08,0.085,0.08,0.08"}) {
    const json region =
        json::parse(run_well({"info", "run/map.vdb", "--workspace", side, "--json"}))["region"];
    EXPECT_LE(region["occupied"].get<int>(), 30) << side;
  }
  for (const char* wrong : {"1,2,3", "-1,-1,-1,1,1,1"}) {  // the second holds the start pose
    expect_refused(arguments("cube.off", {std::string("--obstacle=") + wrong}), "--obstacle");
  }
}

TEST_F(Reconstruct, EveryPolicyGoesItsOwnWay) {
  std::map<std::string, std::string> views;
  std::set<std::string> different;
  for (const char* policy : {"gain", "kriegel", "sequence", "random", "frontier", "fibonacci",
                             "oracle", "unknown_count"}) {
    const bool is_gain = std::string(policy) == "unknown_count";
    const json result =
        reconstruct("cube.off", {is_gain ? "--gain" : "--policy", policy, "--max-views", "4",
                                 "--pictures", "off", "--size", "0.2", "--noise", "off"});
    EXPECT_GE(result["views"].get<int>(), 2) << policy;
    EXPECT_EQ(result["gain_model"], is_gain                         ? json(policy)
                                    : std::string(policy) == "gain" ? json("combined")
                                                                    : json());
    EXPECT_GT(result["per_view"][1]["predicted_area"].get<double>(), 0) << policy;
    EXPECT_GT(result["coverage_visible"].get<double>(), 0.3) << policy;
    EXPECT_LT(result["rms_error"].get<double>(), 0.005) << policy;
    views[policy] = read("run/views.txt");
    different.insert(views[policy]);
  }
  EXPECT_EQ(views.size(), 8U);
  EXPECT_EQ(different.size(), 8U);
}

TEST_F(Reconstruct, ClosedBoxSeenFromAllSidesEnds) {
  const json result = reconstruct(
      "cube.off", {"--max-views", "80", "--pictures", "off", "--size", "0.15", "--noise", "off"});
  EXPECT_NE(result["stop_reason"], "max_views") << result["stop_reason"];
  EXPECT_GT(result["coverage_visible"].get<double>(), 0.8);
}

TEST_F(Reconstruct, FlatPlateEnds) {
  write("plate.off", "OFF\n4 1 0\n-1 0 -1\n1 0 -1\n1 0 1\n-1 0 1\n4 0 1 2 3\n");
  const json result = reconstruct(
      "plate.off", {"--max-views", "80", "--pictures", "off", "--size", "0.2", "--noise", "off"});
  EXPECT_NE(result["stop_reason"], "max_views") << result["stop_reason"];
  EXPECT_GT(result["coverage_visible"].get<double>(), 0.9);
}

TEST_F(Reconstruct, ObjectLargerThanTheWorkspaceEnds) {
  const json result =
      reconstruct("cube.off", {"--max-views", "80", "--pictures", "off", "--size", "0.3",
                               "--workspace", "-0.1,-0.1,0,0.1,0.1,0.17", "--distance", "0.6",
                               "--noise", "off", "--gain", "paper", "--stop", "gain=1.1"});
  EXPECT_NE(result["stop_reason"], "max_views") << result["stop_reason"];
  EXPECT_GT(result["coverage"].get<double>(), 0.02);
  EXPECT_LT(result["coverage"].get<double>(), 0.6);
}

// The same start, and then the file's views, but for one that cannot be.
TEST_F(Reconstruct, TakesPosesOfAFileInTheirOrder) {
  const std::vector<Pose> poses{look_at({0.5, 0, 0.3}, {0, 0, 0}), look_at({0.01, 0, 0}, {0, 0, 1}),
                                look_at({0, -0.5, 0.3}, {0, 0, 0})};
  write_tum(dir / "own.txt", poses);
  const Strings flags{"--size", "0.2", "--pictures", "off", "--max-views", "9", "--stop", "idle=0"};
  const json own =
      reconstruct("cube.off", test::joined(flags, {"--policy", "sequence", "--poses", "own.txt"}));
  const std::vector<Pose> views = read_tum(dir / "run/views.txt").poses;
  const json start =
      reconstruct("cube.off", {"--size", "0.2", "--pictures", "off", "--max-views", "1"});
  EXPECT_EQ(own["per_view"][0]["pose"], start["per_view"][0]["pose"]);
  ASSERT_EQ(views.size(), 3U);
  EXPECT_LT((views[1].translation() - poses[0].translation()).norm(), 1e-9);
  EXPECT_LT((views[2].translation() - poses[2].translation()).norm(), 1e-9);
  EXPECT_EQ(own["per_view"][1]["generator"], "poses");
  expect_refused({"reconstruct", "cube.off", "--sensor", "tof.toml", "--voxel", "0.01", "--size",
                  "0.2", "--poses", "own.txt", "--out", "new"},
                 "--poses requires --policy sequence");
}

TEST_F(Reconstruct, AWorkspaceThatCutsTheObjectIsToldOf) {
  const auto said = [this](const std::string& workspace) {
    return run({"reconstruct", "cube.off", "--size", "0.3", "--sensor", "tof.toml", "--voxel",
                "0.0125", "--workspace", workspace, "--max-views", "1", "--pictures", "off",
                "--out", "cut"})
        .err;
  };
  // 2/3 by 2/3 by 1/2 of the object's box.
  const std::string small = said("-0.1,-0.1,0,0.1,0.1,0.17"), half = said("-1,-1,0,1,1,1");
  EXPECT_NE(small.find("the workspace contains only 22 % of the object, whose bounding box is "
                       "-0.15,-0.15,-0.15"),
            std::string::npos)
      << small;
  EXPECT_EQ(half.find("warning"), std::string::npos) << half;
}

// Coverage finer than the voxels would judge these.
TEST_F(Reconstruct, CoverageIsNoFinerThanTheVoxels) {
  std::size_t cases = 0;
  for (const auto& [voxel, more, tolerance] :
       {std::tuple{"0.0125", Strings{}, 0.0125},
        {"0.004", Strings{}, 0.005},
        {"0.0125", Strings{"--tolerance", "0.005"}, 0.005}}) {
    run_well(
        test::joined({"reconstruct", "cube.off", "--size", "0.3", "--sensor", "tof.toml", "--voxel",
                      voxel, "--max-views", "1", "--quiet", "--pictures", "off", "--out", "run"},
                     more));
    EXPECT_EQ(json::parse(read("run/run.json"))["settings"]["tolerance"], tolerance) << voxel;
    ++cases;
  }
  EXPECT_EQ(cases, 3U);
}

TEST_F(Reconstruct, SupportPlaneWithTheUpperHalfInReach) {
  write("upper.toml", "[[half_space]]\nnormal = [0.0, 0.0, 1.0]\noffset = 0.05\n");
  const json result = reconstruct(
      "cube.off", {"--max-views", "80", "--pictures", "off", "--size", "0.15", "--support-plane",
                   "0", "--reach", "upper.toml", "--gain", "paper", "--stop", "gain=1.2"});
  EXPECT_EQ(result["stop_reason"], "gain");
  EXPECT_GT(result["final_dropped"].value("unreachable", 0), 0);
  EXPECT_GT(result["coverage_visible"].get<double>(), 0.8);
  // The underside stays a hole: a sixth of the surface cannot be seen.
  EXPECT_LT(result["coverage"].get<double>(), 0.93);
  for (const json& view : result["per_view"]) EXPECT_GT(view["pose"][2][3].get<double>(), 0.05);
}

TEST_F(Reconstruct, RefusesBadInputAndLeavesNothing) {
  write("no_reach.toml", "[[shell]]\ncenter = [0, 0, 0]\nmin_radius = 5.0\nmax_radius = 6.0\n");
  // An earlier run stays as it was.
  (void)reconstruct("cube.off", {"--max-views", "1", "--pictures", "off", "--size", "0.2"});
  const test::Refusals inputs{
      {arguments("missing.off", {}), "missing.off"},
      {arguments("cube.off", {"--voxel", "-1"}), "voxel"},
      {arguments("cube.off", {"--size", "0"}), "size"},
      {arguments("cube.off", {"--gain", "entropy"}), "surface"},
      {arguments("cube.off", {"--gain", "paper", "--stop", "area=0.01"}), "stop_area"},
      {arguments("cube.off", {"--stop", "gain=1"}), "stop_gain"},
      {arguments("cube.off", {"--criterion", "trace"}), "criterion trace"},
      {arguments("cube.off", {"--hazard", "-2"}), "--hazard -2"},
      {arguments("cube.off", {"--gain", "surface", "--stop", "area=1"}), "stop_area"},
      {arguments("cube.off", {"--policy", "random", "--stop", "area=0.01"}), "stop_area"},
      {arguments("cube.off", {"--policy", "oracle", "--gain", "surface"}), "--policy gain"},
      {arguments("cube.off", {"--size", "0.001"}), "the voxels must be smaller than the object"},
      {arguments("cube.off", {"--cost-per-metre", "-1"}), "--cost-per-metre -1"},
      {arguments("cube.off", {"--max-views", "0"}), "max-views"},
      {arguments("cube.off", {"--workspace", "0,0,0,-1,1,1"}), "--workspace"},
      {arguments("cube.off", {"--from", "1,2,3,0,0,0,0"}), "--from"},
      // Looks away from the object.
      {arguments("cube.off", {"--from", "0,0,1,0,0,0,1", "--background", "0"}),
       "the first view shows nothing in the workspace"},
      {arguments("cube.off", {"--reach", "missing.toml"}), "missing.toml"},
      {arguments("cube.off", {"--body", "0.1,-0.1,0.1"}), "--body"},
      {arguments("cube.off", {"--reach", "no_reach.toml"}), "reach"},
      {arguments("cube.off", {"--jump-edge-filter", "80"}), "angle"},
      {arguments("cube.off", {"--frames-per-view", "0"}), "frames-per-view"},
      {arguments("cube.off", {"--stop", "coverage=2"}), "coverage"},
      {arguments("cube.off", {"--support-plane", "nan"}), "--support-plane nan"},
  };
  expect_refused(inputs);
}

TEST_F(Reconstruct, MisreportedViewsAreRegisteredWhereThatIsAskedFor) {
  const Strings noisy{"--max-views", "3",   "--pictures", "off",
                      "--size",      "0.2", "--noise",    "pose=0.005/0.5"};
  EXPECT_FALSE(reconstruct("cube.off", noisy).contains("registration"));
  Strings with = noisy;
  with.insert(with.end(), {"--register", "on"});
  const json result = reconstruct("cube.off", with);
  const json& counts = result["registration"];
  EXPECT_EQ(counts["registered"].get<int>() + counts["too_little_overlap"].get<int>() +
                counts["refused"].get<int>(),
            3);
  EXPECT_EQ(result["per_view"][0]["registration"]["translation"], 0.0);
  EXPECT_GT(result["seconds"]["register"].get<double>(), 0);
  const json settings = json::parse(read("run/run.json"))["settings"];
  EXPECT_EQ(settings["register"], true);
  EXPECT_EQ(settings["pose_sigma"], settings["pose_noise"]);

  expect_refused(arguments("cube.off", {"--pose-sigma", "0.005,0.5"}), "--register SIGMA_M");
}

}  // namespace
}  // namespace viewgain
