// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "convert.hpp"
#include "viewgain/core/generators.hpp"

using namespace viewgain;
using namespace viewgain::c_api;

vg_status vg_sphere_poses(size_t count, double radius, const double center[3], double* poses) {
  return guarded([&] {
    require(center, "center");
    require(poses, "poses");
    write_poses(sphere_poses(count, radius, vector_of(center)), poses);
  });
}

vg_status vg_dome_poses(size_t count, double radius, const double center[3], double* poses) {
  return guarded([&] {
    require(center, "center");
    require(poses, "poses");
    write_poses(dome_poses(count, radius, vector_of(center)), poses);
  });
}

vg_status vg_look_at(const double eye[3], const double target[3], const double up[3],
                     double T_world_camera[16]) {
  return guarded([&] {
    require(eye, "eye");
    require(target, "target");
    require(T_world_camera, "T_world_camera");
    const Eigen::Vector3d upwards = up != nullptr ? vector_of(up) : Eigen::Vector3d::UnitZ();
    write_pose(look_at(vector_of(eye), vector_of(target), upwards), T_world_camera);
  });
}
