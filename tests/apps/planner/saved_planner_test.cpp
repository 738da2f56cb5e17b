// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// A planner that is saved and loaded goes on bit for bit.
#include <gtest/gtest.h>

#include <cstdio>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "apps/planner/bin_scene.hpp"
#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/planner/view_planner.hpp"

namespace viewgain {
namespace {

using test::BinScene;
using test::expect_error;
using test::PlannerSetUp;

std::string hexadecimal(double value) {
  char text[64];
  std::snprintf(text, sizeof text, " %a", value);
  return text;
}

// Takes a view and chooses the next one; all that it was told, bit for bit.
std::string step(ViewPlanner& planner, const BinScene& scene, std::size_t view) {
  const Pose& pose = scene.views[(7 * view) % scene.views.size()];
  const AddedView added = planner.add(scene.see(pose, view), pose);
  std::string told = std::to_string(added.view) + hexadecimal(added.entropy_removed) +
                     hexadecimal(added.update.new_area) + hexadecimal(added.progress.surface_area);
  const std::size_t candidates = planner.propose().candidates.size();
  told += " " + std::to_string(candidates);
  for (const RankedView& ranked : planner.rank(3, {.cost_per_metre = 2}).views) {
    told += " " + std::to_string(ranked.index) + hexadecimal(ranked.gain.gain) +
            hexadecimal(ranked.worth);
  }
  planner.tried(planner.rank(1).views.front().T_world_camera, view % 2 == 0);
  return told + " " + test::seen_of(planner);
}

TEST(SavedPlanner, GoesOnBitForBit) {
  const BinScene scene;
  const test::TemporaryFolder folder;
  int cases = 0;
  for (const GainModel model : {GainModel::paper, GainModel::combined}) {
    PlannerSetUp config = scene.config(model);
    config.planner.max_views = 5;  // the last one says so
    if (model == GainModel::combined) config.planner.stop_area = 0.9;
    const auto start = [&] {
      ViewPlanner planner = config.make(scene.sensor, {1});
      planner.add_poses({"dome", scene.views});
      return planner;
    };
    ViewPlanner whole = start(), parts = start();
    const auto path = folder.path() / "planner.vdb";
    std::set<std::string> ends;
    for (std::size_t view = 0; view < 5; ++view, ++cases) {
      EXPECT_EQ(step(parts, scene, view), step(whole, scene, view)) << view;
      parts.save(path);
      parts = config.load(path, scene.sensor, {2});
      parts.add_poses({"dome", scene.views});
      EXPECT_EQ(test::seen_of(parts), test::seen_of(whole));
      if (parts.should_stop()) ends.insert(std::string(stop_reason_name(*parts.should_stop())));
      EXPECT_EQ(parts.should_stop(), whole.should_stop());
      // The last proposal is not kept.
      EXPECT_EQ(parts.candidate_count(), 0U);
    }
    EXPECT_TRUE(ends.contains("max_views"));
    EXPECT_EQ(ends.contains("area"), model == GainModel::combined);
  }
  EXPECT_EQ(cases, 10);
}

TEST(SavedPlanner, LimitsAreThoseOfTheConfigurationItIsLoadedWith) {
  const BinScene scene;
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "planner.vdb";
  PlannerSetUp config = scene.config(GainModel::paper);
  config.planner.max_views = 2;
  ViewPlanner planner = config.make(scene.sensor, {1});
  planner.save(path);
  EXPECT_EQ(config.load(path, scene.sensor).should_stop(), std::nullopt);
  planner.add_poses({"dome", scene.views});
  for (std::size_t view = 0; view < 2; ++view) (void)step(planner, scene, view);
  EXPECT_EQ(planner.should_stop(), StopReason::max_views);
  planner.save(path);
  for (const auto& [max_views, reason] :
       {std::pair<std::size_t, std::optional<StopReason>>{1, StopReason::max_views},
        {2, StopReason::max_views},
        {3, std::nullopt}}) {
    config.planner.max_views = max_views;
    EXPECT_EQ(config.load(path, scene.sensor).should_stop(), reason) << max_views;
  }
}

// What was promised, and how often it was not kept, is in the file.
TEST(SavedPlanner, RemembersPromises) {
  const BinScene scene;
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "planner.vdb";
  PlannerSetUp config = scene.config(GainModel::combined);
  config.planner.idle_views = 0;
  config.planner.stop_area = 0;
  ViewPlanner planner = config.make(scene.sensor, {1});
  planner.add(scene.see(scene.views[0]), scene.views[0]);
  for (int view = 0; view < 3; ++view) {
    EXPECT_EQ(planner.should_stop(), std::nullopt) << view;
    planner.add_poses({"dome", scene.views});
    (void)planner.propose();
    const Pose next = planner.rank(1).views.front().T_world_camera;
    planner.save(path);
    planner = config.load(path, scene.sensor, {1});
    DepthFrame nothing = scene.see(next);
    std::fill(nothing.depth.begin(), nothing.depth.end(), DepthFrame::kInvalid);
    (void)planner.add(nothing, next);
    planner.save(path);
    planner = config.load(path, scene.sensor, {1});
  }
  EXPECT_EQ(planner.should_stop(), StopReason::promises);
  config.planner.broken_promises = 4;
  EXPECT_EQ(config.load(path, scene.sensor).should_stop(), std::nullopt);
}

TEST(SavedPlanner, KeepsTheMapsNotesBesideItsOwn) {
  const BinScene scene;
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "planner.vdb", again = folder.path() / "again.vdb";
  ViewPlanner planner = scene.config().make(scene.sensor, {1});
  DepthFrame frame = scene.see(scene.views[0]);
  frame.identity = "0123456789abcdef frame-000000.depth.png";
  (void)planner.add(frame, scene.views[0]);
  (void)planner.add(scene.see(scene.views[1]), scene.views[1]);  // nobody's
  const MapNotes notes = planner.scorer().grid().notes();
  EXPECT_EQ(notes.sensor, sensor_toml(scene.sensor));
  EXPECT_EQ(notes.frames, std::set<std::string>{frame.identity});
  EXPECT_TRUE(notes.others.empty());
  planner.save(path);
  const ViewPlanner loaded = scene.config().load(path, scene.sensor, {1});
  EXPECT_EQ(loaded.scorer().grid().notes(), notes);
  EXPECT_EQ(test::seen_of(loaded), test::seen_of(planner));
  // Through a map's hands, the planner's state goes along.
  save_vdb(load_vdb(path), again);
  EXPECT_EQ(test::seen_of(scene.config().load(again, scene.sensor, {1})), test::seen_of(planner));
}

TEST(SavedPlanner, RefusesAMapThatHasGrownWithoutIt) {
  const BinScene scene;
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "planner.vdb";
  ViewPlanner planner = scene.config().make(scene.sensor, {1});
  (void)planner.add(scene.see(scene.views[0]), scene.views[0]);
  planner.save(path);
  BeliefGrid grid = load_vdb(path);
  FrameIntegrator(scene.sensor).integrate(grid, scene.see(scene.views[1]), scene.views[1]);
  save_vdb(grid, path);
  expect_error(ErrorCode::invalid_argument,
               "has 2 views, but the planner that saved it added only 1",
               [&] { (void)scene.config().load(path, scene.sensor); });
}

TEST(SavedPlanner, RefusesWhatIsNone) {
  const BinScene scene;
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "planner.vdb";
  const PlannerSetUp config = scene.config();
  const auto refuses = [&](ErrorCode code, const std::string& part, const PlannerSetUp& with) {
    expect_error(code, part, [&] { (void)with.load(path, scene.sensor); });
    expect_error(code, "planner.vdb", [&] { (void)with.load(path, scene.sensor); });
  };
  refuses(ErrorCode::io, "", config);
  ViewPlanner planner = config.make(scene.sensor, {1});
  (void)planner.add(scene.see(scene.views[0]), scene.views[0]);
  save_vdb(planner.scorer().grid(), path);
  refuses(ErrorCode::format, "the map has no planner state", config);
  planner.tried(scene.views[4], false);
  planner.save(path);
  PlannerSetUp other = config;
  other.map.voxel_size = 0.005;
  refuses(ErrorCode::invalid_argument, "0.006", other);
  other = config;
  other.map.workspace.max[2] += 0.1;
  refuses(ErrorCode::invalid_argument, "workspace", other);
  other = config;
  other.map.prior_sigma = 0.02;
  refuses(ErrorCode::invalid_argument, "0.02", other);

  // A note that somebody changed, in each of its lines.
  const std::string note = test::notes_of(path).at("planner");
  const auto with_note = [&](const std::string& text) {
    save_vdb(planner.scorer().grid(), path, {.notes = MapNotes{.others = {{"planner", text}}}});
  };
  for (const auto& [from, to] :
       std::vector<std::pair<std::string, std::string>>{{"seen_area ", "seen_area x"},
                                                        {"before_choice 1", "before_choice 1.5"},
                                                        {"after_choice", "after_thought"},
                                                        {"missed ", "missed 1 "},
                                                        {"missed ", "missed nan"},
                                                        {"last_pose ", "last_pose 1 "},
                                                        {"last_pose ", "last_pose inf"},
                                                        {"seen_area", "version 2\nseen_area"}}) {
    std::string text = note;
    ASSERT_NE(text.find(from), std::string::npos) << from;
    with_note(text.replace(text.find(from), from.size(), to));
    refuses(ErrorCode::format, "planner.vdb (note planner):", config);
  }
  with_note("");
  refuses(ErrorCode::format, "version", config);
  with_note("version 1\n");
  refuses(ErrorCode::format, "version 1 of the planner's state", config);
  with_note(note + "of_view tired\n");
  refuses(ErrorCode::format, "tired", config);
  with_note(note);
  EXPECT_NO_THROW((void)config.load(path, scene.sensor));
}

// A planner that begins with a map counts what comes after it, and can be saved.
TEST(SavedPlanner, OneThatBeganWithAMapComesBack) {
  const BinScene scene;
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "planner.vdb";
  for (const GainModel model : {GainModel::paper, GainModel::combined}) {
    const PlannerSetUp config = scene.config(model);
    ViewScorer scorer(scene.sensor, config.map, {1});
    for (const std::size_t i : {0, 5}) scorer.add(scene.see(scene.views[i], i), scene.views[i]);
    const double before = scorer.progress().entropy_removed;
    ViewPlanner planner(std::move(scorer), config.planner);
    planner.add_poses({"dome", scene.views});
    const AddedView added = planner.add(scene.see(scene.views[9], 9), scene.views[9]);
    EXPECT_EQ(added.view, 0U);
    EXPECT_EQ(added.entropy_removed, added.progress.entropy_removed - before);
    EXPECT_GT(before, 0);
    planner.save(path);
    ViewPlanner again = config.load(path, scene.sensor, {1});
    again.add_poses({"dome", scene.views});
    EXPECT_EQ(again.propose().candidates.size(), planner.propose().candidates.size());
    const Ranking one = planner.rank(3, {.cost_per_metre = 1}),
                  two = again.rank(3, {.cost_per_metre = 1});
    ASSERT_EQ(one.views.size(), two.views.size());
    for (std::size_t i = 0; i < one.views.size(); ++i) {
      EXPECT_EQ(one.views[i].worth, two.views[i].worth);
      EXPECT_EQ(one.views[i].T_world_camera, two.views[i].T_world_camera);
    }
  }
}

}  // namespace
}  // namespace viewgain
