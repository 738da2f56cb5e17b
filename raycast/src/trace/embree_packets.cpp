// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What Embree calls: packets of a tile's rays, and the primitives that they come to. Compiled once
// for each instruction set.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/embree_packets.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
//
#include <hwy/highway.h>

#include "leaf_walk-inl.hpp"
#include "viewgain/support/isa_dispatch.hpp"
#include "voxel_bvh.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// What a packet's callbacks need to know; the tile's lanes [lane0, lane0 + kWidth) are the
// packet's.
struct PacketQuery : RayQuery {
  PacketQuery() : RayQuery(true) {}
  const SceneData* scene = nullptr;
  const PoseFrame* frame = nullptr;
  RayTile* tile = nullptr;
  int lane0 = 0;
};

// Embree's callback. Almost always the packet is the one that was sent, N = kWidth with lanes in
// order; else each ray is looked up by the lane in its id and goes through the same kernel alone.
template <typename Kernel>
HWY_INLINE void intersect(const RTCIntersectFunctionNArguments* args, std::uint32_t primitive,
                          Kernel kernel) {
  const PacketQuery& query = query_of<PacketQuery>(args);
  const Slabs slabs = slabs_of(query.scene->boxes[primitive], *query.frame);
  RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* hit = RTCRayHitN_HitN(args->rayhit, args->N);
  const bool as_sent =
      args->N == static_cast<unsigned>(kWidth) &&
      hn::AllTrue(du, hn::Eq(hn::LoadU(du, &RTCRayN_id(rays, args->N, 0)), hn::Iota(du, 0U)));
  if (as_sent) {
    float* tfar = &RTCRayN_tfar(rays, args->N, 0);
    VF range = hn::LoadU(df, tfar);
    const MF active = hn::RebindMask(df, hn::Ne(hn::LoadU(di, args->valid), hn::Zero(di)));
    const MF hits = meet(*query.scene, *query.frame, *query.tile, query.lane0, primitive, slabs,
                         active, range, kernel);
    if (hn::AllFalse(df, hits)) return;
    hn::StoreU(range, df, tfar);
    hn::BlendedStore(hn::Set(du, args->geomID), hn::RebindMask(du, hits), du,
                     &RTCHitN_geomID(hit, args->N, 0));
    return;
  }
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const unsigned lane = RTCRayN_id(rays, args->N, i);
    VF range = hn::Set(df, RTCRayN_tfar(rays, args->N, i));
    const MF active = hn::RebindMask(df, hn::Eq(hn::Iota(du, 0U), hn::Set(du, lane)));
    const MF hits = meet(*query.scene, *query.frame, *query.tile, query.lane0, primitive, slabs,
                         active, range, kernel);
    if (hn::AllFalse(df, hits)) continue;
    HWY_ALIGN float ranges[kWidth];
    hn::Store(range, df, ranges);
    RTCRayN_tfar(rays, args->N, i) = ranges[lane];
    RTCHitN_geomID(hit, args->N, i) = args->geomID;
  }
}

void intersect_leaf(const RTCIntersectFunctionNArguments* args) {
  intersect(args, args->primID,
            [](auto&&... a) HWY_ATTR { return walk_leaf(static_cast<decltype(a)>(a)...); });
}

void intersect_box(const RTCIntersectFunctionNArguments* args) {
  const PacketQuery& query = query_of<PacketQuery>(args);
  intersect(args, static_cast<std::uint32_t>(query.scene->leaf_count) + args->primID,
            [](auto&&... a) HWY_ATTR { return enter_box(static_cast<decltype(a)>(a)...); });
}

#if HWY_TARGET == HWY_AVX3
using Packet = RTCRayHit16;
constexpr auto intersect_packet = intersect16;
#elif HWY_TARGET == HWY_AVX2
using Packet = RTCRayHit8;
constexpr auto intersect_packet = intersect8;
#else
using Packet = RTCRayHit4;
constexpr auto intersect_packet = intersect4;
#endif
static_assert(sizeof(Packet::ray.tfar) == kWidth * sizeof(float));

void trace(const SceneData& scene, RTCScene bvh, const PoseFrame& frame, RayTile& out) {
  PacketQuery query;
  query.scene = &scene;
  query.frame = &frame;
  query.tile = &out;
  const VU none = hn::Set(du, RTC_INVALID_GEOMETRY_ID);
  for (int lane0 = 0; lane0 < kTileRays; lane0 += kWidth) {
    query.lane0 = lane0;
    Packet packet;
    alignas(64) int valid[kWidth];
    const auto usable = hn::RebindMask(du, mask_of(out.valid >> lane0));
    hn::Store(hn::BitCast(di, hn::VecFromMask(du, usable)), di, valid);
    hn::Store(hn::Set(df, frame.origin[0]), df, packet.ray.org_x);
    hn::Store(hn::Set(df, frame.origin[1]), df, packet.ray.org_y);
    hn::Store(hn::Set(df, frame.origin[2]), df, packet.ray.org_z);
    hn::Store(hn::Load(df, out.dx + lane0), df, packet.ray.dir_x);
    hn::Store(hn::Load(df, out.dy + lane0), df, packet.ray.dir_y);
    hn::Store(hn::Load(df, out.dz + lane0), df, packet.ray.dir_z);
    hn::Store(hn::Set(df, frame.min_range), df, packet.ray.tnear);
    hn::Store(hn::Load(df, out.range + lane0), df, packet.ray.tfar);
    hn::Store(hn::Zero(df), df, packet.ray.time);
    hn::Store(hn::Set(du, 0xFFFFFFFFU), du, packet.ray.mask);
    hn::Store(hn::Iota(du, 0U), du, packet.ray.id);
    hn::Store(hn::Zero(du), du, packet.ray.flags);
    hn::Store(none, du, packet.hit.geomID);
    hn::Store(none, du, packet.hit.instID[0]);
    intersect_packet(valid, bvh, &packet, &query);

    const auto in_voxel = hn::And(usable, hn::Ne(hn::Load(du, packet.hit.geomID), none));
    hn::BlendedStore(hn::Load(df, packet.ray.tfar), hn::RebindMask(df, in_voxel), df,
                     out.range + lane0);
    out.hit |= bits_of(hn::RebindMask(df, in_voxel)) << lane0;
  }
}

}  // namespace

const PacketKernels& kernels() {
  static const PacketKernels table{kWidth, intersect_leaf, intersect_box, trace};
  return table;
}

}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewgain::detail {

const PacketKernels& packet_kernels(Isa isa) { return VIEWGAIN_OF_ISA(isa, kernels)(); }

}  // namespace viewgain::detail
#endif
