// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/fused_points.hpp"
#include "viewgain/mesh/surface.hpp"
#include "viewgain/planner/align_frames.hpp"
#include "viewgain/planner/register_frame.hpp"
#include "viewgain/planner_mesh/truth.hpp"
#include "viewgain/raycast/view_scorer.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain {

/// Settings of the model.
struct VIEWGAIN_EXPORT SurfaceModelConfig {
  /// Settings of the map. Its gain is not used; policies have their own.
  ScorerConfig map{.learn_hazard = true, .gain = {.model = GainModel::paper}};
  FusedPointsConfig points{};  ///< settings of the surface points; scale_sigma is the sensor's
};

/// Surface through the points of a map; vertex i comes from point source[i]. Errors and cost: see
/// reconstruct_surface().
[[nodiscard]] VIEWGAIN_EXPORT SurfaceMesh surface_of(const std::vector<FusedPoint>& points,
                                                     const ExecConfig& exec);

/// Standard deviation along the surface normal [m] of each vertex, from the covariance of its
/// point. SurfaceMesh::source must index the points (unchecked). Cost: O(vertices).
[[nodiscard]] VIEWGAIN_EXPORT std::vector<double> surface_sigmas(
    const SurfaceMesh& surface, const std::vector<FusedPoint>& points);

/// The two representations of Algorithm 1 (UPDATEREPRESENTATIONS): the belief grid and the surface
/// seen so far.
///
/// Thread safety: const members may run from many threads at once, but not during a non-const one.
/// Cost of update(): ViewScorer::add(), fused_points() and reconstruct_surface()
/// (perf/results/loop.md).
class VIEWGAIN_EXPORT SurfaceModel : public RepresentationUpdate {
 public:
  /// If `truth` is null, no quality figures are computed. Throws whatever ViewScorer throws.
  SurfaceModel(const Sensor& sensor, const SurfaceModelConfig& config,
               std::shared_ptr<const Truth> truth, const ExecConfig& exec);

  /// Starts from an existing map, and computes its surface and scene. Throws whatever ViewScorer
  /// and fused_points() throw.
  SurfaceModel(BeliefGrid grid, const Sensor& sensor, const SurfaceModelConfig& config,
               const ExecConfig& exec);

  /// Adds measurements. ModelProgress::seconds has the stages integrate, snapshot, surface and,
  /// with a reference mesh, quality. Throws Error(invalid_argument) if the first view has no
  /// reading in the workspace.
  ModelProgress update(const Measurements& measurements) override;

  /// Rebuilds the model from these measurements in order, after their poses were corrected. Cost:
  /// one update of the map per view; quality is computed once. Throws whatever update() throws; the
  /// previous model is then lost.
  ModelProgress rebuild(std::span<const Measurements> measurements);

  /// The points that the model would have after these measurements. Does not change the model.
  /// Throws whatever ViewScorer::add() throws. Cost: a copy of the map, and update() without the
  /// surface.
  [[nodiscard]] std::vector<FusedPoint> points_after(const Measurements& measurements) const;

  /// The map behind the surface.
  [[nodiscard]] const ViewScorer& scorer() const noexcept { return scorer_; }
  /// The map.
  [[nodiscard]] const BeliefGrid& grid() const noexcept { return scorer_.grid(); }
  /// The scene of the current map.
  [[nodiscard]] std::shared_ptr<const VoxelScene> scene() const { return scorer_.scene(); }
  /// Surface points of the last update, in the order of fused_points().
  [[nodiscard]] const std::vector<FusedPoint>& points() const noexcept { return points_; }
  /// The surface through the points of the last update.
  [[nodiscard]] const SurfaceMesh& surface() const noexcept { return surface_; }
  /// Poses of failed views, which are not among the map's views.
  [[nodiscard]] const std::vector<Pose>& tried() const noexcept { return tried_; }
  /// Quality after each view, if there is a reference mesh.
  [[nodiscard]] const std::vector<QualityFigures>& quality() const noexcept { return quality_; }

 private:
  [[nodiscard]] ModelProgress progress_after(const MapUpdate& update);
  void derive_surface();

  SurfaceModelConfig config_;
  ExecConfig exec_;
  std::shared_ptr<const Truth> truth_;
  ViewScorer scorer_;
  std::vector<FusedPoint> points_;
  SurfaceMesh surface_;
  std::vector<QualityFigures> quality_;
  std::vector<Pose> tried_;
};

/// UPDATEREPRESENTATIONS for slightly wrong poses. Aligns the first frame of each view with those
/// of all other views so far (FrameAlignment) and rebuilds the model from the corrected poses. A
/// view is left out of the model as long as its alignment is refused. The first view's pose is
/// fixed.
///
/// Keeps all frames. Thread safety: one call at a time. Cost of a view: the alignment, and an
/// update for every view so far.
class VIEWGAIN_EXPORT RegisteredModel : public RepresentationUpdate {
 public:
  /// `model` must be empty; a reference is kept. `sigma`: uncertainty of each reported pose. Throws
  /// whatever FrameAlignment throws.
  RegisteredModel(SurfaceModel& model, const PoseSigma& sigma, const ExecConfig& exec = {});

  /// The stages are those of SurfaceModel::update(), plus register. Throws whatever
  /// FrameAlignment::add() and SurfaceModel::rebuild() throw.
  ModelProgress update(const Measurements& measurements) override;

  /// Current registration of each view.
  [[nodiscard]] const std::vector<FrameRegistration>& registrations() const {
    return alignment_.registrations();
  }

 private:
  SurfaceModel& model_;
  PoseSigma sigma_;
  FrameAlignment alignment_;
  std::vector<Measurements> views_;  ///< as reported
};

/// Writes a surface and its points as PLY, each vertex with its normal and the standard deviation
/// along it (`sigma` [m]). `points` are those of the surface, in order. Each file is written
/// atomically; an empty name skips it. Throws Error(io). Cost: O(vertices + triangles + points).
VIEWGAIN_EXPORT void write_surfaces(const SurfaceMesh& surface,
                                    const std::vector<FusedPoint>& points,
                                    const std::filesystem::path& surface_file,
                                    const std::filesystem::path& points_file);

/// As above, for a model.
VIEWGAIN_EXPORT void write_surfaces(const SurfaceModel& model,
                                    const std::filesystem::path& surface_file,
                                    const std::filesystem::path& points_file);

}  // namespace viewgain
