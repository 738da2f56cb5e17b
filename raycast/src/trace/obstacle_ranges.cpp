// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "obstacle_ranges.hpp"

namespace viewgain::detail {

std::uint32_t cut_at_obstacles(RTCScene obstacles, const PoseFrame& frame, const RayTile& rays,
                               std::uint32_t lanes, float* far) {
  RayQuery query(true);
  RTCRayHit16 packet;
  alignas(64) int valid[kTileRays];
  for (int lane = 0; lane < kTileRays; ++lane) {
    valid[lane] = (lanes >> lane & 1U) != 0 ? -1 : 0;
    packet.ray.org_x[lane] = frame.origin[0];
    packet.ray.org_y[lane] = frame.origin[1];
    packet.ray.org_z[lane] = frame.origin[2];
    packet.ray.dir_x[lane] = rays.dx[lane];
    packet.ray.dir_y[lane] = rays.dy[lane];
    packet.ray.dir_z[lane] = rays.dz[lane];
    packet.ray.tnear[lane] = 0;
    packet.ray.tfar[lane] = far[lane];
    packet.ray.time[lane] = 0;
    packet.ray.mask[lane] = 0xFFFFFFFFU;
    packet.ray.id[lane] = static_cast<unsigned>(lane);
    packet.ray.flags[lane] = 0;
    packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
  }
  intersect16(valid, obstacles, &packet, &query);
  std::uint32_t met = 0;
  for (int lane = 0; lane < kTileRays; ++lane) {
    if (valid[lane] == 0 || packet.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) continue;
    far[lane] = packet.ray.tfar[lane];
    met |= 1U << lane;
  }
  return met;
}

}  // namespace viewgain::detail
