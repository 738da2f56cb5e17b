// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Views that go together, and plans of which some are taken before it is decided anew.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "apps/planner/bin_scene.hpp"
#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "viewgain/planner/view_planner.hpp"
#include "viewgain/raycast/view_tour.hpp"

namespace viewgain {
namespace {

using test::BinScene;
using test::expect_error;
using test::PlannerSetUp;

class ViewPlan : public testing::Test {
 protected:
  [[nodiscard]] ViewPlanner planner(PlanAhead ahead, GainModel model = GainModel::combined) const {
    PlannerSetUp config = scene.config(model);
    config.planner.ahead = ahead;
    ViewPlanner made = config.make(scene.sensor, {1});
    made.add_poses({"dome", scene.views});
    made.add(scene.see(scene.views[3]), scene.views[3]);
    return made;
  }
  void take(ViewPlanner& planner, const Pose& pose) const { planner.add(scene.see(pose), pose); }

  BinScene scene;
};

struct Height : ViewMeasure {
  [[nodiscard]] double measure(const Pose& T_world_camera, std::span<const Hit>) const override {
    return T_world_camera.translation().z();
  }
};

std::vector<Pose> poses_of(const Ranking& ranking) {
  std::vector<Pose> poses;
  for (const RankedView& view : ranking.views) poses.push_back(view.T_world_camera);
  return poses;
}

TEST_F(ViewPlan, ViewsThatGoTogetherAreTheBestSets) {
  for (const GainModel model : {GainModel::paper, GainModel::surface, GainModel::combined}) {
    ViewPlanner planner = this->planner({}, model);
    const std::vector<Pose> poses = viewgain::poses_of(planner.propose().candidates);
    const ViewSet set = planner.scorer().evaluator()->best_set(poses, 4);
    const Ranking together = planner.rank(4, {.together = true, .exact = true});
    ASSERT_GE(together.views.size(), 2U);
    for (std::size_t i = 0; i < together.views.size(); ++i) {
      EXPECT_EQ(together.views[i].index, set.indices[i]);
      EXPECT_EQ(together.views[i].gain.gain, set.marginal[i].gain);
    }
    EXPECT_EQ(together.views[0].index,
              planner.rank(1, {.together = true, .exact = true}).views[0].index);
    const Height height;
    expect_error(ErrorCode::invalid_argument, "cannot be used to choose a set of views",
                 [&] { (void)planner.rank(2, {.measure = &height, .together = true}); });
  }
}

TEST_F(ViewPlan, ThreeAreTakenInTheirOrderAndThenItIsPlannedAnew) {
  for (const GainModel model : {GainModel::paper, GainModel::combined}) {
    ViewPlanner planner = this->planner({.plan = 3, .take = 3, .least_share = 0}, model);
    const std::size_t candidates = planner.propose().candidates.size();
    EXPECT_GT(candidates, 10U);
    const std::vector<Pose> all = viewgain::poses_of(planner.propose().candidates);
    const RankConfig exact{.exact = true};
    const std::vector<Pose> planned = poses_of(planner.rank(3, exact));
    ASSERT_EQ(planned.size(), 3U);
    // The set is the greedy one, and no order of it is shorter.
    const Pose here = scene.views[3];
    const ViewTour tour = plan_tour(*planner.scorer().evaluator(), all,
                                    {.max_stops = 3, .way = straight_ways(here, all)});
    std::vector<Pose> expected;
    for (const std::size_t place : tour.tour.stops) {
      expected.push_back(all[tour.set.indices[place]]);
    }
    EXPECT_EQ(planned, expected);
    EXPECT_EQ(planner.rank(1, exact).views[0].T_world_camera, planned[0]);
    EXPECT_NEAR(planner.rank(2, exact).way, tour.tour.cost, 1e-12);

    for (std::size_t taken = 0; taken < 3; ++taken) {
      take(planner, planned[taken]);
      const Proposal& proposal = planner.propose();
      if (taken == 2) {
        EXPECT_GT(proposal.candidates.size(), 10U);
        EXPECT_EQ(proposal.candidates[0].generator, "dome");
        break;
      }
      ASSERT_EQ(proposal.candidates.size(), 2 - taken);
      EXPECT_EQ(proposal.candidates[0].generator, kPlanned);
      const Ranking left = planner.rank(5);
      ASSERT_EQ(left.views.size(), 2 - taken);
      EXPECT_EQ(left.views[0].T_world_camera, planned[taken + 1]);
      EXPECT_EQ(left.views[0].gain.gain,
                planner.scorer().evaluator()->evaluate(planned[taken + 1]).gain);
      EXPECT_TRUE(std::isnan(left.worth));
    }
  }
}

TEST_F(ViewPlan, OneOfThreeIsTakenBeforeItIsPlannedAnew) {
  ViewPlanner planner = this->planner({.plan = 3, .take = 1, .least_share = 0});
  for (int view = 0; view < 2; ++view) {
    EXPECT_EQ(planner.propose().candidates[0].generator, "dome");
    const Ranking planned = planner.rank(3);
    ASSERT_EQ(planned.views.size(), 3U);
    take(planner, planned.views[0].T_world_camera);
  }
}

TEST_F(ViewPlan, WhatWasMissedOrPromisesLittleIsPlannedAnew) {
  ViewPlanner planner = this->planner({.plan = 4, .take = 4, .least_share = 0});
  (void)planner.propose();
  const std::vector<Pose> planned = poses_of(planner.rank(4));
  ASSERT_EQ(planned.size(), 4U);
  // A frame from elsewhere stands for the first, which was missed; so is the third.
  planner.tried(planned[0], false);
  planner.tried(planned[2], false);
  take(planner, scene.views[11]);
  const std::vector<Pose> left = viewgain::poses_of(planner.propose().candidates);
  EXPECT_EQ(left, (std::vector<Pose>{planned[1], planned[3]}));
  EXPECT_EQ(planner.dropped().size(), 1U);
  EXPECT_EQ(planner.dropped()[0].reason, kMissed);
  // The second before the first of those that are left: one is left.
  take(planner, planned[3]);
  EXPECT_EQ(viewgain::poses_of(planner.propose().candidates), std::vector<Pose>{planned[1]});

  // After the first view half of what is seen so far is no longer to be had.
  ViewPlanner greedy = this->planner({.plan = 4, .take = 4, .least_share = 0.5});
  (void)greedy.propose();
  const Ranking first = greedy.rank(4);
  for (std::size_t i = 1; i < first.views.size(); ++i) EXPECT_GT(first.views[i].gain.area, 0);
  take(greedy, first.views[0].T_world_camera);
  EXPECT_EQ(greedy.propose().candidates[0].generator, "dome");
}

TEST_F(ViewPlan, ASavedPlannerGoesOnWithIt) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "planner.vdb";
  const PlanAhead ahead{.plan = 3, .take = 3, .least_share = 0};
  PlannerSetUp config = scene.config();
  config.planner.ahead = ahead;
  ViewPlanner whole = planner(ahead), parts = planner(ahead);
  int planned = 0;
  for (int view = 0; view < 5; ++view) {
    std::vector<Pose> next;
    for (ViewPlanner* one : {&whole, &parts}) {
      const Proposal& proposal = one->propose();
      if (one == &whole && proposal.candidates[0].generator == kPlanned) ++planned;
      const Ranking ranking = one->rank();
      next.push_back(ranking.views.at(0).T_world_camera);
    }
    ASSERT_EQ(next[0], next[1]);
    parts.save(path);
    parts = config.load(path, scene.sensor, {2});
    parts.add_poses({"dome", scene.views});
    take(whole, next[0]);
    take(parts, next[0]);
    EXPECT_EQ(test::seen_of(parts), test::seen_of(whole));
  }
  EXPECT_GE(planned, 2);  // the second and third of the first plan
}

TEST_F(ViewPlan, RefusesWhatCannotBe) {
  const auto refuses = [&](const PlanAhead& ahead, const char* part) {
    expect_error(ErrorCode::invalid_argument, part, [&] { (void)planner(ahead); });
  };
  refuses({.plan = 0}, "plan must be in 1..1000, not 0");
  refuses({.plan = 1001, .take = 1}, "plan must be in 1..1000, not 1001");
  refuses({.plan = 3, .take = 4}, "(plan), not 4");
  refuses({.plan = 3, .take = 0}, "(plan), not 0");
  refuses({.plan = 3, .take = 1, .least_share = 1},
          "least_share must be at least 0 and less than 1, not 1");
}

}  // namespace
}  // namespace viewgain
