// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "viewgain/core/criterion.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/frame_verdict.hpp"
#include "viewgain/core/jump_edge_filter.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/hazard.hpp"
#include "viewgain/grid/hazard_calibration.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/planner/frame_check.hpp"
#include "viewgain/raycast/obstacle_view.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain {

/// What frames of a sensor show of new surface, to be held against ViewGain::area. Immutable;
/// thread safe. Cost of the constructor: a ray() a pixel; of of(): a pass over the pixels.
class VIEWGAIN_EXPORT RealisedArea {
 public:
  /// Undoes the lens distortion once. The sensor must be one that Sensor::validate() takes.
  /// Readings of the support plane (world z [m]) show nothing: those that is_of_plane() says, as at
  /// integration.
  explicit RealisedArea(const Sensor& sensor, std::optional<double> support_plane = {});

  /// Σ ω t² [m²], area across the rays, over the frame's readings within the sensor's range that
  /// lie in a voxel of the workspace that is unknown in `before`, at d > 1.2 pooling lengths from
  /// what is known of the surface, and show nothing known (DepthFrame::known_depth). `hazard`: that
  /// of the same map; null: no surface is known, all is new. Throws Error(invalid_argument) as
  /// check_frame_size().
  [[nodiscard]] double of(const DepthFrame& frame, const Pose& T_world_camera,
                          const BeliefGrid& before, const HazardField* hazard) const;

 private:
  Sensor sensor_;
  std::optional<double> support_plane_;
  std::vector<Eigen::Vector3d> rays_;
  std::vector<double> solid_angles_;  // [sr]
};

/// What changes the map.
struct VIEWGAIN_EXPORT MapModelConfig {
  GridConfig grid{};                ///< how the map is laid out
  IntegrationConfig integration{};  ///< how frames change it; support_plane stands in surroundings,
                                    ///< another here is refused
  /// Takes flying pixels out of the frames; nothing: they are taken as they are.
  std::optional<JumpEdgeFilter::Config> jump_edges = JumpEdgeFilter::Config{};
  /// They block rays and bodies, and readings of them carve but do not hit.
  Surroundings surroundings{};
  HazardConfig hazard{};  ///< of unknown space, for the surface and the combined gain
  Criterion criterion = Criterion::log_diagonal;  ///< of MapModel::progress()
  bool refine = true;  ///< false: the first reading of a voxel wins, later ones are ignored
  /// Each view is held against what was expected of unknown space: its new surface is measured, and
  /// the hazard learns from it. What the surface and the combined gain need; some milliseconds.
  bool follow_surface = true;
  bool keep_scene = true;  ///< false: scene() is null; what only grows a map saves its time
};

/// What a view brought.
struct VIEWGAIN_EXPORT MapUpdate {
  FrameVerdict verdict = FrameVerdict::used;  ///< unless is_in_map(), the map is as it was
  IntegrationReport counts{};                 ///< of all its frames together
  std::size_t flying_pixels = 0;              ///< that the jump-edge filter took out
  /// New surface that its first frame showed, across the rays [m²], see RealisedArea; NaN without
  /// follow_surface.
  double new_area = std::numeric_limits<double>::quiet_NaN();
  StageSeconds seconds{};  ///< integrate, snapshot
};

/// The occupancy grid O of Algorithm 1 as frames go into it, and the scene to score views against.
///
/// Thread safety: const members may run from many threads at once; nothing may run beside update().
/// Scenes that it has handed out stay as they are. Cost of update(): FrameIntegrator::integrate() a
/// frame and VoxelScene::update(), 6 and 2 ms after eight views of the camel
/// (perf/results/loop.md); of the constructor VoxelScene::build().
class VIEWGAIN_EXPORT MapModel {
 public:
  /// An empty map. Throws Error(invalid_argument) as the parts: a sensor, grid, obstacle or filter
  /// that is not valid; and for voxels as large as the workspace or larger than the sensor's range.
  MapModel(const Sensor& sensor, const MapModelConfig& config, const ExecConfig& exec = {});

  /// One that goes on from `grid`; config.grid says nothing then. Throws as the other.
  MapModel(BeliefGrid grid, const Sensor& sensor, const MapModelConfig& config,
           const ExecConfig& exec = {});

  /// Filters the frames, integrates them and brings the scene up to date, unless they cannot be
  /// used: the one place that says which can. lost_pose: the pose is not rigid (1e-3);
  /// wrong_size: a frame has another size than the sensor's images; nothing_in_range: no pixel
  /// says anything; outside: no voxel of the workspace would be hit or carved. Throws
  /// Error(invalid_argument) for a sigma that is negative or not finite, and for a
  /// DepthFrame::identity of another form; nothing has changed then.
  /// Error(capacity) and Error(backend) are those of VoxelScene::build(): the frames are in the map
  /// then. Known depths of the frames are set anew by the obstacles. Frames without a reading in
  /// the workspace cost a copy of the map.
  MapUpdate update(const Measurements& measurements);

  /// The grid as it would be after these measurements, which do not change it. Throws
  /// Error(invalid_argument) for a pose, a size or a sigma that update() would not take. Costs a
  /// copy of it, and the integration.
  [[nodiscard]] BeliefGrid grid_after(const Measurements& measurements) const;

  /// The map.
  [[nodiscard]] const BeliefGrid& grid() const noexcept { return grid_; }
  /// The scene of the map as it is; null without keep_scene.
  [[nodiscard]] const std::shared_ptr<const VoxelScene>& scene() const noexcept { return scene_; }
  /// The camera that frames come from.
  [[nodiscard]] const Sensor& sensor() const noexcept { return sensor_; }
  /// Entropy removed and unknown voxels; no coverage and no surface.
  [[nodiscard]] ModelProgress progress() const;
  /// Whether the frames that have come fit one another. Cost: FrameCheck::result().
  [[nodiscard]] FrameConsistency consistency() const { return check_.result(grid_); }

 private:
  /// What is wrong with them before anybody looks at the pixels, else `used`.
  [[nodiscard]] FrameVerdict judged(const Measurements& measurements) const;
  [[nodiscard]] bool shows_workspace(const DepthFrame& frame, const Pose& T_world_camera) const;
  /// The filtered frames into `grid`, which is grid_ or a copy of it.
  void integrate(BeliefGrid& grid, const std::vector<DepthFrame>& frames,
                 const Measurements& measurements, MapUpdate& update);
  /// The frames as they go into the map.
  [[nodiscard]] std::vector<DepthFrame> filtered(const Measurements& measurements,
                                                 std::size_t* flying_pixels) const;
  void drop_known_readings(DepthFrame& frame, const Pose& T_world_camera) const;

  Sensor sensor_;
  MapModelConfig config_;
  ExecConfig exec_;
  BeliefGrid grid_;
  std::optional<JumpEdgeFilter> filter_;
  std::vector<Eigen::Vector3d> rays_;  // of the pixels, (x, y, 1); not finite: the lens has none
  ObstacleView obstacles_;
  FrameIntegrator integrator_;
  FrameCheck check_;
  RealisedArea new_surface_;
  HazardCalibration calibration_;
  std::shared_ptr<const VoxelScene> scene_;
};

}  // namespace viewgain
