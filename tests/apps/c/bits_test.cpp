// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The same poses and the same map give the same bits from C and from C++.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <thread>

#include "core/temporary_folder.hpp"
#include "raycast/scene_makers.hpp"
#include "viewgain/grid/hazard_calibration.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/viewgain.h"

namespace viewgain {
namespace {

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }

std::vector<double> matrices_of(std::span<const Pose> poses) {
  std::vector<double> matrices;
  for (const Pose& pose : poses) {
    matrices.insert(matrices.end(), pose.m.begin(), pose.m.end());
    matrices.insert(matrices.end(), {0, 0, 0, 1});
  }
  return matrices;
}

vg_sensor sensor_of(const Sensor& sensor, const ConstantNoise& noise) {
  vg_sensor own;
  vg_sensor_init(&own, sizeof own);
  own.width = sensor.camera.width;
  own.height = sensor.camera.height;
  own.fx = sensor.camera.fx;
  own.fy = sensor.camera.fy;
  own.cx = sensor.camera.cx;
  own.cy = sensor.camera.cy;
  std::copy(sensor.camera.distortion.begin(), sensor.camera.distortion.end(), own.distortion);
  own.min_range = sensor.min_range;
  own.max_range = sensor.max_range;
  own.working_distance = sensor.working_distance;
  own.noise_model = VG_NOISE_CONSTANT;
  own.noise[0] = noise.sigma_axial;
  own.noise[1] = noise.sigma_lateral;
  own.pose_sigma[0] = sensor.pose_sigma.translation;
  own.pose_sigma[1] = sensor.pose_sigma.rotation;
  return own;
}

/// Releases the handles at the end of a case.
struct Handles {
  vg_grid* grid = nullptr;
  vg_scene* scene = nullptr;
  vg_evaluator* evaluator = nullptr;
  Handles() = default;
  Handles(const Handles&) = delete;
  Handles& operator=(const Handles&) = delete;
  ~Handles() {
    vg_grid_release(grid);
    vg_evaluator_release(evaluator);
    vg_scene_release(scene);
  }
};

TEST(CApi, GainsAreThoseOfCppToTheLastBit) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path() / "map.vdb";
  std::size_t views = 0, gained = 0;
  for (const test::MapFamily family :
       {test::MapFamily::salt_and_pepper_1, test::MapFamily::tiles_8, test::MapFamily::rotated}) {
    test::Random random(5);
    const test::RandomMap map = test::random_map(family, random);
    Sensor sensor = test::random_sensor(map.grid, random);
    const ConstantNoise noise{.sigma_axial = 0.4 * map.grid.voxel_size(),
                              .sigma_lateral = 0.2 * map.grid.voxel_size()};
    sensor.noise = noise;
    if (family == test::MapFamily::rotated) sensor.pose_sigma = {0.3 * map.grid.voxel_size(), 0.01};
    std::vector<Pose> poses = test::random_poses(map, 40, random);
    poses[3].m[1] = std::numeric_limits<double>::quiet_NaN();
    poses[11].m[0] += 5e-4;  // is mended
    const std::vector<double> matrices = matrices_of(poses);
    save_vdb(map.grid, path);

    for (const auto& [model, criterion] :
         {std::pair(GainModel::paper, Criterion::log_diagonal),
          std::pair(GainModel::paper, Criterion::log_determinant),
          std::pair(GainModel::paper, Criterion::trace),
          std::pair(GainModel::surface, Criterion::log_diagonal),
          std::pair(GainModel::combined, Criterion::log_diagonal)}) {
      const GainEvaluator evaluator(
          VoxelScene::build(map.grid), sensor,
          {.model = model, .criterion = criterion, .posterior_entropy = true});
      const std::vector<ViewGain> expected = evaluator.evaluate(poses);
      Handles own;
      const vg_sensor camera = sensor_of(sensor, noise);
      vg_evaluator_config config;
      vg_evaluator_config_init(&config, sizeof config);
      config.gain = static_cast<std::int32_t>(model);
      config.criterion = static_cast<std::int32_t>(criterion);
      config.posterior_entropy = 1;
      ASSERT_EQ(vg_grid_load(path.c_str(), &own.grid), VG_OK) << vg_last_error();
      ASSERT_EQ(vg_scene_build(own.grid, nullptr, &own.scene), VG_OK) << vg_last_error();
      ASSERT_EQ(vg_evaluator_create(own.scene, &camera, &config, &own.evaluator), VG_OK)
          << vg_last_error();
      std::vector<double> gains(poses.size());
      std::vector<vg_view_gain> whole(poses.size());
      ASSERT_EQ(vg_evaluate(own.evaluator, matrices.data(), poses.size(), gains.data(), nullptr),
                VG_OK);
      ASSERT_EQ(vg_evaluate_views(own.evaluator, matrices.data(), poses.size(), whole.data(),
                                  sizeof whole[0], nullptr),
                VG_OK);
      for (std::size_t i = 0; i < poses.size(); ++i, ++views) {
        const ViewGain& view = expected[i];
        double single = 0;
        ASSERT_EQ(vg_evaluate(own.evaluator, &matrices[16 * i], 1, &single, nullptr), VG_OK);
        EXPECT_EQ(bits(single), bits(view.gain));
        EXPECT_EQ(bits(gains[i]), bits(view.gain));
        EXPECT_EQ(bits(whole[i].gain), bits(view.gain));
        EXPECT_EQ(bits(whole[i].exploration), bits(view.exploration));
        EXPECT_EQ(bits(whole[i].refinement), bits(view.refinement));
        EXPECT_EQ(bits(whole[i].posterior_entropy), bits(view.posterior_entropy));
        EXPECT_EQ(bits(whole[i].area), bits(view.area));
        EXPECT_EQ(bits(whole[i].refinement_saturated), bits(view.refinement_saturated));
        EXPECT_EQ(whole[i].rays, view.rays);
        EXPECT_EQ(whole[i].hits, view.hits);
        EXPECT_EQ(whole[i].unknown_voxels, view.unknown_voxels);
        EXPECT_EQ(whole[i].occupied_voxels, view.occupied_voxels);
        EXPECT_EQ(whole[i].status, static_cast<std::int32_t>(view.status));
        if (view.gain > 0) ++gained;
      }

      std::vector<std::size_t> indices(4);
      std::size_t found = 0;
      ASSERT_EQ(vg_best(own.evaluator, matrices.data(), poses.size(), 4, indices.data(), nullptr,
                        &found, nullptr),
                VG_OK);
      EXPECT_EQ(indices, best_indices(expected, 4));
      const DepthFrame image = depth_image(evaluator, poses[0]);
      std::vector<float> depth(image.depth.size());
      ASSERT_EQ(vg_depth_image(own.evaluator, matrices.data(), depth.data(), nullptr, depth.size()),
                VG_OK);
      EXPECT_EQ(depth, image.depth);
    }
  }
  EXPECT_EQ(views, 3U * 5 * 40);
  EXPECT_GT(gained, 100U);
}

