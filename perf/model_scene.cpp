// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "model_scene.hpp"

#include "program/cli/flags/sensing.hpp"

namespace viewgain::bench {
namespace {

SimulationConfig simulation(const char* noise, std::uint64_t seed, const Sensor& sensor) {
  app::SensingOptions options;
  options.seed = seed;
  return app::simulation_config(options, app::parse_noise(noise, true), sensor);
}

}  // namespace

ModelScene::ModelScene(const std::filesystem::path& mesh, std::uint64_t seed,
                       const ExecConfig& exec)
    : sensor_(sensor_preset("sr4000")),
      stage_(set_stage({.mesh = mesh, .size = 0.35}, exec)),
      camera_(stage_.scene, sensor_, simulation("on", seed, sensor_), exec),
      undisturbed_(stage_.scene, sensor_, simulation("off", seed, sensor_), exec),
      filter_(sensor_.camera, {}, exec) {}

DepthFrame ModelScene::acquire(const Pose& T_world_camera, std::uint64_t frame) const {
  DepthFrame result = camera_.acquire(T_world_camera, frame);
  filter_.apply(result);
  return result;
}

DepthFrame ModelScene::true_frame(const Pose& T_world_camera) const {
  return undisturbed_.acquire(T_world_camera);
}

BeliefGrid ModelScene::empty_grid(double voxel_size) const {
  GridConfig config;
  config.voxel_size = voxel_size;
  config.workspace = stage_.workspace;
  return BeliefGrid(config, sensor_);
}

}  // namespace viewgain::bench
