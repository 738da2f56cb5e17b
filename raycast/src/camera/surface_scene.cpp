// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/surface_scene.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <vector>

#include "trace/device.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/thread_pool.hpp"

namespace viewgain {

struct SurfaceScene::Impl {
  TriangleMesh mesh;
  detail::ScenePtr scene;
};

SurfaceScene::SurfaceScene(TriangleMesh mesh, const ExecConfig& exec)
    : impl_(std::make_unique<Impl>()) {
  if (mesh.triangles.empty()) throw Error(ErrorCode::invalid_argument, "the mesh has no triangles");
  std::vector<float> vertices;
  vertices.reserve(3 * mesh.vertices.size());
  for (const auto& vertex : mesh.vertices) {
    for (const double c : vertex) {
      if (!std::isfinite(static_cast<float>(c))) {
        throw Error(ErrorCode::invalid_argument, "the mesh has a vertex that is not finite");
      }
      vertices.push_back(static_cast<float>(c));
    }
  }
  std::vector<unsigned> indices;
  indices.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) {
      if (index >= mesh.vertices.size()) {
        throw Error(ErrorCode::invalid_argument, "a triangle refers to vertex " +
                                                     std::to_string(index) + " of " +
                                                     std::to_string(mesh.vertices.size()));
      }
      indices.push_back(index);
    }
  }
  impl_->mesh = std::move(mesh);
  (void)thread_count(exec.num_threads);
  RTCDevice device = detail::shared_device(select_isa());
  impl_->scene.reset(rtcNewScene(device));
  // Robust: no ray may slip between two triangles that share an edge.
  rtcSetSceneFlags(impl_->scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(impl_->scene.get(), RTC_BUILD_QUALITY_HIGH);
  detail::attach_triangles(device, impl_->scene.get(), 0, vertices.data(), vertices.size() / 3,
                           indices.data(), indices.size() / 3);
  detail::commit_scene(device, impl_->scene.get(), "building the surface scene");
}

SurfaceScene::~SurfaceScene() = default;
SurfaceScene::SurfaceScene(SurfaceScene&&) noexcept = default;
SurfaceScene& SurfaceScene::operator=(SurfaceScene&&) noexcept = default;

SurfaceHit SurfaceScene::intersect(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                   double max_range) const {
  detail::RayQuery query(false);
  RTCRayHit ray{};
  ray.ray.org_x = static_cast<float>(origin.x());
  ray.ray.org_y = static_cast<float>(origin.y());
  ray.ray.org_z = static_cast<float>(origin.z());
  ray.ray.dir_x = static_cast<float>(direction.x());
  ray.ray.dir_y = static_cast<float>(direction.y());
  ray.ray.dir_z = static_cast<float>(direction.z());
  ray.ray.tnear = 0;
  ray.ray.tfar = static_cast<float>(max_range);
  ray.ray.mask = 0xFFFFFFFFU;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  detail::intersect1(impl_->scene.get(), &ray, &query);
  SurfaceHit hit;
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
  hit.range = static_cast<double>(ray.ray.tfar);
  hit.triangle = ray.hit.primID;
  const auto& corners = impl_->mesh.triangles[hit.triangle];
  const auto vertex = [&](std::size_t i) {
    return Eigen::Map<const Eigen::Vector3d>(impl_->mesh.vertices[corners[i]].data());
  };
  hit.normal = (vertex(1) - vertex(0)).cross(vertex(2) - vertex(0)).normalized();
  return hit;
}

const TriangleMesh& SurfaceScene::mesh() const noexcept { return impl_->mesh; }

}  // namespace viewgain
