// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "viewgain/core/jump_edge_filter.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/fused_points.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/planner_mesh/truth.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"

namespace viewgain::bench {

/// An object and an SR4000 with the default disturbances of `viewgain reconstruct`: noise, flying
/// pixels and background, followed by the jump-edge filter.
class ModelScene {
 public:
  ModelScene(const std::filesystem::path& mesh, std::uint64_t seed, const ExecConfig& exec);

  [[nodiscard]] const Stage& stage() const noexcept { return stage_; }
  [[nodiscard]] const Sensor& sensor() const noexcept { return sensor_; }

  /// A disturbed and filtered frame.
  [[nodiscard]] DepthFrame acquire(const Pose& T_world_camera, std::uint64_t frame) const;
  /// A frame without disturbances.
  [[nodiscard]] DepthFrame true_frame(const Pose& T_world_camera) const;

  [[nodiscard]] BeliefGrid empty_grid(double voxel_size) const;

 private:
  Sensor sensor_;
  Stage stage_;
  SimulatedSensor camera_;
  SimulatedSensor undisturbed_;
  JumpEdgeFilter filter_;
};

}  // namespace viewgain::bench
