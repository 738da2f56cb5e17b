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

/// What changes the model.
struct VIEWGAIN_EXPORT SurfaceModelConfig {
  /// How the map is kept. Its gain scores no view; choices have gains of their own.
  ScorerConfig map{.learn_hazard = true, .gain = {.model = GainModel::paper}};
  FusedPointsConfig points{};  ///< how beliefs become points; scale_sigma is the sensor's
};

/// The surface through the points of a map; vertex i comes from point source[i]. Throws and costs
/// as reconstruct_surface().
[[nodiscard]] VIEWGAIN_EXPORT SurfaceMesh surface_of(const std::vector<FusedPoint>& points,
                                                     const ExecConfig& exec);

/// One a vertex, the standard deviation along the surface's normal [m], of the point that it comes
/// from; `source` must index the points, which is not checked. Costs O(vertices).
[[nodiscard]] VIEWGAIN_EXPORT std::vector<double> surface_sigmas(
    const SurfaceMesh& surface, const std::vector<FusedPoint>& points);

/// The two representations of the scene, the belief grid and the surface seen so far
/// (UPDATEREPRESENTATIONS of Algorithm 1), and what is derived from them after each view.
///
/// Thread safety: const members may run from many threads at once; nothing may run beside the
/// others. Cost of update(): ViewScorer::add(), fused_points() and reconstruct_surface(); 8 and
/// 574 ms after eight views of the camel (perf/results/loop.md).
class VIEWGAIN_EXPORT SurfaceModel : public RepresentationUpdate {
 public:
  /// `truth` may be null: then there is no quality. Throws as ViewScorer.
  SurfaceModel(const Sensor& sensor, const SurfaceModelConfig& config,
               std::shared_ptr<const Truth> truth, const ExecConfig& exec);

  /// From an existing map: its surface and scene, ready for candidates. Throws as ViewScorer and
  /// fused_points().
  SurfaceModel(BeliefGrid grid, const Sensor& sensor, const SurfaceModelConfig& config,
               const ExecConfig& exec);

  /// The stages of its seconds: integrate, snapshot, surface and, where there is a truth, quality.
  /// Throws Error(invalid_argument) if the first view has no reading in the workspace.
  ModelProgress update(const Measurements& measurements) override;

  /// The model as it would be had these measurements come to an empty map in this order, for poses
  /// that became better known. Costs as many updates of the map; its quality is another view's.
  /// Throws as update(); what was there is lost then.
  ModelProgress rebuild(std::span<const Measurements> measurements);

  /// The points that the model would have after these measurements, which do not change it. Throws
  /// as ViewScorer::add(). Costs a copy of the map beside what update() costs without a surface.
  [[nodiscard]] std::vector<FusedPoint> points_after(const Measurements& measurements) const;

  /// The map behind the surface.
  [[nodiscard]] const ViewScorer& scorer() const noexcept { return scorer_; }
  /// The map.
  [[nodiscard]] const BeliefGrid& grid() const noexcept { return scorer_.grid(); }
  /// The scene of the map as it is.
  [[nodiscard]] std::shared_ptr<const VoxelScene> scene() const { return scorer_.scene(); }
  /// Surface points of the last update, in the order of fused_points().
  [[nodiscard]] const std::vector<FusedPoint>& points() const noexcept { return points_; }
  /// The surface through the points of the last update.
  [[nodiscard]] const SurfaceMesh& surface() const noexcept { return surface_; }
  /// Poses of views that brought nothing and are not among the map's.
  [[nodiscard]] const std::vector<Pose>& tried() const noexcept { return tried_; }
  /// One a view, where there is a truth, in their order.
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

/// UPDATEREPRESENTATIONS for poses that are a little wrong: each view's first frame is aligned with
/// those of all views so far, which moves these, too, and the model is made anew from the poses
/// that come of it. A view that is refused stays out of the model, for as long as it is. The first
/// view's pose holds.
///
/// Keeps all frames. Thread safety: one call at a time. Cost of a view: what the alignment takes,
/// and an update for every view so far.
class VIEWGAIN_EXPORT RegisteredModel : public RepresentationUpdate {
 public:
  /// `model` must be empty and is kept by reference. `sigma`: by how much each reported pose may be
  /// off. Throws Error(invalid_argument) as FrameAlignment.
  RegisteredModel(SurfaceModel& model, const PoseSigma& sigma, const ExecConfig& exec = {});

  /// Stages as SurfaceModel::update() and register. Throws as FrameAlignment::add() and
  /// SurfaceModel::rebuild().
  ModelProgress update(const Measurements& measurements) override;

  /// One a view, what became of it, as known now.
  [[nodiscard]] const std::vector<FrameRegistration>& registrations() const {
    return alignment_.registrations();
  }

 private:
  SurfaceModel& model_;
  PoseSigma sigma_;
  FrameAlignment alignment_;
  std::vector<Measurements> views_;  ///< as reported
};

/// Writes a surface and the points that it goes through as PLY, each vertex with its normal and its
/// standard deviation along it (`sigma` [m]). `points` are those that the surface was made of, in
/// their order. Atomic, each file for itself; an empty name: not written. Throws Error(io). Costs
/// O(vertices + triangles + points).
VIEWGAIN_EXPORT void write_surfaces(const SurfaceMesh& surface,
                                    const std::vector<FusedPoint>& points,
                                    const std::filesystem::path& surface_file,
                                    const std::filesystem::path& points_file);

/// The same of a model.
VIEWGAIN_EXPORT void write_surfaces(const SurfaceModel& model,
                                    const std::filesystem::path& surface_file,
                                    const std::filesystem::path& points_file);

}  // namespace viewgain
