// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Which poses `score` scores, and among which obstacles.
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"
#include "grid/voxels.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/core/reach.hpp"
#include "viewgain/formats/reach_toml.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/literature/classic_gains.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain {
namespace {

constexpr VoxelBox kUpperHalf{{-10, -10, 0}, {10, 10, 10}}, kBlock{{-3, -3, 4}, {3, 3, 5}};

class ScoreCandidates : public test::ProgramTest {
 protected:
  ScoreCandidates() {
    write_small_sensor();
    BeliefGrid grid({0.02, {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}}, {}, 0.02});
    // The upper half is free but for a block in its middle.
    test::for_each_voxel(kUpperHalf, [&](Index3 v) { grid.set(v, -0.4F); });
    test::for_each_voxel(kBlock, [&](Index3 v) {
      grid.set(v, 0.85F, Belief{{1e5F, 1e5F, 1e5F}, {}, 7});
    });
    save_vdb(grid, dir / "map.vdb");
    poses = sphere_poses(40, 0.45);
  }

  [[nodiscard]] json score(const Strings& more) const {
    return json::parse(run_well(arguments(more)));
  }
  [[nodiscard]] static Strings arguments(const Strings& more) {
    return test::joined({"score", "map.vdb", "--sensor", "small.toml", "--poses", "sphere:40,0.45",
                         "--top", "40", "--json", "--gain", "paper"},
                        more);
  }

  // Index -> gain.
  static std::map<std::size_t, double> gains(const json& scores) {
    std::map<std::size_t, double> result;
    for (const json& view : scores.at("best")) {
      result[view.at("index").get<std::size_t>()] = view.at("gain").get<double>();
    }
    return result;
  }

  std::vector<Pose> poses;
};

TEST_F(ScoreCandidates, ObstaclesFarFromTheMapAreNamed) {
  // One that is in millimetres has the map inside.
  write("room_mm.off", "OFF\n3 1 0\n-3000 -3000 0\n3000 -3000 0\n0 3000 3000\n3 0 1 2\n");
  for (const auto& [box, is_far] :
       std::vector<std::pair<std::string, bool>>{{"-2,-2,-1,2,2,-0.9", false},
                                                 {"900,0,0,950,50,50", true},
                                                 {"-300,-300,-1,300,300,-0.9", true},
                                                 {"room_mm.off", true}}) {
    const std::string said = run(arguments({"--obstacle", box})).err;
    EXPECT_EQ(said.find("--obstacle " + box) != std::string::npos, is_far) << said;
    EXPECT_EQ(said.find("Is the obstacle in metres?") != std::string::npos, is_far) << said;
  }
}

TEST_F(ScoreCandidates, PosesOfAFileThatSeeNothingAreExplained) {
  for (const std::string call : {"score", "next"}) {
    const auto said_of = [&](Pose (*change)(const Pose&)) {
      std::vector<Pose> changed = poses;
      for (Pose& pose : changed) pose = change(pose);
      write_tum(dir / "poses.txt", changed);
      return run({call, "map.vdb", "--sensor", "small.toml", "--poses", "poses.txt"});
    };
    EXPECT_EQ(said_of([](const Pose& T) { return T; }).err, "");
    const test::ProgramResult inverse = said_of([](const Pose& T) { return T.inverse(); });
    EXPECT_NE(inverse.err.find("the poses are world to camera"), std::string::npos) << inverse.err;
    const test::ProgramResult away = said_of([](const Pose& T) {
      return Pose{T.rotation(), T.translation() + Eigen::Vector3d(9, 0, 0)};
    });
    EXPECT_EQ(away.err,
              "viewgain: warning: poses.txt: 100 % of the poses see no voxel of the map\n");
    if (call == "next") {
      EXPECT_NE(away.out.find("none of the 40 candidate views has a positive gain"),
                std::string::npos)
          << away.out;
    }
  }
}

