// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What rays meet on their way through unknown voxels: sums of expected area, or lists of voxels.
// Compiled once for each instruction set.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/ordered_walk.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
//
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <span>

#include "area_sink-inl.hpp"
#include "ordered_walk.hpp"
#include "viewgain/support/brick_walk-inl.hpp"
#include "viewgain/support/isa_dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// Writes down each voxel.
class VisitSink {
 public:
  static constexpr bool kCountsVoxels = false;

  [[nodiscard]] static HWY_INLINE MF ends(const VisitFinder::Place& place, MF counts) {
    return VisitFinder::is_in(place, BrickTable::kOccupiedVoxel, counts);
  }

  VisitSink(int lane0, std::vector<VoxelVisit>& out) : lane0_(lane0), out_(out) {}

  HWY_INLINE void step(const VisitFinder&, const Step<VisitFinder::Place>& step) {
    const MF unknown = VisitFinder::is_in(step.place, BrickTable::kUnknownVoxel, step.counts);
    const std::uint32_t wanted = bits_of(hn::Or(step.ends, unknown));
    if (wanted == 0) return;
    HWY_ALIGN float begins[kWidth], ends[kWidth], rates[kWidth];
    HWY_ALIGN std::int32_t xs[kWidth], ys[kWidth], zs[kWidth];
    HWY_ALIGN std::uint32_t states[kWidth];
    hn::Store(step.t, df, begins);
    hn::Store(step.next, df, ends);
    hn::Store(step.place.rate, df, rates);
    hn::Store(step.at.x, di, xs);
    hn::Store(step.at.y, di, ys);
    hn::Store(step.at.z, di, zs);
    hn::Store(step.place.state, du, states);
    for (std::uint32_t left = wanted; left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      out_.push_back({static_cast<std::uint32_t>(lane0_ + i), states[i], xs[i], ys[i], zs[i],
                      begins[i], ends[i], rates[i]});
    }
  }

 private:
  int lane0_;
  std::vector<VoxelVisit>& out_;
};

// Two packets take turns: while one is led on and summed, what the other will read comes into the
// cache.
template <bool kMissed>
void area_of(const BrickTable& table, const WalkLimits& limits, std::span<const WalkTask> tasks,
             const PixelWorth& worth, const float* missed, WalkedTile* out) {
  using Sink = AreaSink<kMissed>;
  using Finder = AreaFinder<kMissed>;
  using Walk = PacketWalk<Finder, Sink>;
  constexpr std::size_t kPackets = kTileRays / kWidth;
  const std::size_t count = tasks.size() * kPackets;
  for (std::size_t i = 0; i < count; i += 2) {
    const bool has_b = i + 1 < count;
    const std::size_t tile_a = i / kPackets, tile_b = has_b ? (i + 1) / kPackets : tile_a;
    const int lane_a = static_cast<int>(i % kPackets) * kWidth,
              lane_b = static_cast<int>((i + 1) % kPackets) * kWidth;
    Sink sink_a(tasks[tile_a].solid_angle + lane_a, worth, missed),
        sink_b(tasks[tile_b].solid_angle + lane_b, worth, missed);
    Walk a{Finder(table)}, b{Finder(table)};
    bool goes_a = a.begin(table, limits, tasks[tile_a], lane_a),
         goes_b = has_b && b.begin(table, limits, tasks[tile_b], lane_b);
    while (goes_a && goes_b) {
      goes_a = a.step(sink_a);
      goes_b = b.step(sink_b);
    }
    while (goes_a) goes_a = a.step(sink_a);
    while (goes_b) goes_b = b.step(sink_b);
    if (lane_a == 0) out[tile_a].occupied = 0;
    sink_a.store(lane_a, out[tile_a]);
    if (!has_b) continue;
    if (lane_b == 0) out[tile_b].occupied = 0;
    sink_b.store(lane_b, out[tile_b]);
  }
}

void area(const BrickTable& table, const WalkLimits& limits, std::span<const WalkTask> tasks,
          const PixelWorth& worth, const float* missed, WalkedTile* out) {
  (missed == nullptr ? area_of<false> : area_of<true>)(table, limits, tasks, worth, missed, out);
}

void visits(const BrickTable& table, const WalkLimits& limits, const WalkTask& task,
            std::vector<VoxelVisit>& out) {
  for (int lane0 = 0; lane0 < kTileRays; lane0 += kWidth) {
    VisitSink sink(lane0, out);
    PacketWalk<VisitFinder, VisitSink> walk{VisitFinder(table)};
    if (!walk.begin(table, limits, task, lane0)) continue;
    while (walk.step(sink)) {
    }
  }
}

}  // namespace

const WalkKernels& ordered_walk_kernels() {
  static const WalkKernels table{area, visits};
  return table;
}

}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewgain::detail {

WalkLimits walk_limits(const SceneData& scene, const PoseFrame& frame) {
  const GridSnapshot& snapshot = scene.snapshot;
  WalkLimits limits;
  limits.origin = frame.origin;
  limits.min_range = frame.min_range;
  limits.workspace = {static_cast<float>(snapshot.dims.x), static_cast<float>(snapshot.dims.y),
                      static_cast<float>(snapshot.dims.z)};
  const std::optional<double>& plane = scene.surroundings->support_plane;
  if (!plane) return limits;
  const Pose T_grid_world = snapshot.T_world_grid.inverse();
  const Eigen::Vector3d normal = T_grid_world.rotation() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d base(snapshot.min_index.x, snapshot.min_index.y, snapshot.min_index.z);
  const Eigen::Vector3d on_plane =
      T_grid_world * Eigen::Vector3d(0, 0, *plane) / snapshot.voxel_size - base;
  limits.has_plane = true;
  for (Eigen::Index a = 0; a < 3; ++a) {
    limits.normal[static_cast<std::size_t>(a)] = static_cast<float>(normal[a]);
  }
  limits.height = static_cast<float>(normal.dot(on_plane));
  return limits;
}

void set_up(const TileTable& table, std::size_t number, const PoseFrame& frame, const RayTile& rays,
            WalkTask& task) {
  std::copy_n(rays.dx, kTileRays, task.dx);
  std::copy_n(rays.dy, kTileRays, task.dy);
  std::copy_n(rays.dz, kTileRays, task.dz);
  std::copy_n(rays.ix, kTileRays, task.ix);
  std::copy_n(rays.iy, kTileRays, task.iy);
  std::copy_n(rays.iz, kTileRays, task.iz);
  std::copy_n(rays.range, kTileRays, task.near);
  if (rays.has_far) {
    std::copy_n(rays.far, kTileRays, task.far);
  } else {
    std::fill_n(task.far, kTileRays, frame.max_range);
  }
  task.solid_angle = &table.solid_angle[number * kTileRays];
  task.lanes = rays.hit;
}

const WalkKernels& walk_kernels(Isa isa) { return VIEWGAIN_OF_ISA(isa, ordered_walk_kernels)(); }

}  // namespace viewgain::detail
#endif
