// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "convert.hpp"
#include "viewgain/grid/vdb_io.hpp"

using namespace viewgain;
using namespace viewgain::c_api;

namespace {

static_assert(VG_INFEASIBLE_TOO_NEAR == static_cast<int>(Infeasibility::too_near));

HazardConfig hazard_of(const vg_scene_config& config, const BeliefGrid& grid) {
  HazardConfig hazard;
  hazard.object_size = given(config.object_size);
  require("hazard_rates", {sized(config.hazard_rates, config.hazard_count)});
  const auto rate = given(config.hazard_rate);
  const bool by_voxel = config.hazard_rates != nullptr, by_file = config.hazard_file != nullptr;
  if ((rate ? 1 : 0) + (by_voxel ? 1 : 0) + (by_file ? 1 : 0) > 1) {
    refuse("only one of hazard_rate, hazard_rates and hazard_file may be set");
  }
  if (by_file) {
    hazard.volume =
        std::make_shared<const HazardConfig::Volume>(load_hazard_vdb(config.hazard_file, grid));
  } else if (by_voxel) {
    HazardConfig::Volume volume{VoxelBox::from_dims(grid.min_index(), grid.dims()), {}};
    volume.rates.assign(config.hazard_rates, config.hazard_rates + config.hazard_count);
    hazard.volume = std::make_shared<const HazardConfig::Volume>(std::move(volume));
  } else if (rate) {
    hazard = constant_hazard(*rate, grid, hazard.object_size);
  }
  return hazard;
}

FeasibilityConfig settings_of(const vg_feasibility_config& config) {
  FeasibilityConfig settings;
  settings.body.size = std::to_array(config.body_size);
  if (config.has_flange != 0) settings.body.T_flange_camera = rigid_pose_of(config.T_flange_camera);
  settings.clearance = config.clearance;
  settings.taken_tolerance = {config.taken_distance, config.taken_angle};
  if (config.sensor != nullptr) {
    settings.sensor = sensor_of(config.sensor);
    settings.sensor->validate();
  }
  settings.max_near_share = config.max_near_share;
  settings.reach.predicate = predicate_of(config.reachable, config.user);
  return settings;
}

}  // namespace

template <>
vg_scene_config viewgain::c_api::defaults() noexcept {
  vg_scene_config config{};
  config.support_plane = config.object_size = config.hazard_rate = kNone;
  return config;
}

template <>
vg_feasibility_config viewgain::c_api::defaults() noexcept {
  const FeasibilityConfig own;
  vg_feasibility_config config{};
  std::copy(own.body.size.begin(), own.body.size.end(), config.body_size);
  write_pose(Pose{}, config.T_flange_camera);
  config.clearance = own.clearance;
  config.taken_distance = own.taken_tolerance.distance;
  config.taken_angle = own.taken_tolerance.angle;
  config.max_near_share = own.max_near_share;
  return config;
}

VG_DEFINE_INIT(vg_scene_config)

vg_status vg_scene_build(const vg_grid* grid, const vg_scene_config* config, vg_scene** scene) {
  return make_handle(scene, "scene grid", {grid}, [&] {
    const vg_scene_config chosen = read_config(config, "vg_scene_config");
    return VoxelScene::build(grid->grid, surroundings_of(chosen),
                             {.num_threads = chosen.num_threads}, hazard_of(chosen, grid->grid));
  });
}

vg_status vg_scene_update(const vg_scene* before, const vg_grid* grid, int32_t num_threads,
                          vg_scene** scene) {
  return make_handle(scene, "scene before grid", {before, grid}, [&] {
    return VoxelScene::update(before->scene, grid->grid, {.num_threads = num_threads});
  });
}

void vg_scene_release(vg_scene* scene) { delete scene; }

vg_status vg_calibrate_hazard(const vg_integrator* integrator, vg_grid* grid, const vg_scene* scene,
                              const float* depth, const double T_world_camera[16]) {
  return guarded("integrator grid scene depth T_world_camera",
                 {integrator, grid, scene, depth, T_world_camera}, [&] {
                   integrator->calibration.count(grid->grid, scene->scene->hazard_probe(),
                                                 frame_of(integrator->camera, depth, nullptr),
                                                 rigid_pose_of(T_world_camera));
                 });
}

VG_DEFINE_INIT(vg_feasibility_config)

vg_status vg_feasibility_create(const vg_scene* scene, const vg_feasibility_config* config,
                                vg_feasibility** feasibility) {
  return make_handle(feasibility, "feasibility scene", {scene}, [&] {
    const vg_feasibility_config chosen = read_config(config, "vg_feasibility_config");
    return FeasibilityChecker(scene->scene, settings_of(chosen),
                              {.num_threads = chosen.num_threads});
  });
}

vg_status vg_feasibility_check(const vg_feasibility* feasibility, const double* poses, size_t count,
                               const double* taken, size_t taken_count, int32_t* reasons) {
  return guarded("feasibility reasons taken",
                 {feasibility, sized(reasons, count), sized(taken, taken_count)}, [&] {
                   const std::vector<Pose> views = poses_of(taken, taken_count);
                   const std::vector<Infeasibility> answers =
                       feasibility->checker.check(poses_of(poses, count), views);
                   for (std::size_t i = 0; i < count; ++i)
                     reasons[i] = static_cast<std::int32_t>(answers[i]);
                 });
}

vg_status vg_feasibility_with_scene(const vg_feasibility* feasibility, const vg_scene* scene,
                                    vg_feasibility** following) {
  return make_handle(following, "following feasibility scene", {feasibility, scene},
                     [&] { return feasibility->checker.with_scene(scene->scene); });
}

void vg_feasibility_release(vg_feasibility* feasibility) { delete feasibility; }
