// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "convert.hpp"

#include <algorithm>
#include <sstream>

#include "viewgain/core/generators.hpp"
#include "viewgain/core/tour.hpp"

namespace viewgain::c_api {
namespace {

// Largest deviation of a rotation from orthonormal.
constexpr double kMaxError = 1e-3;

bool has_lowest_row(const double* matrix) {
  constexpr double row[] = {0, 0, 0, 1};
  return std::equal(row, row + 4, matrix + 12,
                    [](double a, double b) { return std::abs(a - b) <= kMaxError; });
}

}  // namespace

Pose pose_of(const double* matrix) {
  Pose pose;
  if (has_lowest_row(matrix)) {
    std::copy_n(matrix, 12, pose.m.begin());
  } else {
    pose.m.fill(std::numeric_limits<double>::quiet_NaN());
  }
  return pose;
}

PoseSigma pose_sigma_of(const double* sigmas) {
  return sigmas == nullptr ? PoseSigma{} : PoseSigma{sigmas[0], sigmas[1]};
}

Pose rigid_pose_of(const double* matrix) {
  if (!has_lowest_row(matrix)) {
    std::ostringstream text;
    text << "the last row of a pose is " << matrix[12] << ' ' << matrix[13] << ' ' << matrix[14]
         << ' ' << matrix[15] << "; it must be 0 0 0 1 (matrices are row-major)";
    refuse(text.str());
  }
  return pose_of(matrix);
}

std::vector<Pose> poses_of(const double* matrices, std::size_t count) {
  require("poses", {sized(matrices, count)});
  std::vector<Pose> poses(count);
  for (std::size_t i = 0; i < count; ++i) poses[i] = pose_of(matrices + 16 * i);
  return poses;
}

void write_outcomes(const GainEvaluator& evaluator, const double* T_world_camera,
                    vg_ray_outcomes* outcomes) {
  require("T_world_camera", {T_world_camera});
  require_struct(outcomes, "vg_ray_outcomes");
  const GainEvaluator::RayOutcomes of = evaluator.outcomes(rigid_pose_of(T_world_camera));
  if (of.rays == 0) refuse("the pose is not a rigid transform of finite numbers");
  write_struct(outcomes, {.struct_size = 0,
                          .rays = of.rays,
                          .too_near = of.too_near,
                          .unknown = of.unknown,
                          .known_surface = of.known_surface,
                          .obstacle = of.obstacle,
                          .out_of_range = of.out_of_range,
                          .out_of_map = of.out_of_map});
}

void write_pose(const Pose& pose, double* matrix) {
  std::copy(pose.m.begin(), pose.m.end(), matrix);
  std::fill_n(matrix + 12, 3, 0.0);
  matrix[15] = 1;
}

void write_poses(std::span<const Pose> poses, double* matrices) {
  for (std::size_t i = 0; i < poses.size(); ++i) write_pose(poses[i], matrices + 16 * i);
}

}  // namespace viewgain::c_api

using namespace viewgain;
using namespace viewgain::c_api;

vg_status vg_sphere_poses(size_t count, double radius, const double center[3], double* poses) {
  return guarded("center poses", {center, poses},
                 [&] { write_poses(sphere_poses(count, radius, vector_of(center)), poses); });
}

vg_status vg_dome_poses(size_t count, double radius, const double center[3], double* poses) {
  return guarded("center poses", {center, poses},
                 [&] { write_poses(dome_poses(count, radius, vector_of(center)), poses); });
}

vg_status vg_order_stops(const double* costs, size_t count, size_t* stops, double* cost) {
  return guarded("costs stops", {sized(costs, count), sized(stops, count)}, [&] {
    const Tour tour = order_stops(count, [&](std::size_t from, std::size_t to) {
      return costs[std::min(from, count) * count + to];
    });
    std::copy(tour.stops.begin(), tour.stops.end(), stops);
    if (cost != nullptr) *cost = tour.cost;
  });
}

vg_status vg_look_at(const double eye[3], const double target[3], const double up[3],
                     double T_world_camera[16]) {
  return guarded("eye target T_world_camera", {eye, target, T_world_camera}, [&] {
    const Eigen::Vector3d upwards = up != nullptr ? vector_of(up) : Eigen::Vector3d::UnitZ();
    write_pose(look_at(vector_of(eye), vector_of(target), upwards), T_world_camera);
  });
}
