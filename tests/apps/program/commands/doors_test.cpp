// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The same frames give the same map and the same next views, whichever way they come in: integrate
// and next, model, model --watch and C++. C says what C++ says (CPlanner),
// Python what the program says of frames that cannot be used (test_planner.py).

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "apps/planner/planner_set_up.hpp"
#include "apps/program_runner.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/formats/reach_toml.hpp"
#include "viewgain/planner_mesh/candidate_generation.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain {
namespace {

constexpr std::size_t kTop = 4;

// A view by pose and gain.
struct Named {
  std::array<double, 12> pose{};
  double gain = 0;
  bool operator==(const Named&) const = default;
};

class Doors : public test::ProgramTest {
 protected:
  Doors() {
    write_cube();
    write_small_sensor();
    // A cube of 0.2 m on a table, and a wall that is known but was not there: readings behind it
    // carve up to it.
    run_well({"simulate", "cube.off", "--poses", "orbit:8,0.5,30", "--sensor", "small.toml",
              "--size", "0.2", "--place", "center", "--support-plane", "-0.1", "--noise", "on",
              "--out", "frames"});
    write("frames/done", "");
    write("box.toml", "[[box]]\nmin = [-0.6, -0.6, 0]\nmax = [0.6, 0.6, 0.6]\n");
    write_tum(dir / "poses.txt", sphere_poses(40, 0.5, Eigen::Vector3d::Zero()));
    write("poses.toml", "poses = \"poses.txt\"\n");
  }

  static Strings map_flags() {
    return {"--voxel", "0.02", "--workspace", "-0.2,-0.2,-0.1,0.2,0.2,0.2"};
  }
  static Strings view_flags(const std::string& reach) {
    Strings flags{"--support-plane", "-0.1", "--obstacle", "0.12,-0.3,-0.1,0.14,0.3,0"};
    if (!reach.empty()) flags.insert(flags.end(), {"--reach", reach});
    return flags;
  }
  static std::vector<Named> named(const json& next) {
    std::vector<Named> views;
    for (const json& one : next["next"]) {
      Named view{{}, one["gain"].get<double>()};
      for (std::size_t i = 0; i < 12; ++i) {
        view.pose[i] = one["T_world_camera"][i / 4][i % 4].get<double>();
      }
      views.push_back(view);
    }
    return views;
  }
  [[nodiscard]] std::string hash_of(const std::string& map) const {
    return load_map(dir / map).content_hash();
  }

  [[nodiscard]] test::PlannerSetUp planner_config(const std::string& reach) const {
    test::PlannerSetUp config;
    config.map.voxel_size = 0.02;
    config.map.workspace = {{-0.2, -0.2, -0.1}, {0.2, 0.2, 0.2}};
    config.map.obstacles.boxes = {{{0.12, -0.3, -0.1}, {0.14, 0.3, 0}}};
    config.map.support_plane = -0.1;
    if (!reach.empty()) config.planner.reach = read_reach_toml(dir / reach);
    return config;
  }

