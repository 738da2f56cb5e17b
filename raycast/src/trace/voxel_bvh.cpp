// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "voxel_bvh.hpp"

#include "scene/scene_data.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::detail {
namespace {

// Embree's own arithmetic may put a ray on the wrong side of a box by a few ulps of the distance;
// boxes that are larger by this much [voxels] are met all the same. The kernels decide exactly.
constexpr float kBoundsMargin = 0.02F;

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

void attach_boxes(const VoxelScene::Data& data, const VoxelBvh& bvh, unsigned id, std::size_t first,
                  std::size_t count, RTCIntersectFunctionN intersect) {
  RTCGeometry geometry = rtcNewGeometry(bvh.device.get(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(count));
  rtcSetGeometryUserData(geometry, const_cast<PrimitiveBox*>(data.boxes.data() + first));
  rtcSetGeometryBoundsFunction(
      geometry,
      [](const RTCBoundsFunctionArguments* args) {
        const PrimitiveBox& box =
            static_cast<const PrimitiveBox*>(args->geometryUserPtr)[args->primID];
        RTCBounds& out = *args->bounds_o;
        out.lower_x = box.min[0] - kBoundsMargin;
        out.lower_y = box.min[1] - kBoundsMargin;
        out.lower_z = box.min[2] - kBoundsMargin;
        out.upper_x = box.max[0] + kBoundsMargin;
        out.upper_y = box.max[1] + kBoundsMargin;
        out.upper_z = box.max[2] + kBoundsMargin;
      },
      nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect);
  rtcSetGeometryMask(geometry, 0xFFFFFFFFU);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(bvh.scene.get(), geometry, id);
  rtcReleaseGeometry(geometry);
}

// Obstacles in the scene's coordinates: voxels from the workspace's lowest corner.
void attach_obstacles(const VoxelScene::Data& data, const VoxelBvh& bvh) {
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
  attach_triangles(bvh.device.get(), bvh.scene.get(), kObstacleGeometry, vertices.data(),
                   vertices.size() / 3, indices.data(), indices.size() / 3);
}

}  // namespace

Isa packet_isa() {
  const Isa best = select_isa();
  for (const Isa isa : supported_isas()) {
    if (isa > best) continue;
    const DevicePtr device = make_device(isa, 1);
    const int width = trace_kernels(isa).width;
    const RTCDeviceProperty native = width == 16  ? RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED
                                     : width == 8 ? RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED
                                                  : RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED;
    if (rtcGetDeviceProperty(device.get(), native) != 0) return isa;
  }
  throw Error(ErrorCode::backend, "this build of Embree has no ray packets");
}

VoxelBvh build_bvh(const VoxelScene::Data& data) {
  VoxelBvh bvh;
  bvh.device = make_device(data.kernels->isa, data.build_threads);
  bvh.scene.reset(rtcNewScene(bvh.device.get()));
  rtcSetSceneBuildQuality(bvh.scene.get(), RTC_BUILD_QUALITY_HIGH);
  // Without it a ray may slip between two triangles that share an edge. Voxels do not need it.
  if (data.has_obstacles) rtcSetSceneFlags(bvh.scene.get(), RTC_SCENE_FLAG_ROBUST);
  attach_boxes(data, bvh, kLeafGeometry, 0, data.leaf_count, data.kernels->intersect_leaf);
  attach_boxes(data, bvh, kBoxGeometry, data.leaf_count, data.boxes.size() - data.leaf_count,
               data.kernels->intersect_box);
  attach_obstacles(data, bvh);
  rtcCommitScene(bvh.scene.get());
  check_device(bvh.device.get(), "building the voxel scene");
  return bvh;
}

}  // namespace viewgain::detail
