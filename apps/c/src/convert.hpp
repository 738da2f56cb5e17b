// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "status.hpp"
#include "viewgain/core/camera.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/range_calibration.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/core/triangle_mesh.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/hazard_calibration.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/raycast/feasibility.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/raycast/voxel_scene.hpp"
#include "viewgain/support/voxels_text.hpp"

// The opaque handles of viewgain.h. Objects made from a scene share it, so handles can be released
// in any order.

struct vg_range_calibration {
  viewgain::RangeCorrector corrector;
};

struct vg_grid {
  viewgain::BeliefGrid grid;
};

struct vg_integrator {
  viewgain::FrameIntegrator integrator;
  viewgain::HazardCalibration calibration;
  viewgain::PinholeCamera camera;  // of the frames
};

struct vg_scene {
  std::shared_ptr<const viewgain::VoxelScene> scene;
};

struct vg_evaluator {
  viewgain::GainEvaluator evaluator;
};

struct vg_feasibility {
  viewgain::FeasibilityChecker checker;
};

namespace viewgain::c_api {

inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Empty for NaN.
[[nodiscard]] inline std::optional<double> given(double value) {
  return std::isnan(value) ? std::nullopt : std::optional(value);
}

/// Copies `coarsest`, `fine` and `finest`. Throws Error(invalid_argument) if boxes are missing.
template <typename Config, typename Settings>
void set_scales(const Config& given, Settings& settings) {
  settings.coarsest = given.coarsest;
  settings.finest = given.finest;
  require("fine", {sized(given.fine, given.fine_count)});
  for (const double* b = given.fine; settings.fine.size() < given.fine_count; b += 6) {
    settings.fine.push_back({{b[0], b[1], b[2]}, {b[3], b[4], b[5]}});
  }
}

/// The box of voxels that an array labels. Throws Error(invalid_argument) unless it is inside the
/// workspace.
[[nodiscard]] inline VoxelBox box_in(const VoxelBox& workspace, const std::int32_t* first,
                                     const std::int32_t* dims) {
  const auto is_inside = [](std::int64_t a, std::int64_t n, std::int64_t min, std::int64_t max) {
    return n >= 0 && a >= min && a + n <= max;
  };
  if (!is_inside(first[0], dims[0], workspace.min.x, workspace.max.x) ||
      !is_inside(first[1], dims[1], workspace.min.y, workspace.max.y) ||
      !is_inside(first[2], dims[2], workspace.min.z, workspace.max.z)) {
    refuse("the box must be inside the workspace, voxels " + voxels_text(workspace));
  }
  return VoxelBox::from_dims({first[0], first[1], first[2]}, {dims[0], dims[1], dims[2]});
}

/// Converts to an enumerator. Throws Error(invalid_argument) unless it is in 0..last.
template <typename Enum>
[[nodiscard]] Enum enum_of(std::int32_t value, std::int32_t last, const std::string& name) {
  if (value >= 0 && value <= last) return static_cast<Enum>(value);
  refuse(name + " is " + std::to_string(value) + "; it must be in 0.." + std::to_string(last));
}

[[nodiscard]] inline ExecConfig exec_of(std::int32_t num_threads, std::int32_t tracer) {
  return {num_threads, enum_of<ExecConfig::Tracer>(tracer, VG_TRACER_SWEEP, "tracer")};
}

/// A pose from 16 numbers, row-major; all NaN if the last row deviates from 0 0 0 1 by more than
/// 1e-3.
[[nodiscard]] VIEWGAIN_EXPORT Pose pose_of(const double* matrix);
/// Like pose_of(), but throws Error(invalid_argument) for such a row.
[[nodiscard]] VIEWGAIN_EXPORT Pose rigid_pose_of(const double* matrix);
/// From the argument pose_sigma; null: exact poses.
[[nodiscard]] VIEWGAIN_EXPORT PoseSigma pose_sigma_of(const double* sigmas);
/// `count` poses of 16 numbers each. Throws Error(invalid_argument) for null.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> poses_of(const double* matrices, std::size_t count);

VIEWGAIN_EXPORT void write_pose(const Pose& pose, double* matrix);
VIEWGAIN_EXPORT void write_poses(std::span<const Pose> poses, double* matrices);

/// Fills an initialised struct. Throws Error(invalid_argument) for null, another size or a pose
/// that is not rigid (1e-3).
VIEWGAIN_EXPORT void write_outcomes(const GainEvaluator& evaluator, const double* T_world_camera,
                                    vg_ray_outcomes* outcomes);

/// Throws Error(invalid_argument) for null, another size or an unknown noise model.
[[nodiscard]] VIEWGAIN_EXPORT Sensor sensor_of(const vg_sensor* given);
/// Fills an initialised struct. Throws Error(invalid_argument) if it is not initialised.
VIEWGAIN_EXPORT void write_sensor(const Sensor& sensor, vg_sensor* out);

/// A frame of the camera's size; `amplitude` may be null.
[[nodiscard]] inline DepthFrame frame_of(const PinholeCamera& camera, const float* depth,
                                         const float* amplitude) {
  const auto count =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  DepthFrame frame;
  frame.width = camera.width;
  frame.height = camera.height;
  frame.depth.assign(depth, depth + count);
  if (amplitude != nullptr) frame.amplitude.assign(amplitude, amplitude + count);
  return frame;
}

[[nodiscard]] inline Eigen::Vector3d vector_of(const double* xyz) {
  return {xyz[0], xyz[1], xyz[2]};
}

/// The surroundings of a struct with the fields of vg_scene_config.
template <typename Config>
[[nodiscard]] Surroundings surroundings_of(const Config& config) {
  require("boxes vertices triangles",
          {sized(config.boxes, config.box_count), sized(config.vertices, config.vertex_count),
           sized(config.triangles, config.triangle_count)});
  Surroundings surroundings{{}, given(config.support_plane)};
  for (std::size_t i = 0; i < config.box_count; ++i) {
    const double* box = config.boxes + 6 * i;
    surroundings.obstacles.boxes.push_back({{box[0], box[1], box[2]}, {box[3], box[4], box[5]}});
  }
  if (config.triangle_count == 0) return surroundings;
  TriangleMesh mesh;
  for (std::size_t i = 0; i < config.vertex_count; ++i) {
    const double* p = config.vertices + 3 * i;
    mesh.vertices.push_back({p[0], p[1], p[2]});
  }
  for (std::size_t i = 0; i < config.triangle_count; ++i) {
    const std::uint32_t* corners = config.triangles + 3 * i;
    mesh.triangles.push_back({corners[0], corners[1], corners[2]});
  }
  surroundings.obstacles.meshes.push_back(std::move(mesh));
  return surroundings;
}

/// The caller's predicate of reachable poses; null: all are reachable.
[[nodiscard]] inline std::function<bool(const Pose&)> predicate_of(
    std::int32_t (*reachable)(const double*, void*), void* user) {
  if (reachable == nullptr) return {};
  return [reachable, user](const Pose& T_world_camera) {
    std::array<double, 16> matrix{};
    write_pose(T_world_camera, matrix.data());
    return reachable(matrix.data(), user) != 0;
  };
}

}  // namespace viewgain::c_api
