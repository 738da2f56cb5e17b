// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// `viewgain next` as a user would run it, on the map of a short run.

#include <Eigen/Core>
#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/formats/pose_files.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain {
namespace {

class Next : public test::ProgramTest {
 protected:
  Next() { make_small_run(); }

  [[nodiscard]] json candidates(const std::string& generator, const Strings& more = {}) const {
    json all = json::parse(
        run_well(test::joined({"next", "run/map.vdb", "--top", "all", "--generator", generator,
                               "--sensor", "tof.toml", "--out", "poses.txt", "--json"},
                              more)));
    all.erase("seconds");
    return all;
  }
};

TEST_F(Next, EveryGeneratorSaysWhatItMadeAndDropped) {
  const std::map<std::string, std::size_t> sizes{
      {"sphere", 500}, {"dome", 500}, {"rings", 48}, {"shell", 500}, {"sequence", 9}};
  for (const auto& [generator, size] : sizes) {
    const json result = candidates(generator);
    std::size_t dropped = 0;
    for (const auto& [reason, count] : result["dropped"].items())
      dropped += count.get<std::size_t>();
    EXPECT_EQ(result["candidates"].get<std::size_t>() + dropped, size) << generator;
    EXPECT_EQ(result["next"].size(), result["candidates"].get<std::size_t>());
    EXPECT_EQ(result["per_dropped"].size(), dropped);
    for (const json& one : result["per_dropped"]) {
      EXPECT_TRUE(result["dropped"].contains(one["reason"].get<std::string>())) << generator;
    }
    EXPECT_EQ(read_tum(dir / "poses.txt").poses.size(), result["next"].size());
  }
  (void)run_well({"next", "run/map.vdb", "--top", "all", "--generator", "rings", "--count", "80",
                  "--sensor", "tof.toml", "--out", "poses.npy"});
  (void)candidates("rings", {"--count", "80"});
  EXPECT_EQ(load_poses(dir / "poses.npy").poses, read_tum(dir / "poses.txt").poses);
  EXPECT_EQ(candidates("rings", {"--count", "80"})["next"].size() +
                candidates("rings", {"--count", "80"})["per_dropped"].size(),
            80U);
}

TEST_F(Next, BoundaryOnesSayWhyTheyExistAndCanBeScored) {
  const json result = candidates("boundary");
  ASSERT_GT(result["candidates"].get<int>(), 10);
  std::set<std::string> classes;
  for (const json& one : result["next"]) {
    classes.insert(one.at("class").get<std::string>());
    const auto run = one.at("run").get<std::size_t>();
    ASSERT_LT(run, result["runs"].size());
    EXPECT_EQ(result["runs"][run]["class"], one["class"]);
    EXPECT_GT(one.at("region_vertices").get<int>(), 0);
  }
  EXPECT_GE(classes.size(), 2U);
  const json scores = json::parse(
      run_well({"score", "run/map.vdb", "--poses", "poses.txt", "--sensor", "tof.toml", "--json"}));
  EXPECT_EQ(scores["poses"], result["candidates"]);
}

TEST_F(Next, AreRankedByAGain) {
  const json usual = candidates("sphere");
  EXPECT_EQ(usual["gain_model"], "combined");
  const json ranked = candidates("sphere", {"--gain", "surface"});
  EXPECT_EQ(ranked["gain_model"], "surface");
  EXPECT_EQ(ranked["gain_unit"], "m^2");
  EXPECT_EQ(ranked["candidates"], usual["candidates"]);
  EXPECT_TRUE(ranked["next"][0]["share"].is_null());
  // As score has them: same gains, in falling order.
  const json best =
      json::parse(run_well({"score", "run/map.vdb", "--poses", "poses.txt", "--sensor", "tof.toml",
                            "--gain", "surface", "--top", "1000", "--json"}))["best"];
  ASSERT_EQ(best.size(), ranked["next"].size());
  ASSERT_GT(best.size(), 100U);
  for (std::size_t i = 0; i < best.size(); ++i) {  // the file's quaternions round
    const auto gain = best[i]["gain"].get<double>();
    EXPECT_NEAR(ranked["next"][i]["gain"].get<double>(), gain, 1e-3 * gain);
  }
}

// A robot beside the object: a shell is where it can put the camera, and looks at the object.
TEST_F(Next, AShellIsRoundTheReach) {
  write("arm.toml",
        "[[shell]]\ncenter = [0.9, 0, 0]\nmin_radius = 0.3\nmax_radius = 0.8\n"
        "[[half_space]]\nnormal = [0, 0, 1]\noffset = 0.1\n");
  write("boxes.toml",
        "[[box]]\nmin = [0.4, -0.1, 0.2]\nmax = [0.9, 0.1, 0.3]\n"
        "[[box]]\nmin = [-0.9, -0.1, 0.2]\nmax = [-0.4, 0.1, 0.3]\n");
  const BeliefGrid grid = load_map((dir / "run/map.vdb").string());
  const Box box = grid.workspace();
  const Eigen::Vector3d middle =
      0.5 * (Eigen::Vector3d(box.min.data()) + Eigen::Vector3d(box.max.data()));
  for (const std::string reach : {"arm.toml", "boxes.toml"}) {
    const json result = candidates("shell", {"--reach", reach, "--count", "200"});
    EXPECT_EQ(result["dropped"].value("unreachable", 0), 0) << reach;
    const std::vector<Pose> poses = read_tum(dir / "poses.txt").poses;
    ASSERT_GT(poses.size(), 30U);
    std::size_t behind = 0;
    for (const Pose& pose : poses) {
      const Eigen::Vector3d sight = (middle - pose.translation()).normalized();
      EXPECT_NEAR(pose.rotation().col(2).dot(sight), 1, 1e-9);
      behind += pose.translation().x() < 0 ? 1 : 0;
    }
    EXPECT_EQ(behind > 10U, reach == "boxes.toml") << behind;
    EXPECT_EQ(candidates("shell", {"--reach", reach, "--count", "200"}), result);
  }
  // A list of poses is among the candidates of every generator.
  const std::vector<Pose> listed = sphere_poses(20, 0.6);
  write_tum(dir / "listed.txt", listed);
  write("list.toml", "poses = \"listed.txt\"\n");
  for (const std::string generator : {"shell", "sequence", "boundary"}) {
    const json result = candidates(generator, {"--reach", "list.toml"});
    ASSERT_GT(result["candidates"].get<int>(), 5) << generator;
    for (const json& one : result["next"]) EXPECT_EQ(one["generator"], "reach");
  }
  // A distance that is asked for holds.
  EXPECT_GT(
      candidates("shell", {"--reach", "arm.toml", "--distance", "0.6"})["dropped"]["unreachable"],
      300);
}

TEST_F(Next, WhereMostIsOutOfReachItSaysWhatWouldHelp) {
  write("arm.toml", "[[box]]\nmin = [0.4, -0.1, 0.2]\nmax = [0.9, 0.1, 0.3]\n");
  std::size_t helped = 0;
  for (const std::string generator : {"boundary", "sphere", "shell"}) {
    const json result = candidates(generator, {"--reach", "arm.toml"});
    std::size_t all = result["candidates"].get<std::size_t>();
    for (const auto& [reason, count] : result["dropped"].items()) all += count.get<std::size_t>();
    const std::size_t far = result["dropped"].value("unreachable", std::size_t{0});
    const std::string text = run_well({"next", "run/map.vdb", "--generator", generator, "--reach",
                                       "arm.toml", "--sensor", "tof.toml"});
    const std::string help = std::to_string(far) + " of " + std::to_string(all) +
                             " candidates are out of reach. Widen --reach, or";
    EXPECT_EQ(text.find(help) != std::string::npos, 2 * far > all) << generator << text;
    EXPECT_EQ(text.find("out of reach") != std::string::npos, 2 * far > all) << generator << text;
    helped += 2 * far > all ? 1 : 0;
  }
  EXPECT_EQ(helped, 2U);
}

TEST_F(Next, SeveralGeneratorsAreOneAfterTheOther) {
  const json boundary = candidates("boundary"), sphere = candidates("sphere", {"--count", "60"});
  const json both = candidates("sphere,boundary", {"--count", "60"});
  EXPECT_EQ(both["candidates"].get<int>(),
            boundary["candidates"].get<int>() + sphere["candidates"].get<int>());
  EXPECT_EQ(both["runs"], boundary["runs"]);
  std::map<std::string, int> counts;
  double last = 1e300;
  for (const json& one : both["next"]) {
    ++counts[one["generator"].get<std::string>()];
    EXPECT_LE(one["gain"].get<double>(), last);
    last = one["gain"].get<double>();
  }
  EXPECT_EQ(counts["sphere"], sphere["candidates"].get<int>());
  // The best ones are those of the two together.
  const double best =
      std::max(boundary["next"][0]["gain"].get<double>(), sphere["next"][0]["gain"].get<double>());
  EXPECT_EQ(both["next"][0]["gain"].get<double>(), best);
}

TEST_F(Next, TheBodyIsTheSensorsOrTheUsers) {
  const auto collisions = [&](const std::string& sensor, const Strings& more) {
    // Where none is possible that is an answer.
    return json::parse(run_well(
        test::joined({"next", "run/map.vdb", "--top", "all", "--generator", "sphere", "--distance",
                      "0.15", "--sensor", sensor, "--out", "poses.txt", "--json"},
                     more)))["dropped"]
        .value("collision", 0);
  };
  write("wide.toml", "body = [0.4, 0.4, 0.2]\n" + read("tof.toml"));
  const int of_default = collisions("tof.toml", {});
  const int of_file = collisions("wide.toml", {});
  EXPECT_GT(of_file, of_default);
  EXPECT_EQ(collisions("tof.toml", {"--body", "0.4,0.4,0.2"}), of_file);
  EXPECT_EQ(collisions("wide.toml", {"--body", "0.065,0.065,0.076"}), of_default);
}

// What ranking does with costs is ViewPlanner.CostsAreSubtracted's.
TEST_F(Next, NextChoosesAmongGivenPosesByTheirWorth) {
  write_tum(dir / "mine.txt", sphere_poses(30, 0.6));
  const auto next = [this](const Strings& more) {
    return json::parse(
        run_well(test::joined({"next", "run/map.vdb", "--sensor", "tof.toml", "--poses", "mine.txt",
                               "--gain", "paper", "--top", "30", "--json"},
                              more)))["next"];
  };
  std::string text = "# one each\n";
  for (int i = 0; i < 30; ++i) text += "70\n";
  write("costs.txt", text);
  const json free = next({}), paid = next({"--costs", "costs.txt"});
  ASSERT_GT(free.size(), 5U);
  ASSERT_GT(paid.size(), 1U);
  ASSERT_LE(paid.size(), free.size());  // those that are worth it
  for (std::size_t i = 0; i < paid.size(); ++i) {
    EXPECT_GT(paid[i]["worth"], 0);
    EXPECT_EQ(paid[i]["generator"], "poses");
    EXPECT_EQ(paid[i]["T_world_camera"], free[i]["T_world_camera"]);
    EXPECT_NEAR(paid[i]["worth"].get<double>(), free[i]["gain"].get<double>() - 70, 1e-6);
  }
  EXPECT_LT(next({"--cost-per-metre", "50"})[0]["worth"], free[0]["worth"]);
  // From elsewhere; all views are 0.6 m round the origin.
  const json there = next({"--cost-per-metre", "0.5", "--from", "99,0,0"});
  ASSERT_FALSE(there.empty());
  EXPECT_NEAR(free[0]["gain"].get<double>() - there[0]["worth"].get<double>(), 49.5, 0.5);
  // Both tables have the same words and units.
  for (const char* command : {"next", "score"}) {
    const std::string table =
        run_well({command, "run/map.vdb", "--sensor", "tof.toml", "--poses", "mine.txt",
                  "--cost-per-metre", "0.001", "--from", "0,0,1"});
    EXPECT_NE(table.find(" worth "), std::string::npos) << table;
    EXPECT_NE(table.find(" area [m^2] "), std::string::npos) << table;
  }
  write("few.txt", "1\n2\n");
  write("word.txt", "1\ncheap\n");
  expect_refused_with(
      {"next", "run/map.vdb", "--sensor", "tof.toml"},
      {{{"--costs", "costs.txt"}, "--poses"},
       {{"--poses", "mine.txt", "--costs", "few.txt"}, "one cost per pose; poses: 30, costs: 2"},
       {{"--poses", "mine.txt", "--costs", "word.txt"}, "word.txt:2"},
       {{"--poses", "mine.txt", "--count", "7"}, "--generator"},
       {{"--plan", "0"}, "--plan"},
       {{"--plan", "2,3"}, "--plan 2,3"},
       {{"--take", "2"}, "--plan K,M"},
       {{"--cost-per-metre", "-1"}, "--cost-per-metre -1"}});
}

TEST_F(Next, RefusesWhatCannotBe) {
  const test::Refusals inputs{
      {{"--generator", "rings", "--count", "50"}, "50"},
      {{"--generator", "cone"}, "cone"},
      {{"--generator", "dome,cone"}, "cone"},
      {{"--top", "0"}, "--top"},
      {{"--top", "some"}, "--top"},
      {{"--plan", "3"}, "--plan"},
      {{"--explain"}, "--explain"},
      {{"--generator", "sphere", "--body", "0.1,0,0.1"}, "--body"},
      {{"--generator", "boundary", "--count", "50"}, "--count"},
      {{"--generator", "boundary", "--center", "0,0,0"}, "--center"},
      {{"--generator", "dome", "--distance", "0"}, "--distance 0"},
      {{"--generator", "sphere", "--reach", "missing.toml"}, "missing.toml"},
  };
  expect_refused_with(
      {"next", "run/map.vdb", "--top", "all", "--sensor", "tof.toml", "--out", "none.txt"}, inputs);
}

}  // namespace
}  // namespace viewgain
