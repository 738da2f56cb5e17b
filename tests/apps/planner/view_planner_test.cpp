// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The step interface against the parts that it is made of, called one by one.
#include "viewgain/planner/view_planner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <stop_token>
#include <vector>

#include "apps/planner/bin_scene.hpp"
#include "core/expect_error.hpp"
#include "viewgain/grid/hazard_calibration.hpp"
#include "viewgain/planner/planner_parts.hpp"
#include "viewgain/planner/view_proposer.hpp"

namespace viewgain {
namespace {

using test::BinScene;
using test::expect_error;
using test::PlannerSetUp;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

bool same_bits(const ViewGain& a, const ViewGain& b) {
  const auto same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  return same(a.gain, b.gain) && same(a.area, b.area) && a.rays == b.rays && a.hits == b.hits;
}

// What the planner should say, from the parts alone: a map by the integrator, a new scene, checker
// and evaluator for each view.
class Parts {
 public:
  Parts(const BinScene& scene, const PlannerSetUp& config)
      : scene_(scene),
        config_(config),
        grid_(config.map.grid(), scene.sensor),
        integrator_(scene.sensor, {.support_plane = config.map.support_plane}, {1}) {}

  void add(DepthFrame frame, const Pose& pose) {
    ObstacleView(config_.map.obstacles, scene_.sensor).mark(frame, pose);
    if (config_.map.gain.model != GainModel::paper) {
      const HazardCalibration calibration(scene_.sensor, config_.map.support_plane);
      calibration.count(grid_, HazardProbe(grid_.snapshot()), frame, pose);
    }
    integrator_.integrate(grid_, frame, pose);
  }
  [[nodiscard]] std::shared_ptr<const VoxelScene> scene() const {
    return VoxelScene::build(grid_, config_.map.surroundings(), {1});
  }
  [[nodiscard]] std::vector<Pose> possible(const std::vector<Pose>& poses) const {
    const FeasibilityChecker checker(scene(), feasibility_of(scene_.sensor));
    return feasible_poses(checker, poses, grid_.views()).poses;
  }
  [[nodiscard]] std::vector<ViewGain> gains(const std::vector<Pose>& poses) const {
    return GainEvaluator(scene(), scene_.sensor, config_.map.gain, {1}).evaluate(poses);
  }
  [[nodiscard]] const BeliefGrid& grid() const { return grid_; }

