// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "truth.hpp"

#include <cmath>
#include <numbers>

#include "viewgain/core/generators.hpp"
#include "viewgain/core/thread_pool.hpp"

namespace viewgain::app {
namespace {

constexpr std::size_t kPoses = 2562;
const double kMinCosine = std::cos(80.0 * std::numbers::pi / 180);
constexpr double kNear = 5e-3, kNearer = 2.5e-3;  // [m]

std::vector<Pose> looking_poses(const VisibilityConfig& config) {
  std::vector<Pose> poses = sphere_poses(kPoses, config.distance, config.center);
  std::erase_if(poses, [&](const Pose& pose) {
    return !config.reach.contains(pose) ||
           (config.support_plane && pose.translation().z() <= *config.support_plane);
  });
  poses.push_back(config.start);
  // Reach by a list of poses: a lattice all but never meets it.
  poses.insert(poses.end(), config.reach.poses.begin(), config.reach.poses.end());
  return poses;
}

bool sees(const SurfaceScene& scene, const Sensor& sensor, const Pose& T_world_camera,
          const SurfaceSample& sample) {
  const Eigen::Vector3d eye = T_world_camera.translation();
  const Eigen::Vector3d sight = sample.position - eye;
  const double range = sight.norm();
  if (!(range > sensor.min_range && range < sensor.max_range)) return false;
  if (std::abs(sight.dot(sample.normal)) < kMinCosine * range) return false;
  const Eigen::Vector3d p_camera = T_world_camera.inverse() * sample.position;
  if (!(p_camera.z() > 0)) return false;
  const Eigen::Vector2d pixel = sensor.camera.project(p_camera);
  if (!(pixel.x() >= -0.5 && pixel.x() <= sensor.camera.width - 0.5 && pixel.y() >= -0.5 &&
        pixel.y() <= sensor.camera.height - 0.5)) {
    return false;
  }
  const double slack = 1e-4 * range;  // the sample's own triangle does not hide it
  return scene.intersect(eye, sight / range, range).range >= range - slack;
}

}  // namespace

Truth::Truth(std::shared_ptr<const SurfaceScene> scene, const Sensor& sensor,
             const VisibilityConfig& config, const ExecConfig& exec)
    : truth_(scene->mesh()) {
  const std::vector<Pose> poses = looking_poses(config);
  const std::vector<SurfaceSample>& samples = truth_.samples();
  visible_.resize(samples.size());
  ThreadPool pool(exec.num_threads);
  pool.for_each_chunk(samples.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (const Pose& pose : poses) {
        if (!sees(*scene, sensor, pose, samples[i])) continue;
        visible_[i] = 1;
        break;
      }
    }
  });
}

QualityFigures Truth::figures(const SurfaceMesh& surface,
                              std::span<const FusedPoint> points) const {
  std::vector<std::array<double, 3>> positions;
  std::vector<SymmetricMatrix3> covariances;
  positions.reserve(points.size());
  covariances.reserve(points.size());
  for (const FusedPoint& point : points) {
    positions.push_back(point.position);
    covariances.push_back(point.covariance);
  }
  const std::vector<double> distances = truth_.distances_to(surface.vertices);
  QualityFigures figures;
  figures.coverage = coverage(distances, kNear);
  figures.coverage_visible = coverage(distances, kNear, visible_);
  figures.coverage_2_5mm = coverage(distances, kNearer);
  figures.surface_error = truth_.error(surface.vertices);
  figures.points_error = truth_.error(positions);
  figures.consistency = truth_.consistency(positions, covariances);
  return figures;
}

}  // namespace viewgain::app
