// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The C interface of the planner says what the C++ one says, and refuses wrong use.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "apps/planner/c_scene.hpp"
#include "core/temporary_folder.hpp"
#include "viewgain/planner.h"

namespace viewgain {
namespace {

using test::BinScene, test::CScene, test::numbers_of;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(CPlanner, SaysWhatTheOtherSays) {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "state.vdb").string();
  for (const GainModel model : {GainModel::paper, GainModel::combined}) {
    const CScene c(model);
    const BinScene& scene = c.scene;
    ViewPlanner own(scene.sensor, scene.config(model), {1});
    own.add_poses({"poses", scene.views});
    vg_planner* planner = nullptr;
    ASSERT_EQ(vg_planner_create(&c.sensor, &c.config, &planner), VG_OK) << vg_last_error();
    const std::vector<double> poses = numbers_of(scene.views);
    ASSERT_EQ(vg_planner_add_poses(planner, poses.data(), scene.views.size()), VG_OK);
    for (std::size_t view = 0; view < 3; ++view) {
      const Pose& pose = scene.views[5 * view];
      const DepthFrame frame = scene.see(pose, view);
      const Pose reported{pose.rotation(), pose.translation() + Eigen::Vector3d(0.003, 0, 0)};
      const FrameRegistration registered = own.register_frame(frame, reported, {0.005, 0.01});
      vg_registration found_pose;
      vg_registration_init(&found_pose, sizeof found_pose);
      ASSERT_EQ(vg_planner_register(planner, frame.depth.data(), frame.amplitude.data(),
                                    numbers_of({reported}).data(), 0.005, 0.01, &found_pose),
                VG_OK)
          << vg_last_error();
      EXPECT_EQ(found_pose.status, static_cast<int>(registered.status));
      EXPECT_EQ(found_pose.status == VG_TOO_LITTLE_OVERLAP, view == 0);
      EXPECT_EQ(std::vector<double>(found_pose.T_world_camera, found_pose.T_world_camera + 16),
                numbers_of({registered.T_world_camera}));
      EXPECT_TRUE(std::equal(registered.covariance.begin(), registered.covariance.end(),
                             found_pose.covariance));
      EXPECT_EQ(found_pose.overlap, registered.overlap);
      EXPECT_EQ(found_pose.residual_after, registered.residual_after);

      EXPECT_EQ(found_pose.pose_sigma[0], registered.pose_sigma().translation);
      EXPECT_EQ(found_pose.pose_sigma[1], registered.pose_sigma().rotation);

      const AddedView expected = own.add(frame, pose, registered.pose_sigma());
      vg_planner_view added;
      vg_planner_view_init(&added, sizeof added);
      ASSERT_EQ(vg_planner_add(planner, frame.depth.data(), frame.amplitude.data(),
                               numbers_of({pose}).data(), found_pose.pose_sigma, &added),
                VG_OK)
          << vg_last_error();
      EXPECT_EQ(added.view, view);
      EXPECT_EQ(added.readings_inside, expected.update.counts.readings_inside);
      EXPECT_EQ(added.entropy_removed, expected.entropy_removed);
      EXPECT_EQ(added.unknown_voxels, expected.progress.unknown_voxels);
      EXPECT_EQ(std::isnan(added.new_area), model == GainModel::paper);
      if (model != GainModel::paper) {
        EXPECT_EQ(added.new_area, expected.update.new_area);
      }
      vg_grid* grid = nullptr;
      ASSERT_EQ(vg_planner_grid(planner, &grid), VG_OK);
      char hash[17];
      ASSERT_EQ(vg_grid_hash(grid, hash), VG_OK);
      vg_grid_release(grid);
      EXPECT_EQ(hash, own.grid().content_hash());

      // A planner that is loaded holds frames against the map that it has, and counts anew.
      vg_consistency agreed;
      vg_consistency_init(&agreed, sizeof agreed);
      std::int32_t contradicts = 7;
      ASSERT_EQ(vg_planner_consistency(planner, &agreed, &contradicts, 1), VG_OK);
      EXPECT_EQ(agreed.frames, 1U);
      EXPECT_EQ(contradicts, 0);
      EXPECT_EQ(agreed.contradicting, 0U);
      EXPECT_EQ(vg_planner_consistency(planner, &agreed, &contradicts, 0), VG_INVALID_ARGUMENT);
      if (view == 0) {
        const FrameConsistency all = own.map().consistency();
        EXPECT_EQ(agreed.share_in_free, all.share_in_free);
        EXPECT_EQ(agreed.share_seen_past, all.share_seen_past);
        EXPECT_TRUE(std::isnan(agreed.displacement) && std::isnan(all.displacement));
        EXPECT_EQ(agreed.kind, all.suspicion.kind);
        EXPECT_EQ(agreed.what, all.suspicion.what);
      }

      vg_ray_outcomes rays;
      vg_ray_outcomes_init(&rays, sizeof rays);
      ASSERT_EQ(vg_planner_outcomes(planner, numbers_of({pose}).data(), &rays), VG_OK);
      const GainEvaluator::RayOutcomes outcomes = own.evaluator().outcomes(pose);
      EXPECT_EQ(rays.unknown, outcomes.unknown);
      EXPECT_EQ(rays.out_of_map, outcomes.out_of_map);
      EXPECT_EQ(rays.rays, rays.too_near + rays.unknown + rays.known_surface + rays.obstacle +
                               rays.out_of_range + rays.out_of_map);

      size_t candidates = 0;
      std::array<size_t, 12> dropped{};
      ASSERT_EQ(vg_planner_propose(planner, &candidates, dropped.data(), dropped.size()), VG_OK);
      const Proposal& proposal = own.propose();
      EXPECT_EQ(candidates, proposal.candidates.size());
      EXPECT_EQ(dropped[VG_INFEASIBLE_TAKEN], proposal.dropped.at("taken"));
      size_t sum = 0, expected_sum = 0;
      for (const size_t n : dropped) sum += n;
      for (const auto& [reason, n] : proposal.dropped) expected_sum += n;
      EXPECT_EQ(sum, expected_sum);

      std::array<vg_ranked_view, 3> best{};
      size_t found = 0;
      ASSERT_EQ(vg_planner_rank(planner, 3, nullptr, 0, 2.0, nullptr, best.data(), sizeof best[0],
                                &found, nullptr),
                VG_OK)
          << vg_last_error();
      const Ranking ranking = own.rank(3, {.cost_per_metre = 2.0});
      ASSERT_EQ(found, ranking.views.size());
      for (std::size_t i = 0; i < found; ++i) {
        EXPECT_EQ(best[i].index, ranking.views[i].index);
        EXPECT_EQ(best[i].gain, ranking.views[i].gain.gain);
        EXPECT_EQ(best[i].worth, ranking.views[i].worth);
        EXPECT_EQ(best[i].T_world_camera[3], ranking.views[i].T_world_camera.m[3]);
        EXPECT_EQ(best[i].T_world_camera[15], 1);
      }
      // From elsewhere.
      const Pose home = look_at({0.3, -0.2, 0.9}, {0, 0, 0});
      ASSERT_EQ(vg_planner_rank(planner, 3, nullptr, 0, 500.0, numbers_of({home}).data(),
                                best.data(), sizeof best[0], &found, nullptr),
                VG_OK)
          << vg_last_error();
      const Ranking from_home = own.rank(3, {.cost_per_metre = 500.0, .current_pose = home});
      ASSERT_EQ(found, from_home.views.size());
      for (std::size_t i = 0; i < found; ++i) {
        EXPECT_EQ(best[i].index, from_home.views[i].index);
        EXPECT_EQ(best[i].worth, from_home.views[i].worth);
        const double way =
            (from_home.views[i].T_world_camera.translation() - home.translation()).norm();
        EXPECT_NEAR(best[i].worth, best[i].gain - 500 * way, 1e-9);
      }
      ASSERT_EQ(vg_planner_rank(planner, 3, nullptr, 0, 2.0, nullptr, best.data(), sizeof best[0],
                                &found, nullptr),
                VG_OK);
      ASSERT_EQ(vg_planner_tried(planner, best[0].T_world_camera, 0), VG_OK);
      own.tried(ranking.views[0].T_world_camera, false);
      ASSERT_EQ(vg_planner_propose(planner, &candidates, dropped.data(), dropped.size()), VG_OK);
      EXPECT_EQ(dropped[VG_INFEASIBLE_MISSED], view + 1);
      // Through a file and on.
      ASSERT_EQ(vg_planner_save(planner, path.c_str()), VG_OK) << vg_last_error();
      vg_planner_release(planner);
      ASSERT_EQ(vg_planner_load(path.c_str(), &c.sensor, &c.config, &planner), VG_OK);
      ASSERT_EQ(vg_planner_add_poses(planner, poses.data(), scene.views.size()), VG_OK);
      ASSERT_EQ(vg_planner_rank_poses(planner, poses.data(), scene.views.size(), 1, nullptr, 0, 0,
                                      nullptr, best.data(), sizeof best[0], &found, nullptr),
                VG_OK);
      EXPECT_EQ(best[0].index, own.rank(scene.views, 1).views.front().index);
    }
    // A frame that is left out says where the camera is, too.
    const Pose& left_out = scene.views[8];
    ASSERT_EQ(vg_planner_drop(planner, VG_FRAME_UNREADABLE, numbers_of({left_out}).data()), VG_OK);
    own.drop(FrameVerdict::unreadable, left_out);
    vg_ranked_view best{};
    size_t found = 0;
    ASSERT_EQ(vg_planner_rank_poses(planner, poses.data(), scene.views.size(), 1, nullptr, 0, 500,
                                    nullptr, &best, sizeof best, &found, nullptr),
              VG_OK);
    ASSERT_EQ(found, 1U);
    const RankedView expected = own.rank(scene.views, 1, {.cost_per_metre = 500}).views.front();
    EXPECT_EQ(best.index, expected.index);
    EXPECT_EQ(best.worth, expected.worth);
    EXPECT_NEAR(
        best.worth,
        best.gain - 500 * (scene.views[best.index].translation() - left_out.translation()).norm(),
        1e-9);
    int32_t reason = -1;
    ASSERT_EQ(vg_planner_should_stop(planner, &reason), VG_OK);
    EXPECT_EQ(reason, VG_GO_ON);
    vg_planner_release(planner);
  }
}

TEST(CPlanner, RefusesWrongUse) {
  const CScene c;
  const std::vector<double> pose = numbers_of({c.scene.views[0]});
  const DepthFrame frame = c.scene.see(c.scene.views[0]);
  vg_planner* planner = nullptr;
  ASSERT_EQ(vg_planner_create(&c.sensor, &c.config, &planner), VG_OK) << vg_last_error();
  vg_ranked_view best;
  size_t found = 7;
  const auto refused = [&](vg_status status, const std::string& part) {
    EXPECT_EQ(status, VG_INVALID_ARGUMENT) << part;
    EXPECT_NE(std::string(vg_last_error()).find(part), std::string::npos) << vg_last_error();
  };
  refused(vg_planner_rank(planner, 1, nullptr, 0, 0, nullptr, &best, sizeof best, &found, nullptr),
          "propose");
  EXPECT_EQ(found, 0U);
  refused(vg_planner_rank(planner, 1, nullptr, 0, 0, nullptr, &best, 8, &found, nullptr),
          "view_size");
  refused(
      vg_planner_rank(planner, 1, nullptr, 0, 0, nullptr, nullptr, sizeof best, &found, nullptr),
      "views is null");
  std::vector<double> twice = pose;
  for (std::size_t k = 0; k < 12; ++k) twice[k] *= 2;
  refused(vg_planner_rank_poses(planner, pose.data(), 1, 1, nullptr, 0, 1, twice.data(), &best,
                                sizeof best, &found, nullptr),
          "current_pose");
  refused(vg_planner_add(planner, nullptr, nullptr, pose.data(), nullptr, nullptr), "depth");
  std::vector<double> bad = pose;
  bad[3] = kNan;
  vg_planner_view lost;
  vg_planner_view_init(&lost, sizeof lost);
  EXPECT_EQ(vg_planner_add(planner, frame.depth.data(), nullptr, bad.data(), nullptr, &lost),
            VG_OK);
  EXPECT_EQ(lost.verdict, VG_FRAME_LOST_POSE);
  EXPECT_EQ(vg_planner_drop(planner, VG_FRAME_UNREADABLE, pose.data()), VG_OK);
  refused(vg_planner_drop(planner, VG_FRAME_CARVED, nullptr), "verdict is 1");
  std::array<size_t, VG_FRAME_VERDICTS> counts{}, expected{};
  expected[VG_FRAME_LOST_POSE] = expected[VG_FRAME_UNREADABLE] = 1;
  EXPECT_EQ(vg_planner_frames(planner, counts.data(), counts.size()), VG_OK);
  EXPECT_EQ(counts, expected);
  size_t none = 0;
  refused(vg_planner_propose(planner, &none, nullptr, 0), "1 lost_pose, 1 unreadable");
  bad = pose;
  bad[15] = 2;
  refused(vg_planner_tried(planner, bad.data(), 1), "lowest row");
  vg_planner_view unset{};
  refused(vg_planner_add(planner, frame.depth.data(), nullptr, pose.data(), nullptr, &unset),
          "struct_size");
  refused(
      vg_planner_register(planner, frame.depth.data(), nullptr, pose.data(), 0.01, 0.01, nullptr),
      "found is null");
  refused(vg_planner_propose(planner, nullptr, nullptr, 0), "candidates");
  refused(vg_planner_save(planner, nullptr), "path");
  EXPECT_EQ(vg_planner_save(planner, "/no/such/folder/state.vdb"), VG_IO);
  vg_planner* other = planner;
  EXPECT_EQ(vg_planner_load("none.vdb", &c.sensor, &c.config, &other), VG_IO);
  EXPECT_EQ(other, nullptr);
  refused(vg_planner_create(&c.sensor, nullptr, &other), "null");
  vg_planner_config config = c.config;
  config.gain = 9;
  refused(vg_planner_create(&c.sensor, &config, &other), "gain is 9");
  config = c.config;
  config.plan = 3;
  config.take = 4;
  refused(vg_planner_create(&c.sensor, &config, &other), "take is 4; it must be 1 to plan, 3");
  config = c.config;
  config.struct_size += 8;
  refused(vg_planner_create(&c.sensor, &config, &other), "struct_size");

  vg_planner_release(planner);
  vg_planner_release(nullptr);
  int32_t reason = 0;
  refused(vg_planner_should_stop(nullptr, &reason), "null");
}

int32_t stop_at_once(size_t, size_t, void*) { return 1; }
int32_t high_enough(const double T_world_camera[16], void* user) {
  return T_world_camera[11] > *static_cast<const double*>(user) ? 1 : 0;
}

TEST(CPlanner, AsksItsCallbacks) {
  CScene c(GainModel::paper);
  EXPECT_EQ(c.config.broken_promises, 3U);
  double height = 5;
  c.config.reachable = high_enough;
  c.config.user = &height;
  vg_planner* planner = nullptr;
  ASSERT_EQ(vg_planner_create(&c.sensor, &c.config, &planner), VG_OK) << vg_last_error();
  const std::vector<double> poses = numbers_of(c.scene.views);
  ASSERT_EQ(vg_planner_add_poses(planner, poses.data(), c.scene.views.size()), VG_OK);
  size_t candidates = 1;
  std::array<size_t, 9> dropped{};
  ASSERT_EQ(vg_planner_propose(planner, &candidates, dropped.data(), dropped.size()), VG_OK);
  EXPECT_EQ(candidates, 0U);
  EXPECT_EQ(dropped[VG_INFEASIBLE_UNREACHABLE], c.scene.views.size());
  int32_t reason = 0;
  ASSERT_EQ(vg_planner_should_stop(planner, &reason), VG_OK);
  EXPECT_EQ(reason, VG_STOP_UNREACHABLE);
  vg_watch watch;
  vg_watch_init(&watch, sizeof watch);
  watch.poll = stop_at_once;
  vg_ranked_view best;
  size_t found = 0;
  EXPECT_EQ(vg_planner_rank_poses(planner, poses.data(), c.scene.views.size(), 1, nullptr, 0, 0,
                                  nullptr, &best, sizeof best, &found, &watch),
            VG_STOPPED);
  vg_planner_release(planner);
}

}  // namespace
}  // namespace viewgain