 private:
  const BinScene& scene_;
  PlannerSetUp config_;
  BeliefGrid grid_;
  FrameIntegrator integrator_;
};

TEST(ViewPlanner, SaysWhatThePartsSay) {
  const BinScene scene;
  for (const GainModel model : {GainModel::paper, GainModel::surface, GainModel::combined}) {
    const PlannerSetUp config = scene.config(model);
    ViewPlanner planner = config.make(scene.sensor, {2});
    planner.add_poses({"dome", scene.views});
    Parts parts(scene, config);
    Pose next = scene.views[3];
    for (std::size_t view = 0; view < 3; ++view) {
      const DepthFrame frame = scene.see(next, view);
      const double before = parts.grid().statistics().entropy_removed;
      const AddedView added = planner.add(frame, next);
      parts.add(frame, next);
      EXPECT_EQ(added.view, view);
      EXPECT_EQ(planner.scorer().grid().content_hash(), parts.grid().content_hash());
      const BeliefGrid::Statistics statistics = parts.grid().statistics();
      EXPECT_EQ(added.progress.entropy_removed, statistics.entropy_removed);
      EXPECT_EQ(added.entropy_removed, statistics.entropy_removed - before);
      EXPECT_EQ(added.progress.unknown_voxels, statistics.unknown);
      EXPECT_EQ(std::isnan(added.update.new_area), model == GainModel::paper);
      if (model != GainModel::paper && view == 0) {
        EXPECT_GT(added.update.new_area, 0.003);
      }

      const std::vector<Pose> possible = parts.possible(scene.views);
      const Proposal& proposal = planner.propose();
      ASSERT_EQ(proposal.candidates.size(), possible.size());
      for (std::size_t i = 0; i < possible.size(); ++i) {
        EXPECT_EQ(proposal.candidates[i].T_world_camera, possible[i]);
        EXPECT_EQ(proposal.candidates[i].generator, "dome");
      }
      EXPECT_EQ(planner.candidate_count(), possible.size());
      EXPECT_GE(proposal.dropped.at("taken"), view + 1);
      EXPECT_EQ(planner.dropped().size(), scene.views.size() - possible.size());

      const std::vector<ViewGain> gains = parts.gains(possible);
      const std::vector<std::size_t> best = best_indices(gains, 4);
      const Ranking ranking = planner.rank(4, {.exact = true});
      ASSERT_EQ(ranking.views.size(), 4U);
      for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(ranking.views[i].index, best[i]);
        EXPECT_TRUE(same_bits(ranking.views[i].gain, gains[best[i]]));
        EXPECT_EQ(ranking.views[i].worth, gains[best[i]].gain);
      }
      // The same of given poses; and few rays find the same best here, as all survive.
      EXPECT_EQ(planner.rank(possible, 1, {.exact = true}).views.front().index, best[0]);
      EXPECT_EQ(planner.rank(1).views.front().index, best[0]);
      next = ranking.views.front().T_world_camera;
    }
  }
}

TEST(ViewPlanner, WhatWasTriedIsNotProposedAgain) {
  const BinScene scene;
  for (const bool check : {true, false}) {
    PlannerSetUp config = scene.config();
    config.planner.check_feasibility = check;
    ViewPlanner planner = config.make(scene.sensor, {1});
    planner.add_poses({"dome", scene.views});
    planner.add(scene.see(scene.views[0]), scene.views[0]);
    const std::vector<Candidate> before = planner.propose().candidates;
    planner.tried(before[2].T_world_camera, false);
    planner.tried(before[4].T_world_camera, true);
    Pose near = before[6].T_world_camera;  // within the tolerance of 10 mm
    near.m[3] += 0.008;
    planner.tried(near, false);
    // Out of the proposal as it stands, and of the next one.
    EXPECT_EQ(planner.candidate_count(), before.size() - 3);
    EXPECT_EQ(planner.rank(before.size()).views.size(), before.size() - 3);
    const Proposal& after = planner.propose();
    EXPECT_EQ(after.candidates.size(), before.size() - 3);
    EXPECT_EQ(after.dropped.at("missed"), 2U);
    EXPECT_EQ(after.dropped.at("taken"), 2U);
    for (const Candidate& candidate : after.candidates) {
      for (const std::size_t gone : {2U, 4U, 6U}) {
        EXPECT_FALSE(candidate.T_world_camera == before[gone].T_world_camera);
      }
    }
    EXPECT_EQ(std::count_if(planner.dropped().begin(), planner.dropped().end(),
                            [](const DroppedCandidate& d) { return d.reason == kMissed; }),
              2);
  }
}

TEST(ViewPlanner, CostsAreSubtracted) {
  const BinScene scene;
  ViewPlanner planner = scene.config(GainModel::paper).make(scene.sensor, {1});
  planner.add_poses({"dome", scene.views});
  planner.add(scene.see(scene.views[0]), scene.views[0]);
  const std::size_t count = planner.propose().candidates.size();
  const Ranking free = planner.rank(count);
  std::vector<double> costs(count);
  for (std::size_t i = 0; i < count; ++i) costs[i] = 3.0 * static_cast<double>(i);
  const Ranking paid = planner.rank(count, {.costs = costs, .cost_per_metre = 5000});
  ASSERT_EQ(paid.views.size(), count);
  std::size_t cases = 0;
  for (const RankedView& view : paid.views) {
    const auto found = std::find_if(free.views.begin(), free.views.end(),
                                    [&](const RankedView& v) { return v.index == view.index; });
    ASSERT_NE(found, free.views.end());
    const double way = (view.T_world_camera.translation() - scene.views[0].translation()).norm();
    EXPECT_NEAR(view.worth, found->gain.gain - costs[view.index] - 5000 * way, 1e-9);
    if (cases > 0) {
      EXPECT_LE(view.worth, paid.views[cases - 1].worth);
    }
    ++cases;
  }
  EXPECT_EQ(cases, count);
  EXPECT_NE(paid.views.front().index, free.views.front().index);
  // The dearest way that the best is worth, and a little more.
  EXPECT_EQ(planner.should_stop(), std::nullopt);
  std::vector<double> dear(count);
  double dearest = 0;
  for (const RankedView& view : free.views) dearest = std::max(dearest, view.gain.gain);
  for (const double factor : {0.999, 1.0, 1.001}) {
    std::fill(dear.begin(), dear.end(), factor * dearest);
    (void)planner.rank(1, {.costs = dear});
    EXPECT_EQ(planner.should_stop(), factor < 1 ? std::nullopt : std::optional(StopReason::cost));
  }
  (void)planner.rank(1);
  EXPECT_EQ(planner.should_stop(), std::nullopt);
}

TEST(ViewPlanner, SaysWhyToEnd) {
  const BinScene scene;
  PlannerSetUp config = scene.config(GainModel::paper);
  config.planner.max_views = 2;
  ViewPlanner by_budget = config.make(scene.sensor, {1});
  by_budget.add_poses({"dome", scene.views});
  by_budget.add(scene.see(scene.views[0]), scene.views[0]);
  EXPECT_FALSE(by_budget.should_stop());
  by_budget.add(scene.see(scene.views[5], 1), scene.views[5]);
  EXPECT_EQ(by_budget.should_stop(), StopReason::max_views);

  config.planner.max_views = 20;
  config.planner.idle_views = 2;
  // Before the first pose that is known nothing is idle.
  ViewPlanner late = config.make(scene.sensor, {1});
  for (int i = 0; i < 5; ++i) {
    (void)late.drop(FrameVerdict::lost_pose, std::nullopt);
    EXPECT_FALSE(late.should_stop()) << i;
  }
  late.add(scene.see(scene.views[0]), scene.views[0]);
  EXPECT_FALSE(late.should_stop());
  ViewPlanner idle = config.make(scene.sensor, {1});
  DepthFrame nothing = scene.see(scene.views[0]);
  std::fill(nothing.depth.begin(), nothing.depth.end(), DepthFrame::kInvalid);
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(idle.should_stop());
    idle.add(nothing, scene.views[0]);
  }
  EXPECT_EQ(idle.should_stop(), StopReason::idle);

