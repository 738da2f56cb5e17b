// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Ways begin where the camera is: at a given pose, else at the last one that the planner was told.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "apps/planner/bin_scene.hpp"
#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "viewgain/planner/view_planner.hpp"

namespace viewgain {
namespace {

using test::BinScene;
using test::expect_error;
using test::PlannerSetUp;

constexpr double kPerMetre = 700;  // ways of some decimetres change the order
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Pose home() { return look_at({0.3, -0.2, 0.9}, {0, 0, 0}); }

// Records where the camera is said to be.
class Asked : public ViewpointGeneration {
 public:
  Proposal generate(const Pose& T_world_camera) override {
    poses.push_back(T_world_camera);
    return {};
  }
  std::vector<Pose> poses;
};

class CurrentPose : public testing::TestWithParam<GainModel> {
 protected:
  [[nodiscard]] PlannerSetUp config() const {
    PlannerSetUp config = scene.config(GetParam());
    config.planner.idle_views = 0;
    config.planner.stop_area = 0;
    config.planner.stop_gain = 0;
    return config;
  }
  [[nodiscard]] ViewPlanner planner(PlanAhead ahead = {}) const {
    PlannerSetUp config = this->config();
    config.planner.ahead = ahead;
    ViewPlanner made = config.make(scene.sensor, {1});
    made.add_poses({"dome", scene.views});
    return made;
  }
  [[nodiscard]] DepthFrame nothing() const {
    DepthFrame frame = scene.see(scene.views[0]);
    std::fill(frame.depth.begin(), frame.depth.end(), DepthFrame::kInvalid);
    return frame;
  }

  // Each candidate's worth by brute force, with all ways from one place.
  void expect_ways_from(ViewPlanner& planner, const Pose& from, const RankConfig& config,
                        const std::string& when) const {
    std::vector<Pose> poses;
    for (const bool of_proposal : {true, false}) {
      poses = of_proposal ? poses_of(planner.propose().candidates) : scene.views;
      const std::vector<ViewGain> gains = planner.scorer().evaluator()->evaluate(poses);
      std::vector<double> worth(poses.size());
      for (std::size_t i = 0; i < poses.size(); ++i) {
        double square = 0;
        for (const std::size_t k : {3U, 7U, 11U}) {
          square += (poses[i].m[k] - from.m[k]) * (poses[i].m[k] - from.m[k]);
        }
        worth[i] = gains[i].gain - config.cost_per_metre * std::sqrt(square);
      }
      const Ranking ranking = of_proposal ? planner.rank(poses.size(), config)
                                          : planner.rank(poses, poses.size(), config);
      ASSERT_GT(ranking.views.size(), 10U) << when;
      double before = std::numeric_limits<double>::infinity();
      for (const RankedView& view : ranking.views) {
        EXPECT_NEAR(view.worth, worth[view.index], 1e-9 * std::fabs(gains[view.index].gain) + 1e-9)
            << when;
        EXPECT_LE(view.worth, before) << when;
        before = view.worth;
      }
      EXPECT_NEAR(ranking.views.front().worth, *std::max_element(worth.begin(), worth.end()), 1e-9)
          << when;
    }
  }

