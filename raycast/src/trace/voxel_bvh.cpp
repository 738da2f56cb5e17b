// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "voxel_bvh.hpp"

#include "scene_tracing.hpp"

namespace viewgain::detail {
namespace {

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

}  // namespace

ScenePtr build_bvh(const SceneData& data, const TraceKernels& kernels, float margin) {
  RTCDevice device = shared_device(kernels.isa);
  ScenePtr bvh(rtcNewScene(device));
  rtcSetSceneBuildQuality(bvh.get(), RTC_BUILD_QUALITY_HIGH);
  BoundsQuestion leaves{data.boxes.data(), margin};
  BoundsQuestion others{data.boxes.data() + data.leaf_count, margin};
  attach_boxes(device, bvh.get(), kLeafGeometry, data.leaf_count, leaves, kernels.intersect_leaf);
  attach_boxes(device, bvh.get(), kBoxGeometry, data.boxes.size() - data.leaf_count, others,
               kernels.intersect_box);
  commit_scene(device, bvh.get(), "building the voxel scene");
  return bvh;
}

RTCScene SceneTracing::bvh(int margin_level) const {
  Bvh& bvh = bvhs_.at(static_cast<std::size_t>(margin_level));
  std::call_once(bvh.once, [&] { bvh.scene = build_bvh(data_, kernels, margin_of(margin_level)); });
  return bvh.scene.get();
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