  ViewPlanner none = config.make(scene.sensor, {1});
  none.add(scene.see(scene.views[0]), scene.views[0]);
  EXPECT_TRUE(none.propose().candidates.empty());
  EXPECT_EQ(none.should_stop(), StopReason::no_candidates);
  none.add_poses({"same", {scene.views[0]}});
  (void)none.propose();
  EXPECT_EQ(none.should_stop(), StopReason::no_candidates);
  EXPECT_TRUE(none.rank(3).views.empty());
  EXPECT_EQ(none.should_stop(), StopReason::no_candidates);
  none.add_poses({"dome", scene.views});
  (void)none.propose();
  EXPECT_FALSE(none.should_stop());

  config.planner.reach.half_spaces = {{{0, 0, 1}, 5.0}};
  ViewPlanner far = config.make(scene.sensor, {1});
  far.add_poses({"dome", scene.views});
  far.add(scene.see(scene.views[0]), scene.views[0]);
  EXPECT_TRUE(far.propose().candidates.empty());
  EXPECT_EQ(far.should_stop(), StopReason::unreachable);

  // By the paper's gain a limit that nothing meets.
  config = scene.config(GainModel::paper);
  config.planner.stop_gain = 1e6;
  ViewPlanner gain = config.make(scene.sensor, {1});
  gain.add_poses({"dome", scene.views});
  gain.add(scene.see(scene.views[0]), scene.views[0]);
  EXPECT_FALSE(gain.should_stop());
  (void)gain.rank(scene.views, 1);  // nobody's candidates
  (void)gain.rank(std::vector<Pose>{}, 1);
  EXPECT_FALSE(gain.should_stop());
  (void)gain.propose();
  EXPECT_FALSE(gain.should_stop());
  (void)gain.rank();
  EXPECT_EQ(gain.should_stop(), StopReason::gain);
  gain.add(scene.see(scene.views[1]), scene.views[1]);
  EXPECT_FALSE(gain.should_stop());
}

