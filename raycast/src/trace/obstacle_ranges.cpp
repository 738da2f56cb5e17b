// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "obstacle_ranges.hpp"

#include "embree_compat.hpp"

namespace viewgain::detail {
namespace {

// In packets of so many rays; those without any of the lanes are left out.
template <typename Packet, auto kIntersect>
std::uint32_t cut(RTCScene obstacles, const PoseFrame& frame, const RayTile& rays,
                  std::uint32_t lanes, float* far) {
  constexpr int kRays = sizeof(Packet::ray.tfar) / sizeof(float);
  std::uint32_t met = 0;
  for (int first = 0; first < kTileRays; first += kRays) {
    if ((lanes >> first & ((1U << kRays) - 1U)) == 0) continue;
    RayQuery query(true);
    Packet packet;
    alignas(64) int valid[kRays];
    for (int i = 0; i < kRays; ++i) {
      const int lane = first + i;
      valid[i] = (lanes >> lane & 1U) != 0 ? -1 : 0;
      packet.ray.org_x[i] = frame.origin[0];
      packet.ray.org_y[i] = frame.origin[1];
      packet.ray.org_z[i] = frame.origin[2];
      packet.ray.dir_x[i] = rays.dx[lane];
      packet.ray.dir_y[i] = rays.dy[lane];
      packet.ray.dir_z[i] = rays.dz[lane];
      packet.ray.tnear[i] = 0;
      packet.ray.tfar[i] = far[lane];
      packet.ray.time[i] = 0;
      packet.ray.mask[i] = 0xFFFFFFFFU;
      packet.ray.id[i] = static_cast<unsigned>(lane);
      packet.ray.flags[i] = 0;
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    kIntersect(valid, obstacles, &packet, &query);
    for (int i = 0; i < kRays; ++i) {
      if (valid[i] == 0 || packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
      far[first + i] = packet.ray.tfar[i];
      met |= 1U << (first + i);
    }
  }
  return met;
}

}  // namespace

std::uint32_t cut_at_obstacles(const ObstacleScene& obstacles, const PoseFrame& frame,
                               const RayTile& rays, std::uint32_t lanes, float* far) {
  // Widths other than the instruction set's own are slower in Embree.
  switch (obstacles.isa()) {
    case Isa::avx512:
      return cut<RTCRayHit16, intersect16>(obstacles.bvh(), frame, rays, lanes, far);
    case Isa::avx2:
      return cut<RTCRayHit8, intersect8>(obstacles.bvh(), frame, rays, lanes, far);
    default:
      return cut<RTCRayHit4, intersect4>(obstacles.bvh(), frame, rays, lanes, far);
  }
}

}  // namespace viewgain::detail
