// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// A ray a lane through a DenseGrid, compiled once for each instruction set. Every lane is mirrored
// so that its ray goes up along all three axes: then only one plane an axis can be the next. A step
// leaves a free cube of bricks, a free cube of 4³ voxels in another brick, or one voxel; lanes need
// not be in step with one another.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/dense_kernel.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
//
#include <hwy/highway.h>

#include "dense_grid.hpp"
#include "viewgain/support/isa_dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::bench::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
using detail::kTileRays;

using DF = hn::CappedTag<float, kTileRays>;
using DU = hn::RebindToUnsigned<DF>;
using DI = hn::RebindToSigned<DF>;
constexpr DF df;
constexpr DU du;
constexpr DI di;
using VF = hn::Vec<DF>;
using VI = hn::Vec<DI>;
using MF = hn::Mask<DF>;
constexpr int kWidth = static_cast<int>(hn::MaxLanes(df));

// One axis of the rays, mirrored.
struct Axis {
  VF origin, direction, inverse;
  VF enter, exit;  // of the box round all that is not free
  VI flip;         // voxel ^ flip: as it was
  VI voxel, last;  // where the ray is, and the last voxel of that box
};

// Axis number k of the rays of a table's lanes.
HWY_INLINE Axis axis_of(const DenseGrid& grid, const detail::PoseFrame& frame, const float* table,
                        std::size_t k) {
  const auto along = [&](std::size_t column) HWY_ATTR {
    return hn::Mul(hn::Set(df, frame.rotation[3 * k + column]),
                   hn::LoadU(df, table + column * kTileRays));
  };
  const VF zero = hn::Zero(df);
  const VF d = hn::Add(hn::Add(along(0), along(1)), along(2));
  const MF down = hn::Lt(d, zero);
  const int edge = 8 << grid.brick_bits;
  const VF far = hn::Set(df, static_cast<float>(edge));
  const VF o = hn::Set(df, frame.origin[k]);
  const VF low = hn::Set(df, grid.low[k]), high = hn::Set(df, grid.high[k]);
  Axis axis;
  axis.direction = hn::Max(hn::Abs(d), hn::Set(df, 1e-20F));
  axis.inverse = hn::Div(hn::Set(df, 1.0F), axis.direction);
  axis.origin = hn::IfThenElse(down, hn::Sub(far, o), o);
  const VF begin = hn::IfThenElse(down, hn::Sub(far, high), low);
  const VF end = hn::IfThenElse(down, hn::Sub(far, low), high);
  axis.enter = hn::Mul(hn::Sub(begin, axis.origin), axis.inverse);
  axis.exit = hn::Mul(hn::Sub(end, axis.origin), axis.inverse);
  axis.flip = hn::IfThenElseZero(hn::RebindMask(di, down), hn::Set(di, edge - 1));
  axis.voxel = hn::ConvertTo(di, begin);
  axis.last = hn::Sub(hn::ConvertTo(di, end), hn::Set(di, 1));
  return axis;
}

// The voxel of the point at t, not before the present one and not beyond `last`.
HWY_INLINE VI voxel_at(const Axis& axis, VF t, VI last) {
  const VF p = hn::Add(axis.origin, hn::Mul(axis.direction, t));
  return hn::Min(hn::Max(hn::ConvertTo(di, p), axis.voxel), last);
}

HWY_INLINE VI brick_index(VI x, VI y, VI z, int bits) {
  return hn::Or(hn::ShiftLeftSame(hn::Or(hn::ShiftLeftSame(x, bits), y), bits), z);
}

