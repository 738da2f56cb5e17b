// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "voxel_bvh.hpp"

#include "scene_tracing.hpp"

namespace viewgain::detail {
namespace {

// A box's twelve triangles, added to a mesh.
void append_box(const Box& box, TriangleMesh& mesh) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  for (unsigned corner = 0; corner < 8; ++corner) {
    mesh.vertices.push_back({(corner & 1U) != 0 ? box.max[0] : box.min[0],
                             (corner & 2U) != 0 ? box.max[1] : box.min[1],
                             (corner & 4U) != 0 ? box.max[2] : box.min[2]});
  }
  constexpr std::array<std::array<std::uint32_t, 4>, 6> kFaces{
      {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}}};
  for (const auto& f : kFaces) {
    mesh.triangles.push_back({base + f[0], base + f[1], base + f[2]});
    mesh.triangles.push_back({base + f[0], base + f[2], base + f[3]});
  }
}

// What Embree asks the bounds of.
struct BoundsQuestion {
  const PrimitiveBox* boxes;
  float margin;
};

void attach_boxes(RTCDevice device, RTCScene scene, unsigned id, std::size_t count,
                  BoundsQuestion& question, RTCIntersectFunctionN intersect) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(count));
  rtcSetGeometryUserData(geometry, &question);
  rtcSetGeometryBoundsFunction(
      geometry,
      [](const RTCBoundsFunctionArguments* args) {
        const auto& [boxes, margin] = *static_cast<const BoundsQuestion*>(args->geometryUserPtr);
        const PrimitiveBox& box = boxes[args->primID];
        RTCBounds& out = *args->bounds_o;
        out.lower_x = box.min[0] - margin;
        out.lower_y = box.min[1] - margin;
        out.lower_z = box.min[2] - margin;
        out.upper_x = box.max[0] + margin;
        out.upper_y = box.max[1] + margin;
        out.upper_z = box.max[2] + margin;
      },
      nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect);
  rtcSetGeometryMask(geometry, 0xFFFFFFFFU);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
}

// Obstacles in the scene's coordinates: voxels from the workspace's lowest corner.
void attach_obstacles(const SceneData& data, RTCDevice device, RTCScene scene) {
  const Obstacles& obstacles = *data.obstacles;
  const Pose T_grid_world = data.snapshot.T_world_grid.inverse();
  const Eigen::Vector3d base(data.snapshot.min_index.x, data.snapshot.min_index.y,
                             data.snapshot.min_index.z);
  TriangleMesh boxes;
  for (const Box& box : obstacles.boxes) append_box(box, boxes);
  std::vector<float> vertices;
  std::vector<unsigned> indices;
  const auto append = [&](const TriangleMesh& mesh) {
    const auto first = static_cast<std::uint32_t>(vertices.size() / 3);
    for (const auto& v : mesh.vertices) {
      const Eigen::Vector3d p_world(v[0], v[1], v[2]);
      const Eigen::Vector3d p = (T_grid_world * p_world) / data.snapshot.voxel_size - base;
      for (const double c : p) vertices.push_back(static_cast<float>(c));
    }
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t index : triangle) indices.push_back(first + index);
    }
  };
  append(boxes);
  for (const TriangleMesh& mesh : obstacles.meshes) append(mesh);
  if (indices.empty()) return;
  attach_triangles(device, scene, kObstacleGeometry, vertices.data(), vertices.size() / 3,
                   indices.data(), indices.size() / 3);
}

}  // namespace

ScenePtr build_bvh(const SceneData& data, const TraceKernels& kernels, float margin) {
  RTCDevice device = shared_device(kernels.isa);
  ScenePtr bvh(rtcNewScene(device));
  rtcSetSceneBuildQuality(bvh.get(), RTC_BUILD_QUALITY_HIGH);
  // Without it a ray may slip between two triangles that share an edge. Voxels do not need it.
  if (data.has_obstacles) rtcSetSceneFlags(bvh.get(), RTC_SCENE_FLAG_ROBUST);
  BoundsQuestion leaves{data.boxes.data(), margin};
  BoundsQuestion others{data.boxes.data() + data.leaf_count, margin};
  attach_boxes(device, bvh.get(), kLeafGeometry, data.leaf_count, leaves, kernels.intersect_leaf);
  attach_boxes(device, bvh.get(), kBoxGeometry, data.boxes.size() - data.leaf_count, others,
               kernels.intersect_box);
  attach_obstacles(data, device, bvh.get());
  commit_scene(device, bvh.get(), "building the voxel scene");
  return bvh;
}

ScenePtr build_obstacle_bvh(const SceneData& data, const TraceKernels& kernels) {
  RTCDevice device = shared_device(kernels.isa);
  ScenePtr bvh(rtcNewScene(device));
  rtcSetSceneBuildQuality(bvh.get(), RTC_BUILD_QUALITY_HIGH);
  rtcSetSceneFlags(bvh.get(), RTC_SCENE_FLAG_ROBUST);
  attach_obstacles(data, device, bvh.get());
  commit_scene(device, bvh.get(), "building the obstacles");
  return bvh;
}

RTCScene SceneTracing::bvh(int margin_level) const {
  Bvh& bvh = bvhs_.at(static_cast<std::size_t>(margin_level));
  std::call_once(bvh.once, [&] { bvh.scene = build_bvh(data_, kernels, margin_of(margin_level)); });
  return bvh.scene.get();
}

RTCScene SceneTracing::obstacle_bvh() const {
  std::call_once(obstacles_.once, [&] { obstacles_.scene = build_obstacle_bvh(data_, kernels); });
  return obstacles_.scene.get();
}

const HazardField& SceneTracing::hazard() const {
  std::call_once(hazard_once_, [&] { hazard_.emplace(data_.snapshot, *data_.hazard); });
  return *hazard_;
}

const BrickTable& SceneTracing::bricks() const {
  std::call_once(bricks_once_, [&] { bricks_.emplace(data_.snapshot, hazard()); });
  return *bricks_;
}

}  // namespace viewgain::detail
