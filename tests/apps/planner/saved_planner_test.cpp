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
    PlannerConfig config = scene.config(model);
    config.max_views = 5;  // the last one says so
    if (model == GainModel::combined) config.stop_area = 0.9;
    const auto start = [&] {
      ViewPlanner planner(scene.sensor, config, {1});
      planner.add_poses({"dome", scene.views});
      return planner;
    };
    ViewPlanner whole = start(), parts = start();
    const auto path = folder.path() / "planner.vdb";
    std::set<std::string> ends;
    for (std::size_t view = 0; view < 5; ++view, ++cases) {
      EXPECT_EQ(step(parts, scene, view), step(whole, scene, view)) << view;
      parts.save(path);
      parts = ViewPlanner::load(path, scene.sensor, config, {2});
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
  PlannerConfig config = scene.config(GainModel::paper);
  config.max_views = 2;
  ViewPlanner planner(scene.sensor, config, {1});
  planner.save(path);
  EXPECT_EQ(ViewPlanner::load(path, scene.sensor, config).should_stop(), std::nullopt);
  planner.add_poses({"dome", scene.views});
  for (std::size_t view = 0; view < 2; ++view) (void)step(planner, scene, view);
  EXPECT_EQ(planner.should_stop(), StopReason::max_views);
  planner.save(path);
  for (const auto& [max_views, reason] :
       {std::pair<std::size_t, std::optional<StopReason>>{1, StopReason::max_views},
        {2, StopReason::max_views},
        {3, std::nullopt}}) {
    config.max_views = max_views;
    EXPECT_EQ(ViewPlanner::load(path, scene.sensor, config).should_stop(), reason) << max_views;
  }
}

// What was promised, and how often it was not kept, is in the file.
TEST(SavedPlanner, RemembersPromises) {
  const BinScene scene;
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "planner.vdb";
  PlannerConfig config = scene.config(GainModel::combined);
  config.idle_views = 0;
  config.stop_area = 0;
  ViewPlanner planner(scene.sensor, config, {1});
  planner.add(scene.see(scene.views[0]), scene.views[0]);
  for (int view = 0; view < 3; ++view) {
    EXPECT_EQ(planner.should_stop(), std::nullopt) << view;
    planner.add_poses({"dome", scene.views});
    (void)planner.propose();
    const Pose next = planner.rank(1).views.front().T_world_camera;
    planner.save(path);
    planner = ViewPlanner::load(path, scene.sensor, config, {1});
    DepthFrame nothing = scene.see(next);
    std::fill(nothing.depth.begin(), nothing.depth.end(), DepthFrame::kInvalid);
    (void)planner.add(nothing, next);
    planner.save(path);
    planner = ViewPlanner::load(path, scene.sensor, config, {1});
  }
  EXPECT_EQ(planner.should_stop(), StopReason::promises);
  config.broken_promises = 4;
  EXPECT_EQ(ViewPlanner::load(path, scene.sensor, config).should_stop(), std::nullopt);
}

TEST(SavedPlanner, KeepsTheMapsNotesBesideItsOwn) {
  const BinScene scene;
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "planner.vdb", again = folder.path() / "again.vdb";
  ViewPlanner planner(scene.sensor, scene.config(), {1});
  DepthFrame frame = scene.see(scene.views[0]);
  frame.identity = "0123456789abcdef frame-000000.depth.png";
  (void)planner.add(frame, scene.views[0]);
  (void)planner.add(scene.see(scene.views[1]), scene.views[1]);  // nobody's
  const MapNotes notes = planner.grid().notes();
  EXPECT_EQ(notes.sensor, sensor_toml(scene.sensor));
  EXPECT_EQ(notes.frames, std::set<std::string>{frame.identity});
  EXPECT_TRUE(notes.others.empty());
  planner.save(path);
  const ViewPlanner loaded = ViewPlanner::load(path, scene.sensor, scene.config(), {1});
  EXPECT_EQ(loaded.grid().notes(), notes);
  EXPECT_EQ(test::seen_of(loaded), test::seen_of(planner));
  // Through a map's hands, the planner's state goes along.
  save_vdb(load_vdb(path), again);
  EXPECT_EQ(test::seen_of(ViewPlanner::load(again, scene.sensor, scene.config(), {1})),
            test::seen_of(planner));
}

TEST(SavedPlanner, RefusesAMapThatHasGrownWithoutIt) {
  const BinScene scene;
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "planner.vdb";
  ViewPlanner planner(scene.sensor, scene.config(), {1});
  (void)planner.add(scene.see(scene.views[0]), scene.views[0]);
  planner.save(path);
  BeliefGrid grid = load_vdb(path);
  FrameIntegrator(scene.sensor).integrate(grid, scene.see(scene.views[1]), scene.views[1]);
  save_vdb(grid, path);
  expect_error(ErrorCode::invalid_argument, "has 2 views, of which its planner added 1",
               [&] { (void)ViewPlanner::load(path, scene.sensor, scene.config()); });
}

TEST(SavedPlanner, RefusesWhatIsNone) {
  const BinScene scene;
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "planner.vdb";
  const PlannerConfig config = scene.config();
  const auto refuses = [&](ErrorCode code, const std::string& part, const PlannerConfig& with) {
    expect_error(code, part, [&] { (void)ViewPlanner::load(path, scene.sensor, with); });
    expect_error(code, "planner.vdb", [&] { (void)ViewPlanner::load(path, scene.sensor, with); });
  };
  refuses(ErrorCode::io, "", config);
  ViewPlanner planner(scene.sensor, config, {1});
  (void)planner.add(scene.see(scene.views[0]), scene.views[0]);
  save_vdb(planner.grid(), path);
  refuses(ErrorCode::format, "without the state of a planner", config);
  planner.tried(scene.views[4], false);
  planner.save(path);
  PlannerConfig other = config;
  other.grid.voxel_size = 0.005;
  refuses(ErrorCode::invalid_argument, "0.006", other);
  other = config;
  other.grid.workspace.max[2] += 0.1;
  refuses(ErrorCode::invalid_argument, "workspace", other);
  other = config;
  other.grid.prior_sigma = 0.02;
  refuses(ErrorCode::invalid_argument, "0.02", other);

  // A note that somebody changed, in each of its lines.
  const std::string note = test::notes_of(path).at("planner");
  const auto with_note = [&](const std::string& text) {
    save_vdb(planner.grid(), path, {.notes = MapNotes{.others = {{"planner", text}}}});
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
  refuses(ErrorCode::format, "planner's state of version 1;", config);
  with_note(note + "of_view tired\n");
  refuses(ErrorCode::format, "tired", config);
  with_note(note);
  EXPECT_NO_THROW((void)ViewPlanner::load(path, scene.sensor, config));
}

}  // namespace
}  // namespace viewgain
