// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

// The structs of version 0.1.0, the first header of ABI version 1. Written by hand and never
// changed.
namespace first {

struct vg_watch {
  std::size_t struct_size;
  std::int32_t (*poll)(std::size_t done, std::size_t total, void* user);
  void* user;
};

struct vg_sensor {
  std::size_t struct_size;
  std::int32_t width, height;
  double fx, fy, cx, cy;
  double distortion[5];
  double min_range, max_range;
  double working_distance;
  std::int32_t noise_model;
  double noise[6];
};

struct vg_grid_config {
  std::size_t struct_size;
  double voxel_size;
  double box_min[3], box_max[3];
  double T_world_grid[16];
  double prior_sigma;
};

struct vg_grid_info {
  std::size_t struct_size;
  std::int32_t min_index[3];
  std::int32_t dims[3];
  double voxel_size;
  double prior_sigma;
  double T_world_grid[16];
  std::uint64_t unknown, free, occupied;
  std::uint64_t views;
  std::uint64_t bytes;
  double entropy_removed;
};

struct vg_integrator_config {
  std::size_t struct_size;
  std::int32_t carve;
  std::int32_t occupancy;
  std::int32_t num_threads;
  double support_plane;
};

struct vg_integration_report {
  std::size_t struct_size;
  std::uint64_t readings, plane_readings, out_of_range, invalid, readings_inside;
  std::uint64_t voxels_hit, voxels_crossed;
};

struct vg_scene_config {
  std::size_t struct_size;
  std::int32_t num_threads;
  const double* boxes;
  std::size_t box_count;
  const double* vertices;
  std::size_t vertex_count;
  const std::uint32_t* triangles;
  std::size_t triangle_count;
};

struct vg_weight_region {
  double box_min[3], box_max[3];
  double weight;
};

struct vg_evaluator_config {
  std::size_t struct_size;
  std::int32_t criterion;
  std::int32_t pixel_stride;
  std::int32_t num_threads;
  double prior_sigma;
  double min_range, max_range;
  const vg_weight_region* weights;
  std::size_t weight_count;
};

struct vg_evaluator_info {
  std::size_t struct_size;
  std::int32_t image_width, image_height;
  std::uint64_t rays_per_pose;
  std::int32_t num_threads;
  double prior_sigma;
};

struct vg_view_gain {
  double gain;
  double exploration, refinement;
  double posterior_entropy;
  std::uint32_t rays, hits;
  std::uint32_t unknown_voxels, occupied_voxels;
  std::int32_t status;
};

struct vg_contribution {
  std::int32_t voxel[3];
  std::int32_t state;
  std::uint32_t rays;
  double gain;
};

struct vg_feasibility_config {
  std::size_t struct_size;
  double body_size[3];
  std::int32_t has_flange;
  double T_flange_camera[16];
  double clearance;
  double support_plane;
  double taken_distance;
  double taken_angle;
  const vg_sensor* sensor;
  double max_near_share;
  std::int32_t (*reachable)(const double T_world_camera[16], void* user);
  void* user;
};

}  // namespace first
