// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "triangle_scene.hpp"

#include <algorithm>

#include "voxel_bvh.hpp"

namespace viewgain::detail {
namespace {

template <typename Rays>
constexpr int kWidth = sizeof(Rays::tfar) / sizeof(float);

// Fills a packet with the rays from `first` on; those without any of the lanes are left out.
template <typename Rays>
bool load(const TriangleRays& from, int first, std::uint32_t lanes, Rays& rays, int* valid) {
  constexpr int kRays = kWidth<Rays>;
  if ((lanes >> first & ((1U << kRays) - 1U)) == 0) return false;
  for (int i = 0; i < kRays; ++i) valid[i] = (lanes >> (first + i) & 1U) != 0 ? -1 : 0;
  const auto copy = [first](const float* source, float* target) {
    std::copy_n(source + first, kRays, target);
  };
  copy(from.ox, rays.org_x), copy(from.oy, rays.org_y), copy(from.oz, rays.org_z);
  copy(from.dx, rays.dir_x), copy(from.dy, rays.dir_y), copy(from.dz, rays.dir_z);
  copy(from.far, rays.tfar);
  std::fill_n(rays.tnear, kRays, 0.0F);
  std::fill_n(rays.time, kRays, 0.0F);
  std::fill_n(rays.mask, kRays, 0xFFFFFFFFU);
  std::fill_n(rays.id, kRays, 0U);
  std::fill_n(rays.flags, kRays, 0U);
  return true;
}

template <typename Packet, auto kIntersect>
std::uint32_t meet_in(RTCScene scene, TriangleRays& rays, std::uint32_t lanes) {
  constexpr int kRays = kWidth<decltype(Packet::ray)>;
  std::uint32_t met = 0;
  Packet packet;
  alignas(64) int valid[kRays];
  for (int first = 0; first < TriangleRays::kCount; first += kRays) {
    if (!load(rays, first, lanes, packet.ray, valid)) continue;
    std::fill_n(packet.hit.geomID, kRays, RTC_INVALID_GEOMETRY_ID);
    std::fill_n(packet.hit.instID[0], kRays, RTC_INVALID_GEOMETRY_ID);
    RayQuery query(true);
    kIntersect(valid, scene, &packet, &query);
    for (int i = 0; i < kRays; ++i) {
      if (valid[i] == 0 || packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
      rays.far[first + i] = packet.ray.tfar[i];
      rays.triangle[first + i] = packet.hit.primID[i];
      met |= 1U << (first + i);
    }
  }
  return met;
}

template <typename Packet, auto kOccluded>
std::uint32_t block_in(RTCScene scene, const TriangleRays& rays, std::uint32_t lanes) {
  constexpr int kRays = kWidth<Packet>;
  std::uint32_t blocked = 0;
  Packet packet;
  alignas(64) int valid[kRays];
  for (int first = 0; first < TriangleRays::kCount; first += kRays) {
    if (!load(rays, first, lanes, packet, valid)) continue;
    RayQuery query(false);
    kOccluded(valid, scene, &packet, &query);
    for (int i = 0; i < kRays; ++i) {
      // Embree sets the end of a ray that meets something to minus infinity.
      if (valid[i] != 0 && packet.tfar[i] < 0) blocked |= 1U << (first + i);
    }
  }
  return blocked;
}

}  // namespace

TriangleScene::TriangleScene(Isa isa, std::span<const float> vertices,
                             std::span<const unsigned> indices, const std::string& what)
    : isa_(packet_isa(isa)) {
  RTCDevice device = shared_device(isa_);
  bvh_.reset(rtcNewScene(device));
  rtcSetSceneBuildQuality(bvh_.get(), RTC_BUILD_QUALITY_HIGH);
  // Without it a ray may slip between two triangles that share an edge. Of rays at a corner that
  // triangles share some 3 in 1,000 still do.
  rtcSetSceneFlags(bvh_.get(), RTC_SCENE_FLAG_ROBUST);
  if (!indices.empty()) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* v = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                          RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                          vertices.size() / 3));
    auto* t = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                             RTC_FORMAT_UINT3, 3 * sizeof(unsigned),
                                                             indices.size() / 3));
    if (v != nullptr && t != nullptr) {
      std::copy(vertices.begin(), vertices.end(), v);
      std::copy(indices.begin(), indices.end(), t);
      rtcSetGeometryMask(geometry, 0xFFFFFFFFU);
      rtcCommitGeometry(geometry);
      rtcAttachGeometry(bvh_.get(), geometry);
    }
    rtcReleaseGeometry(geometry);
    check_device(device, what);
  }
  commit_scene(device, bvh_, indices.size() / 3, what);
}

std::uint32_t TriangleScene::meet(TriangleRays& rays, std::uint32_t lanes) const {
  // Widths other than the instruction set's own are slower in Embree.
  switch (isa_) {
    case Isa::avx512:
      return meet_in<RTCRayHit16, intersect16>(bvh_.get(), rays, lanes);
    case Isa::avx2:
      return meet_in<RTCRayHit8, intersect8>(bvh_.get(), rays, lanes);
    default:
      return meet_in<RTCRayHit4, intersect4>(bvh_.get(), rays, lanes);
  }
}

std::uint32_t TriangleScene::block(const TriangleRays& rays, std::uint32_t lanes) const {
  switch (isa_) {
    case Isa::avx512:
      return block_in<RTCRay16, occluded16>(bvh_.get(), rays, lanes);
    case Isa::avx2:
      return block_in<RTCRay8, occluded8>(bvh_.get(), rays, lanes);
    default:
      return block_in<RTCRay4, occluded4>(bvh_.get(), rays, lanes);
  }
}

}  // namespace viewgain::detail