// Frames that say nothing where the best view is: what was promised does not come. Views from
// elsewhere, or that nobody ranked, break no promise.
TEST(ViewPlanner, EndsForPromisesThatAreNotKept) {
  const BinScene scene;
  for (const char* how : {"there", "elsewhere", "unranked", "never"}) {
    PlannerSetUp config = scene.config(GainModel::combined);
    config.planner.idle_views = 0;
    config.planner.stop_area = 0;
    if (*how == 'n') config.planner.broken_promises = 0;
    ViewPlanner planner = config.make(scene.sensor, {1});
    planner.add_poses({"dome", scene.views});
    planner.add(scene.see(scene.views[0]), scene.views[0]);
    for (std::size_t view = 1; view <= 3; ++view) {
      EXPECT_EQ(planner.should_stop(), std::nullopt) << how << view;
      (void)planner.propose();
      Pose next = scene.views[3 * view];
      if (*how != 'u') next = planner.rank(1).views.front().T_world_camera;
      if (*how == 'e')
        next = Pose(next.rotation(), next.translation() + Eigen::Vector3d(0, 0, 0.02));
      DepthFrame nothing = scene.see(next);
      std::fill(nothing.depth.begin(), nothing.depth.end(), DepthFrame::kInvalid);
      (void)planner.add(nothing, next);
    }
    EXPECT_EQ(planner.should_stop(),
              *how == 't' ? std::optional(StopReason::promises) : std::nullopt)
        << how;
  }
}

// Proposes one pose, and says that it has dropped two.
class OneMore : public ViewpointGeneration {
 public:
  explicit OneMore(const Pose& pose) : pose_(pose) {}
  Proposal generate(const Pose& T_world_camera) override {
    last = T_world_camera;
    return {{{pose_, "more", BoundaryClass::top, 7}}, {{"too dark", 2}}};
  }
  Pose last;

 private:
  Pose pose_;
};

TEST(ViewPlanner, ProposesWhatSetsReachAndGenerationsHave) {
  const BinScene scene;
  PlannerSetUp config = scene.config();
  config.planner.reach.poses = {scene.views[1], scene.views[2], scene.views[3]};
  ViewPlanner planner = config.make(scene.sensor, {1});
  planner.add_poses({"mine", {scene.views[2], scene.views[9]}});
  const auto more = std::make_shared<OneMore>(scene.views[3]);
  planner.add_generation(more);
  planner.add(scene.see(scene.views[1]), scene.views[1]);
  const Proposal& proposal = planner.propose();
  std::vector<std::string> names;
  for (const Candidate& candidate : proposal.candidates) names.push_back(candidate.generator);
  EXPECT_EQ(names, (std::vector<std::string>{"reach", "reach", "mine", "more"}));
  EXPECT_EQ(proposal.candidates.back().number, 7U);
  EXPECT_EQ(proposal.dropped.at("too dark"), 2U);
  EXPECT_EQ(proposal.dropped.at("unreachable"), 1U);
  EXPECT_EQ(proposal.dropped.at("taken"), 1U);
  EXPECT_EQ(more->last, scene.views[1]);
  EXPECT_EQ(planner.seconds().count("candidates"), 1U);
}

