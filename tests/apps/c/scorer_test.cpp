// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// C's scorer says what C++'s says, and refuses wrong use.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/temporary_folder.hpp"
#include "raycast/scorer/scorer_scene.hpp"
#include "viewgain/viewgain.h"

namespace viewgain {
namespace {

using test::ScorerScene;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<double> numbers_of(const std::vector<Pose>& poses) {
  std::vector<double> numbers;
  for (const Pose& pose : poses) {
    numbers.insert(numbers.end(), pose.m.begin(), pose.m.end());
    numbers.insert(numbers.end(), {0, 0, 0, 1});
  }
  return numbers;
}

// The scene of C++, told to C.
struct CScorer {
  ScorerScene scene;
  vg_sensor sensor;
  vg_scorer_config config;
  std::vector<double> boxes;

  explicit CScorer(GainModel model = kDefaultGain) {
    vg_sensor_init(&sensor, sizeof sensor);
    EXPECT_EQ(vg_sensor_preset("sr4000", &sensor), VG_OK);
    const PinholeCamera& camera = scene.sensor.camera;
    sensor.width = camera.width, sensor.height = camera.height;
    sensor.fx = camera.fx, sensor.fy = camera.fy, sensor.cx = camera.cx, sensor.cy = camera.cy;
    const ScorerConfig own = scene.config(model);
    vg_scorer_config_init(&config, sizeof config);
    config.num_threads = 1;
    config.gain = static_cast<std::int32_t>(model);
    config.voxel_size = own.voxel_size;
    for (std::size_t a = 0; a < 3; ++a) {
      config.box_min[a] = own.workspace.min[a];
      config.box_max[a] = own.workspace.max[a];
    }
    config.support_plane = *own.support_plane;
    for (const Box& box : own.obstacles.boxes) {
      boxes.insert(boxes.end(), box.min.begin(), box.min.end());
      boxes.insert(boxes.end(), box.max.begin(), box.max.end());
    }
    config.boxes = boxes.data();
    config.box_count = own.obstacles.boxes.size();
  }
};

TEST(CScorer, SaysWhatTheOtherSays) {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "map.vdb").string();
  std::size_t frames = 0;
  for (const bool has_body : {false, true}) {
    for (const GainModel model : {GainModel::paper, GainModel::combined}) {
      CScorer c(model);
      Sensor sensor = c.scene.sensor;
      if (has_body) {
        sensor.body_size = {0.065, 0.065, 0.076};
        sensor.T_flange_camera = Pose(Eigen::Matrix3d::Identity(), {0, 0, 0.07});
        std::copy_n(sensor.body_size->begin(), 3, c.config.body_size);
        c.config.has_flange = 1;
        c.config.T_flange_camera[11] = 0.07;
      }
      ViewScorer own(sensor, c.scene.config(model), {1});
      vg_scorer* scorer = nullptr;
      ASSERT_EQ(vg_scorer_create(&c.sensor, &c.config, &scorer), VG_OK) << vg_last_error();
      std::vector<Pose> poses = c.scene.poses;
      poses.push_back(look_at({0.12, 0, 0.05}, {0, 0, 0.05}));  // in a wall
      const std::vector<double> numbers = numbers_of(poses);
      const std::size_t count = poses.size();
      for (std::size_t view = 0; view < 3; ++view) {
        const Pose& pose = poses[5 * view];
        const DepthFrame frame = c.scene.see(pose, view);
        const MapUpdate expected = own.add(frame, pose);
        vg_map_update update;
        vg_map_update_init(&update, sizeof update);
        ASSERT_EQ(vg_scorer_add(scorer, frame.depth.data(), frame.amplitude.data(),
                                &numbers[16 * 5 * view], nullptr, &update),
                  VG_OK)
            << vg_last_error();
        EXPECT_EQ(update.verdict, VG_FRAME_USED);
        EXPECT_EQ(update.readings, expected.counts.readings);
        EXPECT_EQ(update.voxels_hit, expected.counts.voxels_hit);
        EXPECT_EQ(update.flying_pixels, expected.flying_pixels);
        EXPECT_EQ(std::isnan(update.new_area), model == GainModel::paper);
        if (model != GainModel::paper) {
          EXPECT_EQ(update.new_area, expected.new_area);
        }
        ++frames;
      }
      const std::array<std::int32_t, 3> first{-2, -2, 1}, dims{3, 2, 2};
      const std::vector<std::uint8_t> labels{1, 2, 0, 1, 1, 2, 2, 0, 1, 1, 1, 2};
      std::uint64_t changed = 0, forgotten = 0;
      ASSERT_EQ(vg_scorer_set(scorer, first.data(), dims.data(), labels.data(), &changed), VG_OK);
      EXPECT_EQ(changed, own.set(VoxelBox::from_dims({-2, -2, 1}, {3, 2, 2}), labels));
      const std::array<double, 3> low{-0.02, -1, -1}, high{0.02, 1, 1};
      ASSERT_EQ(vg_scorer_forget(scorer, low.data(), high.data(), &forgotten), VG_OK);
      EXPECT_EQ(forgotten, own.forget({{-0.02, -1, -1}, {0.02, 1, 1}}));
      EXPECT_GT(forgotten, 0U);

      std::vector<double> gains(count);
      ASSERT_EQ(vg_scorer_evaluate(scorer, numbers.data(), count, gains.data(), nullptr), VG_OK);
      const std::vector<ViewGain> expected = own.evaluate(poses);
      for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(gains[i], expected[i].gain) << i;
      const std::vector<double> costs(count, 1.5);
      for (const double* some : {static_cast<const double*>(nullptr), costs.data()}) {
        std::array<std::size_t, 3> indices{};
        std::array<double, 3> best{};
        std::size_t found = 0;
        ASSERT_EQ(vg_scorer_best(scorer, numbers.data(), count, 3, some, kInfinity, indices.data(),
                                 best.data(), &found, nullptr),
                  VG_OK)
            << vg_last_error();
        BestConfig config;
        if (some != nullptr) config.costs = costs;
        const BestViews views = own.best(poses, 3, config);
        ASSERT_EQ(found, 3U);
        for (std::size_t i = 0; i < 3; ++i) {
          EXPECT_EQ(indices[i], views.indices[i]);
          EXPECT_EQ(best[i], views.gains[i].gain);
        }
      }
      // A deadline that has passed is no stop.
      vg_watch watch;
      vg_watch_init(&watch, sizeof watch);
      watch.poll = [](std::size_t, std::size_t, void*) { return 0; };
      std::size_t index = 7, found = 7;
      EXPECT_EQ(vg_scorer_best(scorer, numbers.data(), count, 1, nullptr, 0, &index, nullptr,
                               &found, &watch),
                VG_OK)
          << vg_last_error();
      EXPECT_LE(found, 1U);
      ASSERT_EQ(vg_scorer_best(scorer, &numbers[16 * (count - 1)], 1, 1, nullptr, kInfinity, &index,
                               nullptr, &found, nullptr),
                VG_OK);
      EXPECT_EQ(found, has_body ? 0U : 1U);

      // Scene and evaluator are those of the map, and last.
      vg_scene* scene = nullptr;
      vg_evaluator* evaluator = nullptr;
      vg_grid* grid = nullptr;
      ASSERT_EQ(vg_scorer_scene(scorer, &scene), VG_OK);
      ASSERT_EQ(vg_scorer_evaluator(scorer, &evaluator), VG_OK);
      ASSERT_EQ(vg_scorer_grid(scorer, &grid), VG_OK);
      char hash[17];
      ASSERT_EQ(vg_grid_hash(grid, hash), VG_OK);
      EXPECT_EQ(hash, own.grid().content_hash());
      vg_consistency agreed;
      vg_consistency_init(&agreed, sizeof agreed);
      std::array<std::int32_t, 3> contradicts{7, 7, 7};
      ASSERT_EQ(vg_scorer_consistency(scorer, &agreed, contradicts.data(), 3), VG_OK);
      const FrameConsistency all = own.consistency();
      EXPECT_EQ(agreed.frames, 3U);
      EXPECT_EQ(agreed.share_in_free, all.share_in_free);
      EXPECT_EQ(agreed.what, all.suspicion.what);
      EXPECT_EQ(contradicts, (std::array<std::int32_t, 3>{0, 0, 0}));
      EXPECT_EQ(vg_scorer_consistency(scorer, &agreed, contradicts.data(), 2), VG_INVALID_ARGUMENT);

      ASSERT_EQ(vg_scorer_save(scorer, path.c_str()), VG_OK) << vg_last_error();
      vg_scorer_release(scorer);
      ASSERT_EQ(vg_scorer_load(path.c_str(), &c.sensor, &c.config, &scorer), VG_OK);
      std::vector<double> again(count), lasting(count);
      ASSERT_EQ(vg_scorer_evaluate(scorer, numbers.data(), count, again.data(), nullptr), VG_OK);
      ASSERT_EQ(vg_evaluate(evaluator, numbers.data(), count, lasting.data(), nullptr), VG_OK);
      EXPECT_EQ(again, gains);
      EXPECT_EQ(lasting, gains);
      vg_scorer_release(scorer);
      vg_scene_release(scene);
      vg_evaluator_release(evaluator);
      vg_grid_release(grid);
    }
  }
  EXPECT_EQ(frames, 12U);
}

TEST(CScorer, WrongUseIsRefused) {
  CScorer c;
  vg_scorer* scorer = nullptr;
  const auto refused = [&](vg_status status, vg_status expected, const char* part) {
    EXPECT_EQ(status, expected) << part;
    EXPECT_NE(std::string(vg_last_error()).find(part), std::string::npos) << vg_last_error();
  };
  ASSERT_EQ(vg_scorer_create(&c.sensor, &c.config, &scorer), VG_OK);
  const std::vector<double> pose = numbers_of({c.scene.poses[0]});
  std::vector<float> depth = c.scene.see(c.scene.poses[0]).depth;
  const std::array<double, 2> negative{-1, 0};
  vg_map_update update{};
  refused(vg_scorer_add(scorer, nullptr, nullptr, pose.data(), nullptr, nullptr),
          VG_INVALID_ARGUMENT, "depth is null");
  refused(vg_scorer_add(scorer, depth.data(), nullptr, pose.data(), negative.data(), nullptr),
          VG_INVALID_ARGUMENT, "pose_sigma must be at least 0 and finite, not -1");
  refused(vg_scorer_add(scorer, depth.data(), nullptr, pose.data(), nullptr, &update),
          VG_INVALID_ARGUMENT, "vg_map_update");
  const std::array<std::int32_t, 3> far{1000, 0, 0}, dims{1, 1, 1};
  const std::uint8_t label = 1, wrong = 3;
  refused(vg_scorer_set(scorer, far.data(), dims.data(), &label, nullptr), VG_INVALID_ARGUMENT,
          "workspace");
  const std::array<std::int32_t, 3> near{0, 0, 1};
  refused(vg_scorer_set(scorer, near.data(), dims.data(), &wrong, nullptr), VG_INVALID_ARGUMENT,
          "3");
  std::array<double, 16> bent{};
  vg_map_update_init(&update, sizeof update);
  ASSERT_EQ(vg_scorer_add(scorer, depth.data(), nullptr, bent.data(), nullptr, &update), VG_OK);
  EXPECT_EQ(update.verdict, VG_FRAME_LOST_POSE);
  std::size_t index = 0, found = 9;
  refused(vg_scorer_best(scorer, pose.data(), 1, 1, nullptr, -1, &index, nullptr, &found, nullptr),
          VG_INVALID_ARGUMENT, "deadline");
  EXPECT_EQ(found, 0U);
  refused(vg_scorer_save(scorer, "/no/such/folder/map.vdb"), VG_IO, "map.vdb");
  vg_scorer_release(scorer);
  vg_scorer_release(nullptr);

  refused(vg_scorer_load("none.vdb", &c.sensor, &c.config, &scorer), VG_IO, "none.vdb");
  EXPECT_EQ(scorer, nullptr);
  refused(vg_scorer_create(nullptr, &c.config, &scorer), VG_INVALID_ARGUMENT, "sensor");
  vg_scorer_config config = c.config;
  config.gain = 9;
  refused(vg_scorer_create(&c.sensor, &config, &scorer), VG_INVALID_ARGUMENT, "gain is 9");
  config = c.config;
  config.struct_size += 8;
  refused(vg_scorer_create(&c.sensor, &config, &scorer), VG_INVALID_ARGUMENT, "struct_size");
  config = c.config;
  config.boxes = nullptr;
  refused(vg_scorer_create(&c.sensor, &config, &scorer), VG_INVALID_ARGUMENT, "boxes is null");
  config = c.config;
  config.body_size[0] = 0.1;  // the others are 0
  refused(vg_scorer_create(&c.sensor, &config, &scorer), VG_INVALID_ARGUMENT, "body");
}

}  // namespace
}  // namespace viewgain
