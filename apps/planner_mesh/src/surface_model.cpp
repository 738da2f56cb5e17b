// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/planner_mesh/surface_model.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/formats/ply.hpp"
#include "viewgain/planner/point_arrays.hpp"
#include "viewgain/planner_mesh/mesh_area.hpp"
#include "viewgain/support/stopwatch.hpp"

namespace viewgain {
namespace {

SurfaceModelConfig with_scale(SurfaceModelConfig config, const Sensor& sensor) {
  config.points.scale_sigma = sensor.scale_sigma;
  return config;
}

std::vector<float> point_sigmas(const PointArrays& points) {
  std::vector<float> sigmas;
  sigmas.reserve(points.normals.size());
  for (std::size_t i = 0; i < points.normals.size(); ++i) {
    const Eigen::Vector3d n(points.normals[i].data());
    sigmas.push_back(static_cast<float>(std::sqrt(n.dot(points.covariances[i] * n))));
  }
  return sigmas;
}

}  // namespace

SurfaceMesh surface_of(const std::vector<FusedPoint>& points, const ExecConfig& exec) {
  if (points.empty()) return {};
  std::vector<OrientedPoint> oriented;
  oriented.reserve(points.size());
  SurfaceConfig config;
  config.spacing = points.front().spacing;
  for (const FusedPoint& point : points) {
    oriented.push_back({point.position, point.toward_free, point.spacing});
    config.spacing = std::min(config.spacing, point.spacing);
  }
  return reconstruct_surface(oriented, config, exec);
}

std::vector<double> surface_sigmas(const SurfaceMesh& surface,
                                   const std::vector<FusedPoint>& points) {
  std::vector<double> sigmas;
  sigmas.reserve(surface.vertices.size());
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    const Eigen::Vector3d normal(surface.normals[i].data());
    sigmas.push_back(std::sqrt(normal.dot(points[surface.source[i]].covariance * normal)));
  }
  return sigmas;
}

SurfaceModel::SurfaceModel(const Sensor& sensor, const SurfaceModelConfig& config,
                           std::shared_ptr<const Truth> truth, const ExecConfig& exec)
    : config_(with_scale(config, sensor)),
      exec_(exec),
      truth_(std::move(truth)),
      scorer_(sensor, config.map, exec) {}

SurfaceModel::SurfaceModel(BeliefGrid grid, const Sensor& sensor, const SurfaceModelConfig& config,
                           const ExecConfig& exec)
    : config_(with_scale(config, sensor)),
      exec_(exec),
      scorer_(std::move(grid), sensor, config.map, exec) {
  derive_surface();
}

ModelProgress SurfaceModel::update(const Measurements& measurements) {
  const bool first = grid().views().empty();
  const MapUpdate update = scorer_.add(measurements);
  if (first && update.counts.readings_inside == 0) {
    throw Error(ErrorCode::invalid_argument,
                "the first view shows nothing in the workspace. Does the camera look away from the "
                "workspace? Is the workspace out of range, or behind an obstacle?");
  }
  if (!is_in_map(update.verdict)) tried_.push_back(measurements.T_world_camera);
  return progress_after(update);
}

ModelProgress SurfaceModel::rebuild(std::span<const Measurements> measurements) {
  scorer_ = ViewScorer(scorer_.sensor(), config_.map, exec_);
  MapUpdate sum;
  for (const Measurements& m : measurements) {
    MapUpdate last = scorer_.add(m);
    for (const auto& [stage, seconds] : sum.seconds) last.seconds[stage] += seconds;
    sum = std::move(last);
  }
  return progress_after(sum);
}

ModelProgress SurfaceModel::progress_after(const MapUpdate& update) {
  StageSeconds seconds = update.seconds;
  const Stopwatch surface_watch;
  derive_surface();
  seconds["surface"] = surface_watch.seconds();
  if (truth_) {
    const Stopwatch quality_watch;
    quality_.push_back(truth_->figures(surface_, points_));
    seconds["quality"] = quality_watch.seconds();
  }
  ModelProgress progress = scorer_.progress();
  progress.surface_area = mesh_area(surface_);
  progress.new_area = is_in_map(update.verdict) ? update.new_area : 0.0;
  if (truth_) progress.coverage = quality_.back().coverage_visible;
  progress.seconds = std::move(seconds);
  return progress;
}

std::vector<FusedPoint> SurfaceModel::points_after(const Measurements& measurements) const {
  return fused_points(scorer_.grid_after(measurements), config_.points, exec_);
}

void SurfaceModel::derive_surface() {
  points_ = fused_points(grid(), config_.points, exec_);
  surface_ = surface_of(points_, exec_);
}

RegisteredModel::RegisteredModel(SurfaceModel& model, const PoseSigma& sigma,
                                 const ExecConfig& exec)
    : model_(model),
      sigma_(sigma),
      alignment_(model.scorer().sensor(), model.scorer().config(), exec) {}

ModelProgress RegisteredModel::update(const Measurements& measurements) {
  if (measurements.frames.empty()) refuse("a view must have at least one frame to be registered");
  const Stopwatch watch;
  alignment_.add(measurements.frames.front(), measurements.T_world_camera, sigma_);
  views_.push_back(measurements);
  std::vector<Measurements> kept;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    const FrameRegistration& registration = registrations()[i];
    if (registration.status == RegistrationStatus::refused) continue;
    kept.push_back(views_[i]);
    kept.back().T_world_camera = registration.T_world_camera;
    kept.back().pose_sigma = registration.pose_sigma();
  }
  const double seconds = watch.seconds();
  ModelProgress progress = views_.size() == 1 ? model_.update(kept.front()) : model_.rebuild(kept);
  // Refers to the last view, even if it was not kept.
  if (registrations().back().status == RegistrationStatus::refused) progress.new_area = 0;
  progress.seconds["register"] = seconds;
  return progress;
}

void write_surfaces(const SurfaceMesh& surface, const std::vector<FusedPoint>& points,
                    const std::filesystem::path& surface_file,
                    const std::filesystem::path& points_file) {
  if (!surface_file.empty()) {
    const std::vector<double> sigmas = surface_sigmas(surface, points);
    write_ply(surface_file, {surface.vertices, surface.normals,
                             std::vector<float>(sigmas.begin(), sigmas.end()), surface.triangles});
  }
  if (points_file.empty()) return;
  const PointArrays arrays = arrays_of(points);
  write_ply(points_file, {arrays.positions, arrays.normals, point_sigmas(arrays)});
}

void write_surfaces(const SurfaceModel& model, const std::filesystem::path& surface_file,
                    const std::filesystem::path& points_file) {
  write_surfaces(model.surface(), model.points(), surface_file, points_file);
}

}  // namespace viewgain
