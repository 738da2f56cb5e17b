// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/obstacle_view.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "scene/gather_scene.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/shared_rays.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain {
namespace {

constexpr std::size_t kRayChunk = 256;

}  // namespace

TriangleMesh mesh_of(const Obstacles& obstacles) {
  detail::check_obstacles(obstacles);
  return detail::join_obstacles(obstacles);
}

struct ObstacleView::Impl {
  Sensor sensor;
  std::shared_ptr<const std::vector<Eigen::Vector3d>> rays;
  std::optional<SurfaceScene> scene;
  mutable ThreadPool pool;

  Impl(const Sensor& of, int threads) : sensor(of), rays(shared_rays(of.camera)), pool(threads) {}
};

ObstacleView::ObstacleView(const Obstacles& obstacles, const Sensor& sensor,
                           const ExecConfig& exec) {
  sensor.validate();
  impl_ = std::make_unique<Impl>(sensor, exec.num_threads);
  TriangleMesh mesh = mesh_of(obstacles);
  if (!mesh.triangles.empty()) impl_->scene.emplace(std::move(mesh), exec);
}
ObstacleView::~ObstacleView() = default;
ObstacleView::ObstacleView(ObstacleView&&) noexcept = default;
ObstacleView& ObstacleView::operator=(ObstacleView&&) noexcept = default;

void ObstacleView::mark(DepthFrame& frame, const Pose& T_world_camera) const {
  const Impl& m = *impl_;
  frame.known_depth.clear();
  check_frame_size(frame, m.sensor.camera);
  const std::optional<Pose> T_rigid = rigid_pose(T_world_camera);
  if (!T_rigid) refuse("the frame's pose is not a rigid transform");
  if (!m.scene) return;
  const std::vector<Eigen::Vector3d>& table = *m.rays;
  frame.known_depth.assign(table.size(), DepthFrame::kOutOfRange);
  const Eigen::Matrix3d R_world_camera = T_rigid->rotation();
  const Eigen::Vector3d eye = T_rigid->translation();
  m.pool.for_each_chunk(table.size(), kRayChunk, [&](std::size_t begin, std::size_t end) {
    std::array<SurfaceScene::Ray, kRayChunk> rays;
    std::array<SurfaceScene::Hit, kRayChunk> hits;
    std::array<std::size_t, kRayChunk> pixels;
    std::size_t count = 0;
    for (std::size_t i = begin; i < end; ++i) {
      if (!table[i].allFinite()) continue;
      rays[count] = {eye, R_world_camera * table[i] / table[i].norm()};
      pixels[count++] = i;
    }
    m.scene->intersect(std::span(rays).first(count), hits);
    for (std::size_t k = 0; k < count; ++k) {
      const SurfaceScene::Hit& hit = hits[k];
      if (!std::isfinite(hit.range)) continue;
      const double cosine = std::abs(hit.normal.dot(rays[k].direction));
      // Along the ray. At grazing incidence, any reading before the obstacle may show it.
      const double sigma = sigma_along_normal(m.sensor.sigmas(hit.range, cosine), cosine) /
                           std::max(cosine, kMinCosIncidence);
      const double from = std::max(0.0, hit.range - kKnownSigmas * sigma);
      const std::size_t i = pixels[k];
      frame.known_depth[i] = static_cast<float>(from / table[i].norm());  // from range to depth
    }
  });
}

}  // namespace viewgain