  BinScene scene;
};

TEST_P(CurrentPose, IsTheLastOneToldUnlessItIsGiven) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "planner.vdb";
  ViewPlanner planner = this->planner();
  const RankConfig usual{.cost_per_metre = kPerMetre, .exact = true};
  RankConfig moved = usual;
  moved.current_pose = home();
  const auto expect_at = [&](const Pose& pose, const std::string& when) {
    expect_ways_from(planner, pose, usual, when);
    expect_ways_from(planner, home(), moved, when + ", then moved home");
    expect_ways_from(planner, pose, usual, when + ", and nothing has stayed of that");
    planner.save(path);
    planner = config().load(path, scene.sensor, {2});
    planner.add_poses({"dome", scene.views});
    expect_ways_from(planner, pose, usual, when + ", loaded");
    const auto asked = std::make_shared<Asked>();
    planner.add_generation(asked);
    (void)planner.propose();
    EXPECT_EQ(asked->poses, std::vector<Pose>{pose}) << when;
    planner = config().load(path, scene.sensor, {1});
    planner.add_poses({"dome", scene.views});
  };
  const auto& views = scene.views;
  planner.add(scene.see(views[0]), views[0]);
  expect_at(views[0], "a frame");
  EXPECT_EQ(planner.add(nothing(), views[7]).update.verdict, FrameVerdict::nothing_in_range);
  expect_at(views[7], "a frame without a reading");
  planner.drop(FrameVerdict::unreadable, views[9]);
  expect_at(views[9], "a frame that is left out");
  planner.drop(FrameVerdict::no_pose);
  Pose lost = views[3];
  lost.m[3] = kNan;
  planner.add(scene.see(views[3]), lost);
  planner.drop(FrameVerdict::lost_pose, lost);
  expect_at(views[9], "poses that are lost");
  planner.tried(views[11], false);
  expect_at(views[9], "a pose that was not reached");
  planner.tried(views[11], true);
  expect_at(views[11], "a pose that was reached");
  planner.add(scene.see(views[2]), views[2]);
  expect_at(views[2], "a frame again");
}

// The order of a plan is the shortest from there, of all orders.
TEST_P(CurrentPose, IsWhereAPlanBegins) {
  ViewPlanner planner = this->planner({.plan = 4, .take = 4, .least_share = 0});
  const Pose& first = scene.views[3];
  planner.add(scene.see(first), first);
  (void)planner.propose();
  const auto ways_of = [&](const std::optional<Pose>& given, const Pose& from) {
    const Ranking plan = planner.rank(4, {.current_pose = given, .exact = true});
    std::vector<std::size_t> order(plan.views.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::vector<double> ways;  // the first is the plan's
    do {
      double way = 0;
      Eigen::Vector3d at = from.translation();
      for (const std::size_t i : order) {
        const Eigen::Vector3d next = plan.views[i].T_world_camera.translation();
        way += (next - at).norm();
        at = next;
      }
      ways.push_back(way);
    } while (std::next_permutation(order.begin(), order.end()));
    EXPECT_NEAR(plan.way, ways[0], 1e-9);
    return ways;
  };
  for (const auto& [given, from] : {std::pair{std::optional<Pose>(home()), home()},
                                    {std::optional<Pose>(look_at({-0.4, 0, 0.3}, {0, 0, 0})),
                                     look_at({-0.4, 0, 0.3}, {0, 0, 0})},
                                    {std::optional<Pose>(), first}}) {
    const std::vector<double> ways = ways_of(given, from);
    ASSERT_EQ(ways.size(), 24U);
    EXPECT_NEAR(ways[0], *std::min_element(ways.begin(), ways.end()), 1e-9);
  }
  planner.drop(FrameVerdict::unreadable, scene.views[12]);
  (void)planner.propose();
  if (planner.candidate_count() > 10) {  // planned anew
    const std::vector<double> ways = ways_of({}, scene.views[12]);
    EXPECT_NEAR(ways[0], *std::min_element(ways.begin(), ways.end()), 1e-9);
  }
}

TEST_P(CurrentPose, SaysWhetherAnyViewIsWorthItsWay) {
  ViewPlanner planner = this->planner();
  planner.add(scene.see(scene.views[0]), scene.views[0]);
  (void)planner.propose();
  const Pose far(Eigen::Matrix3d::Identity(), Eigen::Vector3d(1e6, 0, 0));
  (void)planner.rank(1, {.cost_per_metre = 1, .current_pose = far});
  EXPECT_EQ(planner.should_stop(), StopReason::cost);
  (void)planner.rank(1, {.cost_per_metre = 1, .current_pose = home()});
  EXPECT_EQ(planner.should_stop(), std::nullopt);
  const Pose farther(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0, 1e200, 0));
  (void)planner.rank(1, {.cost_per_metre = 1, .current_pose = farther});
  EXPECT_EQ(planner.should_stop(), StopReason::cost);
  planner.drop(FrameVerdict::unreadable, far);
  (void)planner.propose();
  (void)planner.rank(1, {.cost_per_metre = 1});
  EXPECT_EQ(planner.should_stop(), StopReason::cost);
}

TEST_P(CurrentPose, RefusesWhatIsNoPose) {
  ViewPlanner planner = this->planner(), ahead = this->planner({.plan = 3, .take = 3});
  for (ViewPlanner* one : {&planner, &ahead}) {
    one->add(scene.see(scene.views[0]), scene.views[0]);
    (void)one->propose();
    const std::string before = test::seen_of(*one);
    Pose lost = home(), large = home(), mirrored = home();
    lost.m[3] = kNan;
    for (const std::size_t k : {0U, 4U, 8U}) large.m[k] *= 2, mirrored.m[k] *= -1;
    for (const Pose& bad : {lost, large, mirrored}) {
      for (const double per_metre : {0.0, 1.0}) {
        const RankConfig config{.cost_per_metre = per_metre, .current_pose = bad};
        expect_error(ErrorCode::invalid_argument, "current_pose",
                     [&] { (void)one->rank(1, config); });
        expect_error(ErrorCode::invalid_argument, "current_pose",
                     [&] { (void)one->rank(scene.views, 1, config); });
      }
    }
    EXPECT_EQ(test::seen_of(*one), before);
  }
  // Before any frame nobody knows where the camera is, unless it is said.
  ViewPlanner fresh = this->planner();
  const RankConfig usual{.cost_per_metre = kPerMetre, .exact = true};
  for (const RankedView& view : fresh.rank(scene.views, 40, usual).views) {
    EXPECT_EQ(view.worth, view.gain.gain);
  }
  RankConfig moved = usual;
  moved.current_pose = home();
  for (const RankedView& view : fresh.rank(scene.views, 40, moved).views) {
    EXPECT_LT(view.worth, view.gain.gain);
  }
}

// A state that does not say where the camera is, as version 2 has it: at the map's last view.
TEST_P(CurrentPose, OfAnOlderStateIsTheMapsLastView) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "planner.vdb";
  ViewPlanner planner = this->planner();
  planner.add(scene.see(scene.views[4]), scene.views[4]);
  planner.drop(FrameVerdict::unreadable, scene.views[9]);
  planner.save(path);
  MapNotes notes = load_vdb(path).notes();
  std::string& note = notes.others.at("planner");
  ASSERT_TRUE(note.starts_with("version 4\n"));
  note.replace(0, 9, "version 2");
  const std::size_t line = note.find("last_pose ");
  ASSERT_NE(line, std::string::npos);
  note.erase(line, note.find('\n', line) + 1 - line);
  save_vdb(planner.scorer().grid(), path, {.notes = notes});
  ViewPlanner old = config().load(path, scene.sensor, {1});
  old.add_poses({"dome", scene.views});
  expect_ways_from(old, scene.views[4], {.cost_per_metre = kPerMetre, .exact = true}, "old");
}

INSTANTIATE_TEST_SUITE_P(ByGain, CurrentPose,
                         testing::Values(GainModel::paper, GainModel::combined),
                         [](const auto& by) {
                           return by.param == GainModel::paper ? "paper" : "combined";
                         });

}  // namespace
}  // namespace viewgain
