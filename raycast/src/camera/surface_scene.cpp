// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/surface_scene.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "trace/triangle_scene.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain {
namespace {

using detail::TriangleRays;
using Eigen::Vector3d;

constexpr std::size_t kAtOnce = TriangleRays::kCount;

Vector3d corner(const TriangleMesh& mesh, std::uint32_t index) {
  return Vector3d(mesh.vertices[index].data());
}

void check(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) refuse("the mesh has no triangles");
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!corner(mesh, i).cast<float>().allFinite()) {
      refuse("the mesh has a vertex that is not finite");
    }
  }
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) {
      if (index < mesh.vertices.size()) continue;
      refuse("a triangle refers to vertex " + std::to_string(index) + ", but the mesh has " +
             std::to_string(mesh.vertices.size()) + " vertices");
    }
  }
}

// Embree aborts the program for a ray from farther away, or with a NaN.
bool is_traceable(const Vector3d& origin, const SurfaceScene::Ray& ray) {
  constexpr double kFarthest = 1e18;  // [m]
  return (origin.array().abs() <= kFarthest).all() &&
         (ray.direction.array().abs() <= kFarthest).all() && !std::isnan(ray.max_range);
}

}  // namespace

struct SurfaceScene::Impl {
  TriangleMesh mesh;
  Vector3d middle;                // rays and triangles are relative to it
  std::vector<Vector3d> normals;  // one per triangle
  std::optional<detail::TriangleScene> scene;

  // Loads at most kAtOnce rays. Returns the lanes to trace.
  std::uint32_t load(std::span<const SurfaceScene::Ray> rays, TriangleRays& packet) const {
    std::uint32_t lanes = 0;
    for (std::size_t i = 0; i < kAtOnce; ++i) {
      // Unused lanes repeat a ray.
      const SurfaceScene::Ray& ray = rays[std::min(i, rays.size() - 1)];
      const Vector3d origin = ray.origin - middle;
      if (i < rays.size() && is_traceable(origin, ray)) lanes |= 1U << i;
      packet.ox[i] = static_cast<float>(origin.x());
      packet.oy[i] = static_cast<float>(origin.y());
      packet.oz[i] = static_cast<float>(origin.z());
      packet.dx[i] = static_cast<float>(ray.direction.x());
      packet.dy[i] = static_cast<float>(ray.direction.y());
      packet.dz[i] = static_cast<float>(ray.direction.z());
      packet.far[i] = static_cast<float>(ray.max_range);
    }
    return lanes;
  }
};

SurfaceScene::SurfaceScene(TriangleMesh mesh, const ExecConfig& exec)
    : impl_(std::make_unique<Impl>()) {
  check(mesh);
  (void)thread_count(exec.num_threads);
  Eigen::AlignedBox3d box;
  std::vector<unsigned> indices;
  indices.reserve(3 * mesh.triangles.size());
  impl_->normals.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    const Vector3d a = corner(mesh, t[0]), b = corner(mesh, t[1]), c = corner(mesh, t[2]);
    box.extend(a).extend(b).extend(c);
    indices.insert(indices.end(), t.begin(), t.end());
    impl_->normals.push_back((b - a).cross(c - a).normalized());
  }
  impl_->middle = box.center();
  std::vector<float> vertices;
  vertices.reserve(3 * mesh.vertices.size());
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3f p = (corner(mesh, i) - impl_->middle).cast<float>();
    vertices.insert(vertices.end(), p.begin(), p.end());
  }
  impl_->scene.emplace(select_isa(), vertices, indices, "building the surface scene");
  impl_->mesh = std::move(mesh);
}

SurfaceScene::~SurfaceScene() = default;
SurfaceScene::SurfaceScene(SurfaceScene&&) noexcept = default;
SurfaceScene& SurfaceScene::operator=(SurfaceScene&&) noexcept = default;

void SurfaceScene::intersect(std::span<const SurfaceScene::Ray> rays,
                             std::span<SurfaceScene::Hit> hits) const {
  TriangleRays packet;
  for (std::size_t first = 0; first < rays.size(); first += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, rays.size() - first);
    const std::uint32_t lanes = impl_->load(rays.subspan(first, count), packet);
    const std::uint32_t met = impl_->scene->meet(packet, lanes);
    for (std::size_t i = 0; i < count; ++i) {
      SurfaceScene::Hit& hit = hits[first + i];
      hit = {};
      if ((met >> i & 1U) == 0) continue;
      hit.range = static_cast<double>(packet.far[i]);
      hit.triangle = packet.triangle[i];
      hit.normal = impl_->normals[hit.triangle];
    }
  }
}

SurfaceScene::Hit SurfaceScene::intersect(const SurfaceScene::Ray& ray) const {
  SurfaceScene::Hit hit;
  intersect(std::span(&ray, 1), std::span(&hit, 1));
  return hit;
}

void SurfaceScene::block(std::span<const SurfaceScene::Ray> rays, std::span<bool> blocked) const {
  TriangleRays packet;
  for (std::size_t first = 0; first < rays.size(); first += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, rays.size() - first);
    const std::uint32_t lanes = impl_->load(rays.subspan(first, count), packet);
    const std::uint32_t met = impl_->scene->block(packet, lanes);
    for (std::size_t i = 0; i < count; ++i) blocked[first + i] = (met >> i & 1U) != 0;
  }
}

const TriangleMesh& SurfaceScene::mesh() const noexcept { return impl_->mesh; }

}  // namespace viewgain