TEST(ViewPlanner, VoxelsInMillimetresAreRefused) {
  const BinScene scene;
  PlannerSetUp config = scene.config();
  const auto make = [&] { (void)config.make(scene.sensor, {1}); };
  config.map.voxel_size = 0.5;  // the workspace is 0.3 m long
  expect_error(ErrorCode::invalid_argument, "lengths must be in metres", make);
  config.map.workspace = {{-20, -20, -20}, {20, 20, 20}};
  EXPECT_NO_THROW(make());
  config.map.voxel_size = 6;  // it sees to 5 m
  expect_error(ErrorCode::invalid_argument, "lengths must be in metres", make);
}

TEST(ViewPlanner, RefusesWrongUseAndStaysAsItWas) {
  const BinScene scene;
  ViewPlanner planner = scene.config().make(scene.sensor, {1});
  planner.add_poses({"dome", scene.views});
  int cases = 0;
  const auto refuses = [&](const std::string& part, auto&& call) {
    const std::string before = test::seen_of(planner);
    const std::size_t candidates = planner.candidate_count(), gone = planner.dropped().size();
    expect_error(ErrorCode::invalid_argument, part, call);
    EXPECT_EQ(test::seen_of(planner), before);
    EXPECT_EQ(planner.candidate_count(), candidates);
    EXPECT_EQ(planner.dropped().size(), gone);
    ++cases;
  };
  const DepthFrame frame = scene.see(scene.views[0]);
  refuses("After each view, call propose()", [&] { (void)planner.rank(); });
  (void)planner.propose();  // before any view: all is unknown
  EXPECT_FALSE(planner.rank().views.empty());
  planner.add(frame, scene.views[0]);
  refuses("After each view, call propose()", [&] { (void)planner.rank(); });
  Pose nan = scene.views[0], bent = scene.views[0];
  nan.m[3] = kNan;
  bent.m[0] += 0.01;
  for (const Pose& bad : {nan, bent}) {
    refuses("rigid", [&] { planner.tried(bad, false); });
    refuses("pose 1 of the set \"mine\"", [&] { planner.add_poses({"mine", {{}, bad}}); });
  }
  refuses("state.ot: an OpenVDB file must have the ending .vdb", [&] { planner.save("state.ot"); });
  refuses("at least one frame",
          [&] { planner.add(std::span<const DepthFrame>(), scene.views[0]); });
  refuses("null", [&] { planner.add_generation(nullptr); });
  (void)planner.propose();
  const std::vector<double> few_costs(2);
  refuses("cost", [&] { (void)planner.rank(1, {.costs = few_costs}); });
  refuses("cost_per_metre", [&] { (void)planner.rank(1, {.cost_per_metre = kNan}); });
  refuses("cost_per_metre", [&] { (void)planner.rank(1, {.cost_per_metre = -1}); });
  EXPECT_EQ(cases, 12);

  // Frames that cannot be used change no map, and count as views.
  DepthFrame small = frame, few = frame, dark = frame, empty = frame;
  small.height -= 1;
  few.depth.pop_back();
  dark.amplitude.resize(5);
  std::fill(empty.depth.begin(), empty.depth.end(), DepthFrame::kInvalid);
  const Pose away = look_at({9, 9, 9}, {20, 9, 9});
  const std::string hash = planner.scorer().grid().content_hash();
  std::size_t view = 1;
  const auto expect_bad = [&](FrameVerdict verdict, const AddedView& added) {
    EXPECT_EQ(added.update.verdict, verdict) << frame_verdict_name(verdict);
    EXPECT_EQ(added.view, view++);
    EXPECT_EQ(added.entropy_removed, 0);
    EXPECT_EQ(planner.scorer().grid().content_hash(), hash);
    EXPECT_EQ(planner.candidate_count(), 0U);
  };
  expect_bad(FrameVerdict::wrong_size, planner.add(small, scene.views[1]));
  expect_bad(FrameVerdict::wrong_size, planner.add(few, scene.views[1]));
  expect_bad(FrameVerdict::wrong_size, planner.add(dark, scene.views[1]));
  EXPECT_EQ(planner.should_stop(), StopReason::idle);
  expect_bad(FrameVerdict::lost_pose, planner.add(frame, nan));
  expect_bad(FrameVerdict::lost_pose, planner.add(frame, bent));
  expect_bad(FrameVerdict::nothing_in_range, planner.add(empty, scene.views[2]));
  expect_bad(FrameVerdict::outside, planner.add(frame, away));
  expect_bad(FrameVerdict::unreadable, planner.drop(FrameVerdict::unreadable, scene.views[3]));
  const FrameCounts counts{{FrameVerdict::used, 1},
                           {FrameVerdict::lost_pose, 2},
                           {FrameVerdict::unreadable, 1},
                           {FrameVerdict::wrong_size, 3},
                           {FrameVerdict::nothing_in_range, 1},
                           {FrameVerdict::outside, 1}};
  EXPECT_EQ(planner.frames(), counts);
  for (const Candidate& candidate : planner.propose().candidates) {
    for (const std::size_t tried : {1U, 2U, 3U}) {
      EXPECT_FALSE(candidate.T_world_camera == scene.views[tried]);
    }
  }
  expect_error(ErrorCode::invalid_argument, "cannot have the verdict \"used\" or \"carved\"",
               [&] { planner.drop(FrameVerdict::carved); });
  ViewPlanner none = scene.config().make(scene.sensor, {1});
  none.add_poses({"dome", scene.views});
  none.add(frame, away);
  for (const auto& call : {std::function<void()>([&] { (void)none.propose(); }),
                           std::function<void()>([&] { (void)none.rank(scene.views, 1); })}) {
    expect_error(ErrorCode::invalid_argument, "1 outside", call);
  }

  // Bad poses are left out.
  const std::vector<Pose> mixed{nan, scene.views[7], bent};
  const Ranking ranking = planner.rank(mixed, 3, {.exact = true});
  ASSERT_EQ(ranking.views.size(), 1U);
  EXPECT_EQ(ranking.views[0].index, 1U);
  EXPECT_TRUE(planner.rank(std::vector<Pose>{}, 3).views.empty());
  EXPECT_TRUE(planner.rank(mixed, 0).views.empty());

  const auto refuses_config = [&](const std::string& part, auto&& change) {
    PlannerSetUp config = scene.config();
    change(config);
    expect_error(ErrorCode::invalid_argument, part,
                 [&] { const ViewPlanner never = config.make(scene.sensor); });
    ++cases;
  };
  refuses_config("max_views", [](PlannerSetUp& c) { c.planner.max_views = 0; });
  refuses_config("stop_area", [](PlannerSetUp& c) { c.planner.stop_area = 2.0; });
  refuses_config("trace", [](PlannerSetUp& c) { c.map.gain.criterion = Criterion::trace; });
  refuses_config("clearance", [](PlannerSetUp& c) { c.map.clearance = -1; });
  EXPECT_EQ(cases, 16);
}

