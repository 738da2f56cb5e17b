// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "convert.hpp"
#include "viewgain/grid/vdb_io.hpp"

using namespace viewgain;
using namespace viewgain::c_api;

template <>
vg_grid_config viewgain::c_api::defaults() noexcept {
  vg_grid_config config{};
  write_pose(Pose{}, config.T_world_grid);
  return config;
}

template <>
vg_integrator_config viewgain::c_api::defaults() noexcept {
  vg_integrator_config config{};
  config.support_plane = kNone;
  return config;
}

VG_DEFINE_INIT(vg_grid_config)

vg_status vg_grid_create(const vg_grid_config* config, vg_grid** grid) {
  return make_handle(grid, "grid", {}, [&] {
    const vg_grid_config chosen = read_struct(config, "vg_grid_config");
    return BeliefGrid({.voxel_size = chosen.voxel_size,
                       .workspace = {std::to_array(chosen.box_min), std::to_array(chosen.box_max)},
                       .T_world_grid = rigid_pose_of(chosen.T_world_grid),
                       .prior_sigma = chosen.prior_sigma});
  });
}

vg_status vg_grid_from_labels(const uint8_t* labels, const int32_t dims[3], const double origin[3],
                              double voxel_size, double prior_sigma, vg_grid** grid) {
  return make_handle(grid, "grid labels dims origin", {labels, dims, origin}, [&] {
    GridConfig config{.voxel_size = voxel_size,
                      .workspace = {},
                      .T_world_grid = {Eigen::Matrix3d::Identity(), vector_of(origin)},
                      .prior_sigma = prior_sigma};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(origin[axis])) refuse("the origin must be finite");
    }
    // The grid also checks its size, but needs the whole array first.
    constexpr std::int32_t kMaxEdge = 65'536;
    std::size_t count = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (dims[axis] < 1 || dims[axis] > kMaxEdge) {
        refuse("dims are " + std::to_string(dims[0]) + " x " + std::to_string(dims[1]) + " x " +
               std::to_string(dims[2]) + "; each must be in 1..65536");
      }
      count *= static_cast<std::size_t>(dims[axis]);
      config.workspace.max[axis] = dims[axis] * voxel_size;
    }
    return BeliefGrid::from_states(config, std::span(labels, count));
  });
}

vg_status vg_grid_load(const char* path, vg_grid** grid) {
  return make_handle(grid, "grid path", {path}, [&] { return load_vdb(path); });
}

vg_status vg_grid_save(const vg_grid* grid, const char* path) {
  return guarded("grid path", {grid, path}, [&] { save_vdb(grid->grid, path); });
}

vg_status vg_grid_clone(const vg_grid* grid, vg_grid** copy) {
  return make_handle(copy, "copy grid", {grid}, [&] { return grid->grid.clone(); });
}

void vg_grid_release(vg_grid* grid) { delete grid; }

VG_DEFINE_INIT(vg_grid_info)

vg_status vg_grid_get_info(const vg_grid* grid, vg_grid_info* info) {
  return guarded("grid", {grid}, [&] {
    require_struct(info, "vg_grid_info");
    const BeliefGrid& map = grid->grid;
    const BeliefGrid::Statistics statistics = map.statistics();
    const Index3 base = map.min_index(), dims = map.dims();
    vg_grid_info whole{.struct_size = 0,
                       .min_index = {base.x, base.y, base.z},
                       .dims = {dims.x, dims.y, dims.z},
                       .voxel_size = map.voxel_size(),
                       .prior_sigma = map.prior_sigma(),
                       .T_world_grid = {},
                       .unknown = statistics.unknown,
                       .free = statistics.free,
                       .occupied = statistics.occupied,
                       .views = map.views().size(),
                       .bytes = statistics.bytes,
                       .entropy_removed = statistics.entropy_removed,
                       .hazard_factors = {}};
    static_assert(std::size(decltype(whole.hazard_factors){}) == HazardCounters::kClasses);
    for (std::size_t k = 0; k < HazardCounters::kClasses; ++k) {
      whole.hazard_factors[k] = map.hazard_counters().factor(k);
    }
    write_pose(map.T_world_grid(), whole.T_world_grid);
    write_struct(info, whole);
  });
}

vg_status vg_grid_states(const vg_grid* grid, uint8_t* states, size_t count) {
  return guarded("grid states", {grid, states}, [&] {
    if (count != grid->grid.voxel_count()) {
      refuse("the array has room for " + std::to_string(count) + " states, but the grid has " +
             std::to_string(grid->grid.voxel_count()) + " voxels");
    }
    grid->grid.copy_states({states, count});
  });
}

vg_status vg_grid_index_of(const vg_grid* grid, const double* points, size_t count,
                           int32_t* voxels) {
  return guarded("grid points voxels", {grid, sized(points, count), sized(voxels, count)}, [&] {
    for (std::size_t i = 0; i < 3 * count; i += 3) {
      const std::optional<Index3> voxel = grid->grid.index_of(vector_of(points + i));
      const Index3 at = voxel.value_or(Index3{VG_NO_VOXEL, VG_NO_VOXEL, VG_NO_VOXEL});
      std::copy_n(std::array{at.x, at.y, at.z}.data(), 3, voxels + i);
    }
  });
}

vg_status vg_grid_center(const vg_grid* grid, const int32_t* voxels, size_t count,
                         double* centers) {
  return guarded("grid voxels centers", {grid, sized(voxels, count), sized(centers, count)}, [&] {
    for (std::size_t i = 0; i < 3 * count; i += 3) {
      const Eigen::Vector3d center = grid->grid.center({voxels[i], voxels[i + 1], voxels[i + 2]});
      std::copy_n(center.data(), 3, centers + i);
    }
  });
}