  // Through every door of the program and C++; returns what all of them say.
  std::vector<Named> expect_the_same(const std::string& reach) {
    const Strings top{"--top", std::to_string(kTop), "--json"};
    const auto call = [&](const Strings& words, const Strings& more) {
      return test::joined(test::joined(words, more), view_flags(reach));
    };
    run_well(test::joined(test::joined({"integrate", "frames", "--out", "map.vdb"}, map_flags()),
                          view_flags("")));
    const json of_map = json::parse(run_well(call({"next", "map.vdb"}, top)));
    run_well(
        call(test::joined({"model", "frames", "--watch", "--out", "plan", "--quiet"}, map_flags()),
             top));
    run_well(call(test::joined({"model", "frames", "--out", "run"}, map_flags()), top));
    // Of the folder of a run the map is taken.
    const json of_run = json::parse(run_well(call({"next", "run"}, top)));
    const json of_plan = json::parse(run_well(call({"next", "plan"}, top)));

    const std::string hash = hash_of("map.vdb");
    EXPECT_EQ(hash_of("plan/state.vdb"), hash);
    EXPECT_EQ(hash_of("run/map.vdb"), hash);
    const std::vector<Named> views = named(of_map);
    EXPECT_FALSE(views.empty());
    for (const char* file : {"surface.ply", "points.ply", "next.txt"}) {
      EXPECT_EQ(read(std::string("plan/") + file), read(std::string("run/") + file)) << file;
    }
    const json watched = json::parse(read("plan/next.json"));
    const json made = json::parse(read("run/run.json"));
    const json written = json::parse(read("run/next.json"));
    for (const json* other : {&of_run, &of_plan, &watched, &made, &written}) {
      EXPECT_EQ(named(*other), views);
      EXPECT_EQ((*other)["candidates"], of_map["candidates"]);
      EXPECT_EQ((*other)["dropped"], of_map["dropped"]);
    }

    const FrameSequence frames = open_frames(dir / "frames");
    ViewPlanner planner = planner_config(reach).make(frames.sensor, {1});
    planner.add_generation(std::make_shared<BoundaryGeneration>(
        planner.scorer(), default_boundary(frames.sensor, 0.02), ExecConfig{1}));
    for (std::size_t i = 0; i < frames.images.size(); ++i) {
      planner.add(load_frame(frames, i), frames.poses[i]);
    }
    EXPECT_EQ(planner.scorer().grid().content_hash(), hash);
    const Proposal& proposal = planner.propose();
    EXPECT_EQ(proposal.candidates.size(), of_map["candidates"].get<std::size_t>());
    std::vector<Named> own;
    for (const RankedView& view : planner.rank(kTop, {.together = true}).views) {
      own.push_back({view.T_world_camera.m, view.gain.gain});
    }
    EXPECT_EQ(own, views);
    return views;
  }
};

TEST_F(Doors, AgreeWithObstaclePlaneAndAReachableBox) {
  const std::vector<Named> views = expect_the_same("box.toml");
  for (const Named& view : views) EXPECT_GE(view.pose[11], 0);
}

TEST_F(Doors, AgreeOnAListOfPoses) { EXPECT_FALSE(expect_the_same("poses.toml").empty()); }

// Ways begin where the last frame was taken, though it shows nothing.
TEST_F(Doors, CountWaysFromAFrameThatCannotBeUsed) {
  const FrameSequence before = open_frames(dir / "frames");
  const Pose taken = before.poses[6], last = before.poses[7];
  ASSERT_GT((taken.translation() - last.translation()).norm(), 0.2);
  write_png(before.images[7], GrayImage{48, 36, std::vector<std::uint16_t>(48 * 36)});
  const Strings quiet{"--json", "--quiet", "--cost-per-metre", "4", "--top", "3"};
  const auto flags = test::joined(test::joined(map_flags(), view_flags("")), quiet);
  const auto call = [&](const Strings& words) {
    return json::parse(run_well(test::joined(words, flags)));
  };
  const auto expect_from = [](const json& said, const Eigen::Vector3d& from) {
    ASSERT_FALSE(said["next"].empty());
    for (const json& view : said["next"]) {
      const auto& rows = view["T_world_camera"];
      const Eigen::Vector3d to(rows[0][3].get<double>(), rows[1][3].get<double>(),
                               rows[2][3].get<double>());
      EXPECT_NEAR(view["worth"].get<double>(), view["gain"].get<double>() - 4 * (to - from).norm(),
                  1e-6);
    }
  };
  const Strings model{"model", "frames", "--pictures", "off", "--out", "run"};
  expect_from(call(model), last.translation());
  expect_from(call(test::joined(model, {"--from", "0.1,0.2,0.6"})), {0.1, 0.2, 0.6});
  (void)call({"model", "frames", "--watch", "--out", "plan"});
  expect_from(json::parse(read("plan/next.json")), last.translation());
  // A map's file knows its views alone.
  run_well(test::joined(
      test::joined({"integrate", "frames", "--quiet", "--out", "map.vdb"}, map_flags()),
      view_flags("")));
  expect_from(
      json::parse(run_well(test::joined(test::joined({"next", "map.vdb"}, view_flags("")), quiet))),
      taken.translation());
}

// 30 frames, seven of which cannot be used, each for a reason of its own.
TEST_F(Doors, SayTheSameOfFramesThatCannotBeUsed) {
  fs::remove_all(dir / "frames");
  run_well({"simulate", "cube.off", "--poses", "orbit:30,0.5,30", "--sensor", "small.toml",
            "--size", "0.2", "--place", "center", "--support-plane", "-0.1", "--out", "frames"});
  write("frames/done", "");
  const auto image = [](const char* number) {
    return "frames/frame-0000" + std::string(number) + ".depth.png";
  };
  std::vector<std::string> lines;
  std::istringstream poses(read("frames/poses.txt"));
  for (std::string line; std::getline(poses, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 31U);  // and a comment
  lines[1 + 3] = "3 nan nan nan 0 0 0 0";
  lines[1 + 19] = "19 90 0 0 0 0 0 1";
  lines.pop_back();
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  write("frames/poses.txt", text);
  // One pose is missing: that of the last image, as this says.
  write("frames/frames.toml", read("frames/frames.toml") + "first_frame = 0\n");
  write(image("07"), read(image("07")).substr(0, 60));
  write_png(dir / image("11"), GrayImage{10, 8, std::vector<std::uint16_t>(80, 6000)});
  write_png(dir / image("15"), GrayImage{48, 36, std::vector<std::uint16_t>(48 * 36)});
  fs::remove(dir / image("23"));  // nobody ever writes to this pipe
  ASSERT_EQ(::mkfifo((dir / image("23")).c_str(), 0600), 0);
  const json bad{{"lost_pose", 1}, {"no_pose", 1},    {"nothing_in_range", 1},
                 {"outside", 1},   {"unreadable", 2}, {"wrong_size", 1}};

  const Strings quiet{"--json", "--quiet"};
  const json integrated = json::parse(run_well(test::joined(
      test::joined({"integrate", "frames", "--out", "map.vdb", "--support-plane", "-0.1"},
                   map_flags()),
      quiet)));
  const auto call = [&](const Strings& words) {
    return json::parse(run_well(test::joined(
        test::joined(test::joined(words, map_flags()), {"--support-plane", "-0.1", "--top", "3"}),
        quiet)));
  };
  const json run = call({"model", "frames", "--pictures", "off", "--out", "run"});
  const json explained = json::parse(run_well({"next", "run", "--explain", "--json"}));
  ASSERT_FALSE(explained["next"].empty());
  for (const json& view : explained["next"]) {
    std::size_t sum = 0;
    for (const auto& [key, count] : view["rays"].items()) sum += count.get<std::size_t>();
    EXPECT_EQ(sum, 2 * view["rays"]["rays"].get<std::size_t>());
    EXPECT_GT(view["rays"]["unknown"], 0);  // else it would not gain
  }
  // The best ones are of different places: each shows what those before it do not.
  double share = 0, before = run["next"][0]["gain"].get<double>();
  for (const json& view : run["next"]) {
    EXPECT_LE(view["gain"].get<double>(), before * (1 + 1e-6));
    before = view["gain"].get<double>();
    share += view["share"].get<double>();
  }
  EXPECT_NEAR(share, 1, 1e-9);
  const json watched = call({"model", "frames", "--watch", "--out", "plan"});
  const std::string hash = hash_of("map.vdb");
  for (const json* said : {&integrated, &watched, &run}) {
    EXPECT_EQ((*said)["bad"], bad);
    EXPECT_EQ((*said)["frames"], 23);
    EXPECT_EQ((*said)["carved"], 0);
  }
  EXPECT_EQ(hash_of("plan/state.vdb"), hash);
  EXPECT_EQ(hash_of("run/map.vdb"), hash);
  const json there = json::parse(read("plan/next.json"));
  EXPECT_EQ(named(run), named(there));
  EXPECT_EQ(run["dropped"], there["dropped"]);

  const FrameSequence frames = open_frames(dir / "frames");
  test::PlannerSetUp config = planner_config("");
  config.map.obstacles = {};
  ViewPlanner planner = config.make(frames.sensor, {1});
  for (std::size_t i = 0; i < frames.images.size(); ++i) {
    const FrameReading reading = read_frame(frames, i);
    reading.fault.verdict == FrameVerdict::used
        ? planner.add(reading.frame, frames.poses[i])
        : planner.drop(reading.fault.verdict, frames.poses[i]);
  }
  EXPECT_EQ(json(bad_frames(planner.frames())), bad);
  EXPECT_EQ(count_of(planner.frames(), FrameVerdict::used), 23U);
  EXPECT_EQ(planner.scorer().grid().content_hash(), hash);

  // One that is gone when a run begins is that frame's fault alone, too.
  fs::remove(dir / image("25"));
  const json less = call({"model", "frames", "--pictures", "off", "--out", "less"});
  EXPECT_EQ(less["bad"]["unreadable"], 3);
  EXPECT_EQ(less["frames"], 22);
}

}  // namespace
}  // namespace viewgain