// The rays of kWidth lanes; table: the first of the lanes' directions.
HWY_INLINE void trace_lanes(const DenseGrid& grid, const detail::PoseFrame& frame,
                            const float* table, Ending* endings) {
  Axis x = axis_of(grid, frame, table, 0);
  Axis y = axis_of(grid, frame, table, 1);
  Axis z = axis_of(grid, frame, table, 2);
  VF t = hn::Max(hn::Max(hn::Set(df, frame.min_range), x.enter), hn::Max(y.enter, z.enter));
  const VF end = hn::Min(x.exit, hn::Min(y.exit, z.exit));
  const VF farthest = hn::Set(df, frame.max_range);
  const VI miss = hn::Set(di, kMiss);
  MF active = hn::And(hn::Lt(t, end), hn::Le(t, farthest));
  VI ending = miss;
  if (!hn::AllFalse(df, active)) {
    x.voxel = voxel_at(x, t, x.last);
    y.voxel = voxel_at(y, t, y.last);
    z.voxel = voxel_at(z, t, z.last);
    const int bits = grid.brick_bits;
    const VI zero = hn::Zero(di), one = hn::Set(di, 1), two = hn::Set(di, 2), four = hn::Set(di, 4),
             seven = hn::Set(di, 7);
    const VI octant =
        hn::ShiftLeftSame(hn::Or(hn::And(x.flip, hn::Set(di, 4)),
                                 hn::Or(hn::And(y.flip, hn::Set(di, 2)), hn::And(z.flip, one))),
                          3 * bits);
    const VI stride_x = hn::Set(di, grid.dims[1] * grid.dims[2]);
    const VI stride_y = hn::Set(di, grid.dims[2]);
    while (true) {
      const VI real_x = hn::Xor(x.voxel, x.flip), real_y = hn::Xor(y.voxel, y.flip),
               real_z = hn::Xor(z.voxel, z.flip);
      const VI brick = brick_index(hn::ShiftRight<3>(real_x), hn::ShiftRight<3>(real_y),
                                   hn::ShiftRight<3>(real_z), bits);
      // Two bytes of the four that are read.
      const VI at_code = hn::ShiftLeft<1>(hn::Or(octant, brick));
      const VI code = hn::BitCast(
          di,
          hn::GatherOffset(du, reinterpret_cast<const std::uint32_t*>(grid.codes.data()), at_code));
      const VI skip = hn::And(code, hn::Set(di, 255));
      const auto is_free = hn::Gt(skip, zero);
      // The 4³ cube of the brick, which may be free even if the brick is not.
      const VI cube = hn::Or(hn::Or(hn::And(real_x, four), hn::And(hn::ShiftRight<1>(real_y), two)),
                             hn::And(hn::ShiftRight<2>(real_z), one));
      const auto is_solid = hn::TestBit(code, hn::Shl(hn::Set(di, 256), cube));
      // The first voxels beyond what is left next.
      const auto beyond = [&](const Axis& axis) HWY_ATTR {
        const VI of_bricks = hn::ShiftLeft<3>(hn::Add(hn::ShiftRight<3>(axis.voxel), skip));
        const VI of_cube = hn::AndNot(hn::Set(di, 3), hn::Add(axis.voxel, four));
        return hn::IfThenElse(is_free, of_bricks,
                              hn::IfThenElse(is_solid, hn::Add(axis.voxel, one), of_cube));
      };
      const VI bx = beyond(x), by = beyond(y), bz = beyond(z);
      const auto reach = [&](const Axis& axis, VI plane) HWY_ATTR {
        return hn::Mul(hn::Sub(hn::ConvertTo(df, plane), axis.origin), axis.inverse);
      };
      const VF tx = reach(x, bx), ty = reach(y, by), tz = reach(z, bz);
      const VF next = hn::Min(tx, hn::Min(ty, tz));

      const MF looks = hn::And(active, hn::RebindMask(df, is_solid));
      if (!hn::AllFalse(df, looks)) {
        const VI offset = hn::Or(hn::Or(hn::ShiftLeft<6>(hn::And(real_x, seven)),
                                        hn::ShiftLeft<3>(hn::And(real_y, seven))),
                                 hn::And(real_z, seven));
        const VI word = hn::Add(hn::ShiftLeft<4>(brick), hn::ShiftRight<5>(offset));
        const VI mask = hn::BitCast(di, hn::GatherIndex(du, grid.masks.data(), word));
        const auto solid = hn::TestBit(mask, hn::Shl(one, hn::And(offset, hn::Set(di, 31))));
        // A visit of no length does not count.
        const MF found = hn::And(hn::And(looks, hn::RebindMask(df, solid)), hn::Lt(t, next));
        const VI position =
            hn::Add(hn::Add(hn::Mul(real_x, stride_x), hn::Mul(real_y, stride_y)), real_z);
        ending = hn::IfThenElse(hn::RebindMask(di, found), position, ending);
        active = hn::AndNot(found, active);
      }
      t = hn::Max(t, next);
      active = hn::And(active, hn::And(hn::Lt(t, end), hn::Le(t, farthest)));
      if (hn::AllFalse(df, active)) break;
      // Planes that are met at the same t are crossed together; idle lanes stay where they are.
      const auto moves = hn::RebindMask(di, active);
      const auto step = [&](Axis& axis, VF plane_t, VI plane) HWY_ATTR {
        const VI inside = voxel_at(axis, next, hn::Sub(plane, one));
        const VI moved = hn::IfThenElse(hn::RebindMask(di, hn::Le(plane_t, next)), plane, inside);
        axis.voxel = hn::IfThenElse(moves, hn::Min(moved, axis.last), axis.voxel);
      };
      step(x, tx, bx);
      step(y, ty, by);
      step(z, tz, bz);
    }
  }
  hn::StoreU(ending, di, endings);
}

void trace_tile(const DenseGrid& grid, const detail::TileTable& table,
                const detail::PoseFrame& frame, std::size_t tile,
                std::span<Ending, kTileRays> endings) {
  const float* directions = table.directions.data() + tile * 3 * kTileRays;
  for (int lane0 = 0; lane0 < kTileRays; lane0 += kWidth) {
    trace_lanes(grid, frame, directions + lane0, endings.data() + lane0);
  }
}

}  // namespace

DenseTileTracer tracer() { return trace_tile; }

}  // namespace viewgain::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewgain::bench {

DenseTileTracer dense_tile_tracer(Isa isa) { return VIEWGAIN_OF_ISA(isa, tracer)(); }

}  // namespace viewgain::bench
#endif