vg_status vg_grid_set(vg_grid* grid, const int32_t* voxels, const float* log_odds, size_t count) {
  return guarded("grid voxels log_odds", {grid, sized(voxels, count), sized(log_odds, count)}, [&] {
    std::vector<BeliefGrid::VoxelValue> changes(count);
    for (std::size_t i = 0; i < count; ++i) {
      const std::int32_t* at = voxels + 3 * i;
      changes[i] = {{at[0], at[1], at[2]}, log_odds[i], {}};
    }
    grid->grid.set(changes);
  });
}

vg_status vg_grid_forget(vg_grid* grid, const double min[3], const double max[3],
                         uint64_t* forgotten) {
  return guarded("grid min max", {grid, min, max}, [&] {
    const std::uint64_t count =
        grid->grid.forget({{min[0], min[1], min[2]}, {max[0], max[1], max[2]}});
    if (forgotten != nullptr) *forgotten = count;
  });
}

vg_status vg_grid_update_box(vg_grid* grid, const int32_t first[3], const int32_t dims[3],
                             const uint8_t* labels, uint64_t* changed) {
  return guarded("grid first dims labels", {grid, first, dims, labels}, [&] {
    const VoxelBox box =
        box_in(VoxelBox::from_dims(grid->grid.min_index(), grid->grid.dims()), first, dims);
    const std::uint64_t count = grid->grid.update_box(box, {labels, box.volume()});
    if (changed != nullptr) *changed = count;
  });
}

vg_status vg_grid_scale(const vg_grid* grid, const int32_t* voxels, size_t count, uint8_t* scales) {
  return guarded("grid voxels scales", {grid, sized(voxels, count), sized(scales, count)}, [&] {
    for (std::size_t i = 0; i < count; ++i) {
      const std::int32_t* at = voxels + 3 * i;
      scales[i] = static_cast<std::uint8_t>(grid->grid.scale({at[0], at[1], at[2]}));
    }
  });
}

vg_status vg_grid_resample(vg_grid* grid, const double min[3], const double max[3], int32_t scale,
                           uint64_t* changed) {
  return guarded("grid min max", {grid, min, max}, [&] {
    const std::uint64_t count =
        grid->grid.resample({{min[0], min[1], min[2]}, {max[0], max[1], max[2]}}, scale);
    if (changed != nullptr) *changed = count;
  });
}

vg_status vg_grid_occupied(const vg_grid* grid, int32_t* voxels, float* log_odds, size_t capacity,
                           size_t* found) {
  return guarded("grid voxels found", {grid, sized(voxels, capacity), found}, [&] {
    std::size_t count = 0;
    grid->grid.for_each_occupied([&](const BeliefGrid::VoxelValue& one) {
      const std::size_t i = count++;
      if (i >= capacity) return;
      std::copy_n(std::array{one.voxel.x, one.voxel.y, one.voxel.z}.data(), 3, voxels + 3 * i);
      if (log_odds != nullptr) log_odds[i] = one.log_odds;
    });
    *found = count;
  });
}

vg_status vg_grid_hash(const vg_grid* grid, char hash[17]) {
  return guarded("grid hash", {grid, hash}, [&] {
    const std::string digits = grid->grid.content_hash();
    std::copy_n(digits.c_str(), 17, hash);
  });
}

VG_DEFINE_INIT(vg_integrator_config)
VG_DEFINE_INIT(vg_integration_report)

vg_status vg_integrator_create(const vg_sensor* sensor, const vg_integrator_config* config,
                               vg_integrator** integrator) {
  return make_handle(integrator, "integrator", {}, [&] {
    const Sensor camera = sensor_of(sensor);
    const vg_integrator_config chosen = read_config(config, "vg_integrator_config");
    IntegrationConfig settings{
        enum_of<IntegrationConfig::Carve>(chosen.carve, VG_CARVE_LINES, "carve"),
        enum_of<IntegrationConfig::Occupancy>(chosen.occupancy, VG_OCCUPANCY_LITERAL, "occupancy"),
        given(chosen.support_plane)};
    set_scales(chosen, settings);
    const ExecConfig exec{.num_threads = chosen.num_threads};
    return vg_integrator{FrameIntegrator(camera, settings, exec),
                         HazardCalibration(camera, settings.support_plane, exec), camera.camera};
  });
}

vg_status vg_integrate(vg_integrator* integrator, vg_grid* grid, const float* depth,
                       const float* amplitude, const double T_world_camera[16],
                       const double pose_sigma[2], vg_integration_report* report) {
  return guarded("integrator grid depth T_world_camera", {integrator, grid, depth, T_world_camera},
                 [&] {
                   if (report != nullptr) require_struct(report, "vg_integration_report");
                   const DepthFrame frame = frame_of(integrator->camera, depth, amplitude);
                   const IntegrationReport counts = integrator->integrator.integrate(
                       grid->grid, frame, rigid_pose_of(T_world_camera), pose_sigma_of(pose_sigma));
                   if (report == nullptr) return;
                   write_struct(report, {.struct_size = 0,
                                         .readings = counts.readings,
                                         .plane_readings = counts.plane_readings,
                                         .out_of_range = counts.out_of_range,
                                         .invalid = counts.invalid,
                                         .readings_inside = counts.readings_inside,
                                         .voxels_hit = counts.voxels_hit,
                                         .voxels_crossed = counts.voxels_crossed});
                 });
}

void vg_integrator_release(vg_integrator* integrator) { delete integrator; }
