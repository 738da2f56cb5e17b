// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/planner_mesh/truth.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "viewgain/core/error.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/planner/point_arrays.hpp"
#include "viewgain/planner_mesh/mesh_area.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

constexpr std::size_t kPoses = 2562, kSamples = 10'000;
constexpr std::uint64_t kSeed = 1;  // of the samples
const double kMinCosine = std::cos(80.0 * std::numbers::pi / 180);
constexpr double kNearer = 2.5e-3;  // [m]
constexpr double kStep = 2.5e-3;    // between tried distances [m]
constexpr int kMostSteps = 20'000;  // in each direction, 50 m

// The pose at another distance from the centre [m].
Pose moved(const Pose& pose, const Eigen::Vector3d& center, double distance) {
  const Eigen::Vector3d away = (pose.translation() - center).normalized();
  return {pose.rotation(), center + distance * away};
}

// The pose at the possible distance from the centre that is nearest to the given distance.
template <typename Possible>
std::optional<Pose> moved_into_reach(const Pose& pose, const VisibilityConfig& config, double least,
                                     double most, const Possible& possible) {
  for (int k = 1; k <= kMostSteps; ++k) {
    const double farther = config.distance + k * kStep, nearer = config.distance - k * kStep;
    if (farther > most && nearer < least) break;
    for (const double distance : {farther, nearer}) {
      if (distance > most || distance < least) continue;
      const Pose there = moved(pose, config.center, distance);
      if (possible(there)) return there;
    }
  }
  return std::nullopt;
}

double radius_round(const TriangleMesh& mesh, const Eigen::Vector3d& center) {
  double radius = 0;
  for (const auto& v : mesh.vertices) {
    radius = std::max(radius, (Eigen::Vector3d(v[0], v[1], v[2]) - center).norm());
  }
  return radius;
}

// Poses from which the camera can look at the object.
std::vector<Pose> looking_poses(const VisibilityConfig& config, const Sensor& sensor,
                                const TriangleMesh& mesh) {
  const auto possible = [&](const Pose& pose) {
    return config.reach.contains(pose) &&
           !(config.support_plane && pose.translation().z() <= *config.support_plane);
  };
  std::vector<Pose> poses{config.start};
  if (!config.reach.poses.empty()) {  // a lattice almost never has a pose of the list
    std::copy_if(config.reach.poses.begin(), config.reach.poses.end(), std::back_inserter(poses),
                 possible);
    return poses;
  }
  const double radius = radius_round(mesh, config.center);
  for (const Pose& pose : sphere_poses(kPoses, config.distance, config.center)) {
    if (possible(pose)) {
      poses.push_back(pose);
    } else if (!config.reach.contains(pose)) {
      const std::optional<Pose> in_reach =
          moved_into_reach(pose, config, radius, radius + sensor.max_range, possible);
      if (in_reach) poses.push_back(*in_reach);
    }
  }
  return poses;
}

}  // namespace

Stage set_stage(const StageConfig& config, const ExecConfig& exec) {
  if (config.size && (!(*config.size > 0) || !std::isfinite(*config.size))) {
    refuse("the object size must be positive and finite, not " + short_text(*config.size) + " m");
  }
  Stage stage;
  TriangleMesh mesh =
      read_mesh(config.mesh, {config.up, true, config.size.value_or(0)}, &stage.repairs);
  stage.size = config.size ? *config.size : longest_side(bounds_of(mesh));
  if (!(stage.size > 0)) refuse(config.mesh.string() + ": the mesh has the size 0");
  if (config.support_plane) {
    const double lowest = bounds_of(mesh).min[2];  // the box is centred at the origin
    for (auto& v : mesh.vertices) v[2] += *config.support_plane - lowest;
    stage.center.z() = *config.support_plane - lowest;
  }
  const double half = 0.5 * stage.size * 0.4 / 0.35;
  for (std::size_t a = 0; a < 3; ++a) {
    const double middle = stage.center[static_cast<Eigen::Index>(a)];
    stage.workspace.min[a] = middle - half;
    stage.workspace.max[a] = middle + half;
  }
  if (config.workspace) stage.workspace = *config.workspace;
  if (config.support_plane) {
    stage.workspace.min[2] = std::max(stage.workspace.min[2], *config.support_plane);
    if (!(stage.workspace.min[2] < stage.workspace.max[2])) {
      refuse("the whole workspace lies below the support plane, whose height is " +
             short_text(*config.support_plane) + " m");
    }
  }
  stage.scene = std::make_shared<const SurfaceScene>(std::move(mesh), exec);
  return stage;
}