TEST_F(ScoreCandidates, PosesOutOfReachAreDroppedAndTheOthersKeepTheirNumbers) {
  ReachRegion reach;
  reach.half_spaces = {{Eigen::Vector3d::UnitZ(), 0.05}};
  write_reach_toml(dir / "reach.toml", reach);
  const auto all = gains(score({}));
  const json scores = score({"--reach", "reach.toml", "--out", "scores.csv"});
  std::size_t inside = 0;
  for (const Pose& pose : poses) inside += reach.contains(pose) ? 1 : 0;
  ASSERT_GT(inside, 5U);
  ASSERT_LT(inside, 35U);
  EXPECT_EQ(scores.at("poses"), 40);
  EXPECT_EQ(scores.at("dropped"), (json{{"unreachable", 40 - inside}}));
  const auto found = gains(scores);
  EXPECT_EQ(found.size(), inside);
  for (const auto& [index, gain] : found) {
    EXPECT_TRUE(reach.contains(poses[index])) << index;
    EXPECT_EQ(gain, all.at(index)) << index;
  }
  std::istringstream csv(read("scores.csv"));
  std::size_t rows = 0;
  std::string line;
  std::getline(csv, line);
  while (std::getline(csv, line)) {
    EXPECT_TRUE(found.contains(std::stoul(line))) << line;
    ++rows;
  }
  EXPECT_EQ(rows, inside);
  // Whatever is chosen, it is among them and has its own number.
  for (const Strings& selection :
       {Strings{"--race"}, Strings{"--set", "3"}, Strings{"--approximate", "1"}}) {
    const json chosen = score(test::joined(
        {"--reach", "reach.toml", "--out", "scores.csv", "--picture", "best.png"}, selection));
    ASSERT_GE(chosen.at("best").size(), 3U) << selection[0];
    const json& best = chosen.at("best")[0];
    const auto index = best.at("index").get<std::size_t>();
    EXPECT_EQ(index, scores.at("best")[0].at("index")) << selection[0];
    EXPECT_EQ(best.at("T_world_camera"), scores.at("best")[0].at("T_world_camera"));
  }
  EXPECT_EQ(score({}).at("dropped"), json::object());
}

