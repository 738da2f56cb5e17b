// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "voxel_bvh.hpp"

#include <string>

#include "viewgain/core/error.hpp"

namespace viewgain::detail {
namespace {

// Geometry numbers in the Embree scene.
constexpr unsigned kLeafGeometry = 0, kBoxGeometry = 1;

// Has Embree packets of the kernels' width?
bool has_packets(Isa isa) {
  const int width = packet_kernels(isa).width;
  const RTCDeviceProperty native = width == 16  ? RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED
                                   : width == 8 ? RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED
                                                : RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED;
  return rtcGetDeviceProperty(shared_device(isa), native) != 0;
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

}  // namespace

Isa packet_isa(Isa isa) {
  for (const Isa candidate : supported_isas()) {
    if (candidate <= isa && has_packets(candidate)) return candidate;
  }
  throw Error(ErrorCode::backend, "this build of Embree has no ray packets");
}

ScenePtr build_bvh(const SceneData& data, Isa isa, float margin) {
  if (!has_packets(isa)) {
    throw Error(ErrorCode::backend, "this build of Embree has no ray packets for " +
                                        std::string(isa_name(isa)) +
                                        "; use the tracer sweep instead");
  }
  const PacketKernels& kernels = packet_kernels(isa);
  RTCDevice device = shared_device(isa);
  ScenePtr bvh(rtcNewScene(device));
  rtcSetSceneBuildQuality(bvh.get(), RTC_BUILD_QUALITY_HIGH);
  BoundsQuestion leaves{data.boxes.data(), margin};
  BoundsQuestion others{data.boxes.data() + data.leaf_count, margin};
  attach_boxes(device, bvh.get(), kLeafGeometry, data.leaf_count, leaves, kernels.intersect_leaf);
  attach_boxes(device, bvh.get(), kBoxGeometry, data.boxes.size() - data.leaf_count, others,
               kernels.intersect_box);
  commit_scene(device, bvh, data.boxes.size(), "building the voxel scene");
  return bvh;
}

}  // namespace viewgain::detail