// The area that a view by the surface gain expects of a scene of `config`; NaN if that is refused.
double area_of(const vg_grid* grid, const vg_scene_config& config, const vg_sensor& camera,
               const Pose& pose) {
  Handles own;
  double area = std::numeric_limits<double>::quiet_NaN();
  if (vg_scene_build(grid, &config, &own.scene) != VG_OK) return area;
  vg_evaluator_config evaluator;
  vg_evaluator_config_init(&evaluator, sizeof evaluator);
  evaluator.gain = static_cast<std::int32_t>(GainModel::surface);
  EXPECT_EQ(vg_evaluator_create(own.scene, &camera, &evaluator, &own.evaluator), VG_OK);
  EXPECT_EQ(vg_evaluate(own.evaluator, matrices_of({&pose, 1}).data(), 1, &area, nullptr), VG_OK);
  return area;
}

TEST(CApi, HazardsFromElsewhereAndFromFramesAreThoseOfCpp) {
  const test::TemporaryFolder folder;
  test::Random random(7);
  const test::RandomMap map = test::random_map(test::MapFamily::tiles_8, random);
  Sensor sensor = test::random_sensor(map.grid, random);
  const ConstantNoise noise{.sigma_axial = 0.4 * map.grid.voxel_size(),
                            .sigma_lateral = 0.2 * map.grid.voxel_size()};
  sensor.noise = noise;
  const vg_sensor camera = sensor_of(sensor, noise);
  const Pose pose = test::random_poses(map, 1, random)[0];
  const std::string path = folder.path() / "map.vdb", prior = folder.path() / "prior.vdb";
  save_vdb(map.grid, path);
  Handles own;
  ASSERT_EQ(vg_grid_load(path.c_str(), &own.grid), VG_OK);

  HazardConfig::Volume volume{VoxelBox::from_dims(map.grid.min_index(), map.grid.dims()), {}, 0.5F};
  for (std::uint64_t i = 0; i < volume.box.volume(); ++i) {
    volume.rates.push_back(static_cast<float>(i % 7));
  }
  save_hazard_vdb(volume, map.grid, prior);
  HazardConfig hazard;
  hazard.volume = std::make_shared<const HazardConfig::Volume>(volume);
  const double expected = GainEvaluator(VoxelScene::build(map.grid, {}, {}, hazard), sensor,
                                        {.model = GainModel::surface})
                              .evaluate(pose)
                              .gain;
  ASSERT_GT(expected, 0);
  vg_scene_config config;
  vg_scene_config_init(&config, sizeof config);
  const double by_distance = area_of(own.grid, config, camera, pose);
  EXPECT_NE(by_distance, expected);
  config.hazard_rates = volume.rates.data();
  config.hazard_count = volume.rates.size();
  EXPECT_EQ(bits(area_of(own.grid, config, camera, pose)), bits(expected));
  config.hazard_count -= 1;
  EXPECT_TRUE(std::isnan(area_of(own.grid, config, camera, pose)));
  config.hazard_count += 1;
  config.hazard_file = prior.c_str();
  EXPECT_TRUE(std::isnan(area_of(own.grid, config, camera, pose))) << "two at once";
  EXPECT_NE(std::string(vg_last_error()).find("one of"), std::string::npos);
  config.hazard_rates = nullptr;
  config.hazard_count = 0;
  EXPECT_EQ(bits(area_of(own.grid, config, camera, pose)), bits(expected));
  config.hazard_rate = 1;
  EXPECT_TRUE(std::isnan(area_of(own.grid, config, camera, pose))) << "two at once";

  // A frame's say, as by HazardCalibration.
  vg_integrator* integrator = nullptr;
  ASSERT_EQ(vg_integrator_create(&camera, nullptr, &integrator), VG_OK);
  DepthFrame frame{sensor.camera.width, sensor.camera.height, {}};
  frame.depth.assign(static_cast<std::size_t>(frame.width * frame.height),
                     static_cast<float>(sensor.working_distance));
  BeliefGrid same = load_vdb(path);
  const auto scene = VoxelScene::build(same);
  HazardCalibration(sensor).count(same, scene->hazard_probe(), frame, pose);
  ASSERT_EQ(vg_scene_build(own.grid, nullptr, &own.scene), VG_OK);
  const std::vector<double> matrix = matrices_of({&pose, 1});
  ASSERT_EQ(vg_calibrate_hazard(integrator, own.grid, own.scene, frame.depth.data(), matrix.data()),
            VG_OK)
      << vg_last_error();
  vg_grid_info info;
  vg_grid_info_init(&info, sizeof info);
  ASSERT_EQ(vg_grid_get_info(own.grid, &info), VG_OK);
  std::size_t other_than_one = 0;
  for (std::size_t k = 0; k < HazardCounters::kClasses; ++k) {
    EXPECT_EQ(bits(info.hazard_factors[k]), bits(same.hazard_counters().factor(k)));
    other_than_one += info.hazard_factors[k] == 1 ? 0U : 1U;
  }
  EXPECT_GT(other_than_one, 0U);
  EXPECT_EQ(vg_calibrate_hazard(nullptr, own.grid, own.scene, frame.depth.data(), matrix.data()),
            VG_INVALID_ARGUMENT);
  EXPECT_EQ(vg_calibrate_hazard(integrator, own.grid, own.scene, nullptr, matrix.data()),
            VG_INVALID_ARGUMENT);
  vg_integrator_release(integrator);
}

TEST(CApi, MessagesAreTheThreadsOwn) {
  ASSERT_EQ(vg_grid_clone(nullptr, nullptr), VG_INVALID_ARGUMENT);
  const std::string own = vg_last_error();
  std::string before = "?", after;
  std::thread other([&] {
    before = vg_last_error();
    (void)vg_sensor_preset(nullptr, nullptr);
    after = vg_last_error();
  });
  other.join();
  EXPECT_EQ(own, "copy is null");
  EXPECT_EQ(before, "");
  EXPECT_EQ(after, "name is null");
  EXPECT_EQ(vg_last_error(), own);
}

TEST(CApi, ALongMessageIsCutOff) {
  vg_grid* grid = nullptr;
  const std::string path = "/nonexistent/" + std::string(3000, 'x');
  ASSERT_EQ(vg_grid_load(path.c_str(), &grid), VG_IO);
  EXPECT_EQ(std::string(vg_last_error()).size(), 1023U);
}

}  // namespace
}  // namespace viewgain