TEST(ViewPlanner, WhyToEndDoesNotHangOnHowManyAreAskedFor) {
  const BinScene scene;
  PlannerSetUp config = scene.config();
  const auto reason_with = [&](std::size_t k, double stop_area) {
    config.planner.stop_area = stop_area;
    ViewPlanner planner = config.make(scene.sensor, {1});
    planner.add_poses({"dome", scene.views});
    for (const std::size_t i : {0U, 4U, 8U}) {
      planner.add(scene.see(scene.views[i], i), scene.views[i]);
      (void)planner.propose();
      // The way makes a near view the best, not the one that shows most.
      (void)planner.rank(k, {.cost_per_metre = 1e5, .exact = true});
    }
    return planner.should_stop();
  };
  std::set<bool> seen;
  for (double share = 0.02; share < 0.9; share *= 2.5) {
    EXPECT_EQ(reason_with(1, share), reason_with(scene.views.size(), share)) << share;
    seen.insert(reason_with(1, share) == StopReason::area);
  }
  EXPECT_EQ(seen.size(), 2U);
}

// Algorithm 1 over the planner's parts takes the views that its steps take, and ends for the same
// reason.
TEST(ViewPlanner, TheLoopOverItsPartsIsItsSteps) {
  const BinScene scene;
  class Camera : public DataAcquisition {
   public:
    explicit Camera(const BinScene& of) : scene_(of) {}
    Measurements acquire(const Pose& T_world_camera, std::size_t view) override {
      return {T_world_camera, {scene_.see(T_world_camera, view)}};
    }

   private:
    const BinScene& scene_;
  };
  std::set<StopReason> reasons;
  for (const GainModel model : {GainModel::paper, GainModel::surface, GainModel::combined}) {
    for (const double cost : {0.0, 3.0}) {
      PlannerSetUp config = scene.config(model);
      config.planner.max_views = 6;
      if (cost > 0 && model != GainModel::paper) config.planner.stop_area = 0.1;
      if (cost > 0) config.planner.ahead = {.plan = 2, .take = 2};
      const RankConfig rank{.cost_per_metre = cost};
      ViewPlanner looped = config.make(scene.sensor, {2}), stepped = config.make(scene.sensor, {1});
      for (ViewPlanner* planner : {&looped, &stepped}) planner->add_poses({"dome", scene.views});

      Camera camera(scene);
      PlannerParts parts(looped, rank);
      const PlanningResult result =
          active_view_planning(scene.views[3], camera, parts, parts, parts, looped.planning());
      Pose next = scene.views[3];
      for (std::size_t i = 0; i < result.views.size(); ++i) {
        const ViewRecord& record = result.views[i];
        ASSERT_TRUE(record.T_world_camera == next) << i;
        const AddedView added = stepped.add(scene.see(next, i), next);
        EXPECT_EQ(record.progress.entropy_removed, added.progress.entropy_removed);
        if (model != GainModel::paper) {
          EXPECT_EQ(record.progress.new_area, added.progress.new_area);
        }
        if (stepped.should_stop()) {
          EXPECT_EQ(i + 1, result.views.size());
          break;
        }
        const std::size_t count = stepped.propose().candidates.size();
        EXPECT_EQ(record.proposal.candidates.size(), count);
        const Ranking best = stepped.rank(1, rank);
        if (best.views.empty()) break;
        ASSERT_TRUE(record.decision);
        EXPECT_EQ(record.decision->candidate, best.views[0].index);
        if (cost == 0) {  // of a plan the decision has what the view promises by itself
          EXPECT_EQ(record.decision->gain, best.views[0].gain.gain);
        }
        next = best.views[0].T_world_camera;
      }
      EXPECT_EQ(stepped.should_stop(), result.reason);
      EXPECT_EQ(looped.should_stop(), result.reason);
      EXPECT_EQ(test::seen_of(looped), test::seen_of(stepped));
      reasons.insert(result.reason);
    }
  }
  EXPECT_GE(reasons.size(), 2U);
  ViewPlanner planner = scene.config().make(scene.sensor, {1});
  PlannerParts parts(planner);
  const std::vector<Candidate> others(3);
  expect_error(ErrorCode::invalid_argument, "differ from the last proposal of the planner",
               [&] { (void)parts.decide(Pose(), others); });
}

TEST(ViewPlanner, AStoppedRankingIsNoDecision) {
  const BinScene scene;
  PlannerSetUp config = scene.config(GainModel::paper);
  config.planner.stop_gain = 1e6;
  ViewPlanner planner = config.make(scene.sensor, {1});
  planner.add_poses({"dome", scene.views});
  planner.add(scene.see(scene.views[0]), scene.views[0]);
  (void)planner.propose();
  std::stop_source stopped;
  stopped.request_stop();
  BatchControl control;
  control.stop = stopped.get_token();
  EXPECT_FALSE(planner.rank(1, {}, control).complete);
  EXPECT_FALSE(planner.should_stop());
  EXPECT_TRUE(planner.rank().complete);
  EXPECT_EQ(planner.should_stop(), StopReason::gain);
}

}  // namespace
}  // namespace viewgain
