// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What known obstacles and a lens cost: views per second with them over views per second without.
#include <algorithm>
#include <array>

#include "bars.hpp"
#include "measure.hpp"
#include "mesh/shapes.hpp"
#include "support/camel_scene.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::bench {
namespace {

constexpr std::array kModels{GainModel::paper, GainModel::surface, GainModel::combined};

/// 10 x 10 boxes beside the workspace.
Obstacles wall() {
  Obstacles obstacles;
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      const double y = -0.4 + 0.08 * i, z = -0.4 + 0.08 * j;
      obstacles.boxes.push_back({{-0.24, y, z}, {-0.22, y + 0.075, z + 0.075}});
    }
  }
  return obstacles;
}

/// What the object stands on: the workspace's lowest centimetre is in it.
Obstacles table() { return {.boxes = {{{-0.6, -0.21, -0.6}, {0.6, -0.19, 0.6}}}, .meshes = {}}; }

/// A sphere round cameras and object, 10,200 triangles.
Obstacles surrounding_mesh() { return {.boxes = {}, .meshes = {test::sphere_mesh(1.5, 51)}}; }

struct Setting {
  std::shared_ptr<const VoxelScene> scene;
  Sensor sensor;
};

/// The least ratio of speeds of the three gains, which the note lists.
Figure speed_ratio(const char* name, const Setting& with, const Setting& without,
                   std::span<const Pose> poses, const BarsOptions& options) {
  Figure figure{name, 1e9};
  for (const GainModel model : kModels) {
    const GainConfig config{.model = model};
    const ExecConfig exec{.num_threads = options.num_threads};
    const GainEvaluator a(with.scene, with.sensor, config, exec);
    const GainEvaluator b(without.scene, without.sensor, config, exec);
    std::vector<double> ratios;
    std::vector<ViewGain> gains;
    for (int repetition = -1; repetition < options.repetitions; ++repetition) {
      const double of_a = seconds_of([&] { gains = a.evaluate(poses); });
      const double of_b = seconds_of([&] { (void)b.evaluate(poses); });
      if (repetition >= 0) ratios.push_back(of_b / of_a);  // -1: to warm up
    }
    const double ratio = median(ratios);
    figure.value = std::min(figure.value, ratio);
    figure.is_valid =
        figure.is_valid &&
        std::any_of(gains.begin(), gains.end(), [](const ViewGain& view) { return view.gain > 0; });
    if (!figure.note.empty()) figure.note += ", ";
    figure.note += std::string(gain_model_name(model))
                       .append(" ")
                       .append(short_text(std::round(100 * ratio) / 100));
  }
  return figure;
}

}  // namespace

std::vector<Figure> surroundings_figures(const BarsOptions& options) {
  const BeliefGrid grid = test::camel_grid(options.voxels, options.mesh);
  const auto free = VoxelScene::build(grid);
  const Sensor sr4000 = sensor_preset("sr4000"), kinect = sensor_preset("kinect_v1");
  Sensor with_lens = kinect;
  // Of the RGB camera of a Kinect as calibrated for recorded data (TUM RGB-D, freiburg1).
  with_lens.camera.distortion = {0.2624, -0.9531, -0.0054, 0.0026, 1.1633};
  const std::vector<Pose> near = sphere_poses(static_cast<std::size_t>(options.poses), 0.6);
  // Larger images: fewer of them.
  const std::vector<Pose> far =
      sphere_poses(static_cast<std::size_t>(std::max(1, options.poses / 8)), 1.0);
  return {speed_ratio("wall_over_free", {VoxelScene::build(grid, {wall()}), sr4000}, {free, sr4000},
                      near, options),
          speed_ratio("mesh_over_free", {VoxelScene::build(grid, {surrounding_mesh()}), sr4000},
                      {free, sr4000}, near, options),
          speed_ratio("table_over_free", {VoxelScene::build(grid, {table()}), kinect},
                      {free, kinect}, far, options),
          speed_ratio("lens_over_pinhole", {free, with_lens}, {free, kinect}, far, options)};
}

}  // namespace viewgain::bench