// The gain less a pose's own cost and that of the way ranks, whatever way of scoring finds it.
TEST_F(ScoreCandidates, CostsRank) {
  BeliefGrid map = load_vdb(dir / "map.vdb");
  map.append_view(poses[7]);
  save_vdb(map, dir / "map.vdb");
  const auto free = gains(score({}));
  std::string text = "# one a pose\n";
  std::vector<double> worth;
  for (std::size_t i = 0; i < 40; ++i) {
    text += std::to_string(3 * i) + "\n";
    const double way = (poses[i].translation() - poses[7].translation()).norm();
    worth.push_back(free.at(i) - 3.0 * static_cast<double>(i) - 200 * way);
  }
  write("costs.txt", text);
  const Strings costs{"--costs", "costs.txt", "--cost-per-metre", "200"};
  const auto best =
      static_cast<std::size_t>(std::max_element(worth.begin(), worth.end()) - worth.begin());
  ASSERT_NE(best, score({})["best"][0]["index"]);
  for (const Strings& way : {Strings{}, Strings{"--race"}, Strings{"--approximate", "1"}}) {
    const json view = score(test::joined(costs, way))["best"][0];
    EXPECT_EQ(view["index"], best);
    EXPECT_NEAR(view["worth"].get<double>(), worth[best], 1e-6 * std::abs(worth[best]));
  }
  // Ways begin where the camera is said to be.
  const Eigen::Vector3d here(0.25, -0.5, 0.75);
  const json from = score({"--cost-per-metre", "200", "--from", "0.25,-0.5,0.75"})["best"][0];
  const std::size_t i = from["index"];
  EXPECT_NEAR(from["worth"].get<double>(),
              free.at(i) - 200 * (poses[i].translation() - here).norm(), 1e-6 * free.at(i));
  EXPECT_NE(from["worth"], score({"--cost-per-metre", "200"})["best"][0]["worth"]);
  // Tables and reports show it where there are costs.
  Strings as_text = arguments({"--approximate", "0.5"});
  std::erase(as_text, "--json");
  const Strings report = has_report_page() ? Strings{"--report", "score.html"} : Strings{};
  EXPECT_EQ(run_well(test::joined(as_text, report)).find("worth"), std::string::npos);
  if (has_report_page()) {
    EXPECT_EQ(read("score.html").find("\"gain\",\"worth\""), std::string::npos);
  }
  const std::string table = run_well(test::joined(test::joined(as_text, costs), report));
  EXPECT_NE(table.find("worth standard error"), std::string::npos) << table;
  if (has_report_page()) {
    EXPECT_NE(read("score.html").find("\"gain\",\"worth\""), std::string::npos);
  }
  (void)score(test::joined(costs, {"--out", "all.csv"}));
  std::istringstream rows(read("all.csv"));
  std::string line;
  std::getline(rows, line);
  EXPECT_EQ(line.substr(0, 18), "index,worth,gain,e");
  EXPECT_EQ(line.substr(line.find(",tx")), ",tx,ty,tz,qx,qy,qz,qw");
  write("few.txt", "1\n2\n");
  expect_refused_with(arguments({}),
                      {{{"--costs", "few.txt"}, "one cost per pose; poses: 40, costs: 2"},
                       {{"--cost-per-metre", "-1"}, "--cost-per-metre -1"},
                       {{"--cost-per-metre", "1", "--set", "2"}, "--set"},
                       {{"--from", "0,0,1"}, "--from 0,0,1"},
                       {{"--from", "0,0", "--cost-per-metre", "1"}, "--from 0,0"},
                       {{"--costs", "costs.txt", "--out", "costs.txt"}, "--costs"}});
}

TEST_F(ScoreCandidates, InfoTellsOfAPart) {
  const std::string text =
      run_well({"info", "map.vdb", "--workspace=-0.06,-0.06,0,0,0.06,0.2", "--criterion=trace"});
  for (const char* word : {"region", "mean sigma", "hits", "126", "entropy removed"}) {
    EXPECT_NE(text.find(word), std::string::npos) << word << "\n" << text;
  }
}

TEST_F(ScoreCandidates, RefusesWhatCannotBe) {
  write("far.toml", "[[shell]]\ncenter = [0, 0, 0]\nmin_radius = 5.0\nmax_radius = 6.0\n");
  write_cube();
  const test::Refusals inputs{
      {{"--reach", "far.toml"}, "40 unreachable"},
      {{"--reach", "none.toml"}, "none.toml"},
      {{"--obstacle", "none.off"}, "none.off"},
      {{"--obstacle", "1,0,0,0,1,1"}, "--obstacle"},
      {{"--obstacle", "0,0,0,1,1"}, "--obstacle"},
      {{"--obstacle", "cube.off", "--out", "cube.off"}, "--obstacle cube.off"},
      {{"--reach", "far.toml", "--out", "far.toml"}, "--reach far.toml"},
      {{"--body", "0.1,0.1,0.1"}, "--feasible on"},
      {{"--feasible", "on", "--body", "0.1,0.1,0"}, "--body"},
      {{"--support-plane", "0"}, "--feasible on"},
  };
  expect_refused_with(arguments({}), inputs);
}

// `score` by gains of the literature: columns, ranks, and what it refuses.

class ScoreClassic : public test::ProgramTest {
 protected:
  ScoreClassic() {
    write_small_sensor();
    test::for_each_voxel(kUpperHalf,
                         [&](Index3 v) { grid.set(v, -0.1F * static_cast<float>(1 + (v.x & 7))); });
    test::for_each_voxel(kBlock, [&](Index3 v) { grid.set(v, 0.85F); });
    grid.append_view(sphere_poses(40, 0.45)[0]);
    save_vdb(grid, dir / "map.vdb");
  }

