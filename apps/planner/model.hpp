// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "loop_exec.hpp"
#include "realised_area.hpp"
#include "truth.hpp"
#include "viewgain/core/criterion.hpp"
#include "viewgain/core/jump_edge_filter.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/fused_points.hpp"
#include "viewgain/grid/hazard_calibration.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/mesh/surface.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain::app {

/// What changes the model.
struct ModelConfig {
  GridConfig grid{};
  IntegrationConfig integration{};
  std::optional<JumpEdgeConfig> jump_edges{};
  FusedPointsConfig points{};
  Obstacles obstacles{};  ///< known ones, which block rays and bodies
  HazardConfig hazard{};  ///< of unknown space, for the surface and the combined gain
  Criterion criterion = Criterion::log_diagonal;
  bool refine = true;  ///< false: the first reading of a voxel wins, later ones are ignored
};

/// The surface through the points of a map, `spacing` [m] apart (its pooling length); vertex i
/// comes from point source[i].
[[nodiscard]] SurfaceMesh surface_of(const std::vector<FusedPoint>& points, double spacing,
                                     const ExecConfig& exec);

/// The two representations of the scene, the belief grid and the surface seen so far
/// (UPDATEREPRESENTATIONS of Algorithm 1), and what is derived from them after each view.
class Model : public RepresentationUpdate {
 public:
  /// `truth` may be null: then there is no quality.
  Model(const Sensor& sensor, const ModelConfig& config, std::shared_ptr<const Truth> truth,
        const LoopExec& exec);

  /// From an existing map: its surface and scene, ready for candidates.
  Model(BeliefGrid grid, const Sensor& sensor, const ModelConfig& config, const LoopExec& exec);

  /// Throws Error(invalid_argument) if the first view has no reading in the workspace.
  ModelProgress update(const Measurements& measurements) override;

  /// The points that the model would have after these measurements, which do not change it. Costs a
  /// copy of the map beside what update() costs without a surface.
  [[nodiscard]] std::vector<FusedPoint> points_after(const Measurements& measurements) const;

  [[nodiscard]] const BeliefGrid& grid() const noexcept { return grid_; }
  [[nodiscard]] const std::shared_ptr<const VoxelScene>& scene() const noexcept { return scene_; }
  [[nodiscard]] const std::vector<FusedPoint>& points() const noexcept { return points_; }
  [[nodiscard]] const SurfaceMesh& surface() const noexcept { return surface_; }
  /// New surface that the last view's first frame showed [m²]; see RealisedArea.
  [[nodiscard]] double realised_area() const noexcept { return realised_area_; }
  /// After each view, where there is a truth.
  [[nodiscard]] const std::vector<QualityFigures>& quality() const noexcept { return quality_; }

 private:
  void integrate(const Measurements& measurements);
  /// The frames as they go into the map.
  [[nodiscard]] std::vector<DepthFrame> filtered(const Measurements& measurements) const;
  [[nodiscard]] double area_shown_by(const DepthFrame& frame, const Pose& T_world_camera) const;
  void derive();
  /// Turns readings whose voxel was hit by an earlier view into invalid ones.
  void drop_known_readings(DepthFrame& frame, const Pose& T_world_camera) const;

  Sensor sensor_;
  ModelConfig config_;
  LoopExec exec_;
  std::shared_ptr<const Truth> truth_;
  BeliefGrid grid_;
  std::optional<JumpEdgeFilter> filter_;
  FrameIntegrator integrator_;
  RealisedArea new_surface_;
  HazardCalibration calibration_;
  std::shared_ptr<const VoxelScene> scene_;
  std::vector<FusedPoint> points_;
  SurfaceMesh surface_;
  double realised_area_ = 0;
  std::vector<QualityFigures> quality_;
};

}  // namespace viewgain::app