Pose default_start(const Stage& stage, double distance, std::uint64_t seed,
                   const ReachRegion& reach, const std::optional<double>& support_plane) {
  const auto possible = [&](const Pose& pose) {
    return reach.contains(pose) && !(support_plane && pose.translation().z() <= *support_plane);
  };
  // The golden angle spreads the seeds' azimuths evenly.
  const double azimuth =
      std::fmod(static_cast<double>(seed % 360'000) * 137.50776 * kDegree, 2 * std::numbers::pi);
  const Pose wanted = orbit_poses(1, distance, 27 * kDegree, azimuth, 0.0, stage.center).front();
  if (possible(wanted)) return wanted;
  std::vector<Pose> others = sphere_poses(2562, distance, stage.center);
  others.insert(others.end(), reach.poses.begin(), reach.poses.end());
  const Pose* nearest = nullptr;
  double least = 0;
  for (const Pose& pose : others) {
    const double d = (pose.translation() - wanted.translation()).norm();
    if (possible(pose) && (nearest == nullptr || d < least)) nearest = &pose, least = d;
  }
  if (nearest == nullptr) refuse("no reachable pose looks at the object");
  return *nearest;
}

void mark_seen(const SurfaceScene& scene, const SurfaceScene* surroundings, const Sensor& sensor,
               const Pose& T_world_camera, double least_cosine,
               std::span<const SurfaceSample> samples, std::span<std::uint8_t> seen) {
  const Eigen::Vector3d eye = T_world_camera.translation();
  const Pose T_camera_world = T_world_camera.inverse();
  std::vector<SurfaceScene::Ray> rays;
  std::vector<std::size_t> asked;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (seen[i] != 0) continue;
    const SurfaceSample& sample = samples[i];
    const Eigen::Vector3d sight = sample.position - eye;
    const double range = sight.norm();
    if (!(range > sensor.min_range && range < sensor.max_range)) continue;
    if (std::abs(sight.dot(sample.normal)) < least_cosine * range) continue;
    if (!sensor.camera.sees(T_camera_world * sample.position)) continue;
    // Stops before the sample, so that its own triangle does not hide it.
    rays.push_back({eye, sight / range, range * (1 - 1e-4)});
    asked.push_back(i);
  }
  const auto hidden = std::make_unique<bool[]>(2 * rays.size());
  const std::span all(hidden.get(), 2 * rays.size());
  scene.block(rays, all.first(rays.size()));
  if (surroundings != nullptr) surroundings->block(rays, all.last(rays.size()));
  for (std::size_t k = 0; k < rays.size(); ++k) {
    if (!all[k] && !all[rays.size() + k]) seen[asked[k]] = 1;
  }
}

Truth::Truth(std::shared_ptr<const SurfaceScene> scene, const Sensor& sensor,
             const VisibilityConfig& config, const ExecConfig& exec)
    : truth_(scene->mesh(), kSamples, kSeed, exec),
      area_per_sample_(mesh_area(scene->mesh()) / static_cast<double>(kSamples)),
      tolerance_(config.tolerance) {
  const std::vector<Pose> poses = looking_poses(config, sensor, scene->mesh());
  const std::vector<SurfaceSample>& samples = truth_.samples();
  visible_.resize(samples.size());
  ThreadPool pool(exec.num_threads);
  pool.for_each_chunk(samples.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (const Pose& pose : poses) {
      mark_seen(*scene, config.surroundings.get(), sensor, pose, kMinCosine,
                std::span(samples).subspan(begin, end - begin),
                std::span(visible_).subspan(begin, end - begin));
    }
  });
}

QualityFigures quality_figures(const GroundTruth& truth, const SurfaceMesh& surface,
                               std::span<const FusedPoint> points, double tolerance,
                               std::span<const std::uint8_t> visible) {
  if (visible.size() != truth.samples().size()) {
    refuse("visible must have one entry per sample; samples: " +
           std::to_string(truth.samples().size()) + ", entries: " + std::to_string(visible.size()));
  }
  const PointArrays arrays = arrays_of(points);
  const std::vector<double> distances = truth.distances_to(surface.vertices);
  const auto share = [&](const std::vector<double>& of) {
    return coverage(of, tolerance, visible);
  };
  QualityFigures figures;
  figures.coverage = coverage(distances, tolerance);
  figures.coverage_visible = share(distances);
  figures.coverage_points = share(truth.distances_to(arrays.positions));
  figures.coverage_triangles =
      share(truth.distances_to(TriangleMesh{surface.vertices, surface.triangles}));
  figures.coverage_2_5mm = coverage(distances, kNearer);
  figures.surface_error = truth.error(surface.vertices);
  figures.points_error = truth.error(arrays.positions);
  figures.consistency = truth.consistency(arrays.positions, arrays.covariances);
  return figures;
}

QualityFigures Truth::figures(const SurfaceMesh& surface,
                              std::span<const FusedPoint> points) const {
  QualityFigures figures = quality_figures(truth_, surface, points, tolerance_, visible_);
  const auto visible = std::count(visible_.begin(), visible_.end(), 1);
  if (visible > 0) {
    figures.covered_area =
        figures.coverage_visible * static_cast<double>(visible) * area_per_sample_;
  }
  return figures;
}

}  // namespace viewgain