  [[nodiscard]] static Strings arguments(const Strings& more) {
    return test::joined({"score", "map.vdb", "--sensor", "small.toml", "--poses", "sphere:40,0.45"},
                        more);
  }

  BeliefGrid grid{{0.02, {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}}, {}, 0.02}};
};

TEST_F(ScoreClassic, EachGainIsAColumn) {
  std::string names;
  for (const std::string& name : classic_gain_names()) {
    names.append(names.empty() ? "" : ",").append(name);
  }
  const json result = json::parse(
      run_well(arguments({"--gain", names, "--top", "40", "--json", "--out", "all.csv"})));
  EXPECT_EQ(result.at("gains"), json(classic_gain_names()));
  EXPECT_EQ(result.at("gain_units").size(), 10U);
  ASSERT_EQ(result.at("best").size(), 40U);
  double last = std::numeric_limits<double>::infinity();
  for (const json& view : result.at("best")) {
    EXPECT_EQ(view.at("status"), "ok");
    EXPECT_LE(view.at("occlusion_aware").get<double>(), last);
    last = view.at("occlusion_aware").get<double>();
  }
  std::istringstream csv(read("all.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "index," + names + ",status,tx,ty,tz,qx,qy,qz,qw");
  std::size_t rows = 0;
  for (; std::getline(csv, line); ++rows) {
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 18);
    EXPECT_TRUE(line.starts_with(std::to_string(rows) + ",")) << line;
  }
  EXPECT_EQ(rows, 40U);
}

TEST_F(ScoreClassic, RanksByTheFirstAndDropsPoses) {
  const json result = json::parse(
      run_well(arguments({"--gain", "unknown_count,occlusion_aware", "--top", "3", "--json",
                          "--feasible", "on", "--obstacle", "0.3,-1,-1,0.4,1,1"})));
  EXPECT_EQ(result.at("best").size(), 3U);
  EXPECT_GT(result.at("dropped").size(), 0U);
  EXPECT_LT(result.at("poses_scored").get<std::size_t>(), 40U);
  EXPECT_GE(result.at("best")[0].at("unknown_count"), result.at("best")[2].at("unknown_count"));
  const std::string table = run_well(arguments({"--gain", "unknown_volume,area_factor"}));
  EXPECT_NE(table.find("unknown_volume [m^3]"), std::string::npos);
  EXPECT_NE(table.find("area_factor [1]"), std::string::npos);
}

TEST_F(ScoreClassic, RefusesWhatDoesNotGoTogether) {
  const test::Refusals flags{{{"--race"}, "--race"},
                             {{"--set", "2"}, "--set"},
                             {{"--approximate", "0.1"}, "--approximate"},
                             {{"--picture", "p.png"}, "--picture"},
                             {{"--report", "r.html"}, "--report"},
                             {{"--weight", "0,0,0,1,1,1,2"}, "--weight"},
                             {{"--criterion", "trace"}, "--criterion"},
                             {{"--prior-sigma", "0.1"}, "--prior-sigma"},
                             {{"--hazard", "size=0.1"}, "--hazard"}};
  expect_refused_with(arguments({"--gain", "unknown_count"}), flags);
  expect_refused_with(arguments({}),
                      {{{"--gain", "paper,unknown_count"}, "paper must be given alone"},
                       {{"--gain", "unknown_count,unknown_count"}, "twice"},
                       {{"--gain", "unknwn_count"}, "unknown_count"}});
  // A map that records no views.
  BeliefGrid blank({0.02, {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}}, {}, 0.02});
  save_vdb(blank, dir / "map.vdb");
  expect_refused(arguments({"--gain", "proximity_count"}), "records no views");
}

}  // namespace
}  // namespace viewgain
