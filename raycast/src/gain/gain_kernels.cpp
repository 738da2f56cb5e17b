// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The arithmetic of the expected gain in double precision, compiled once for each instruction set.
// Every voxel is computed by itself with + - × / only, so the vector width does not show in the
// result.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gain/gain_kernels.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
//
#include <hwy/highway.h>

#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "gain_kernels.hpp"
#include "viewgain/core/noise.hpp"
#include "viewgain/support/belief_block.hpp"
#include "viewgain/support/isa_dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using DD = hn::CappedTag<double, 8>;
using DI = hn::RebindToSigned<DD>;
constexpr DD dd;
using VD = hn::Vec<DD>;
constexpr std::size_t kLanes = hn::MaxLanes(dd);

void append(const RayTile& tile, HitList& hits) {
#if HWY_TARGET == HWY_AVX3
  constexpr hn::CappedTag<float, kTileRays> df;
  constexpr hn::RebindToUnsigned<decltype(df)> du;
  constexpr std::size_t kWidth = hn::MaxLanes(df);
  for (std::size_t lane0 = 0; lane0 < kTileRays; lane0 += kWidth) {
    const auto bit = hn::Shl(hn::Set(du, 1U), hn::Iota(du, static_cast<std::uint32_t>(lane0)));
    const auto hit = hn::TestBit(hn::Set(du, tile.hit), bit);
    const auto hit_f = hn::RebindMask(df, hit);
    const std::size_t n = hits.count;
    // In registers, then whole vectors: compressing stores to memory are slow on some CPUs. What
    // lies beyond the hits is overwritten by the next ones.
    const auto store = [&](auto d, const auto* from, const auto& mask, auto* to)
                           HWY_ATTR { hn::StoreU(hn::Compress(hn::Load(d, from), mask), d, to); };
    store(df, tile.dx + lane0, hit_f, hits.dx + n);
    store(df, tile.dy + lane0, hit_f, hits.dy + n);
    store(df, tile.dz + lane0, hit_f, hits.dz + n);
    store(df, tile.range + lane0, hit_f, hits.range + n);
    store(du, tile.offset + lane0, hit, hits.offset + n);
    store(du, tile.primitive + lane0, hit, hits.primitive + n);
    hits.count += hn::CountTrue(du, hit);
  }
#else
  // Compressing stores are slower than a loop over the hits where the CPU has no instruction for
  // them.
  for (std::uint32_t left = tile.hit; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(left));
    const std::size_t n = hits.count++;
    hits.dx[n] = tile.dx[lane];
    hits.dy[n] = tile.dy[lane];
    hits.dz[n] = tile.dz[lane];
    hits.range[n] = tile.range[lane];
    hits.offset[n] = tile.offset[lane];
    hits.primitive[n] = tile.primitive[lane];
  }
#endif
}

void expand(const FrontalSigmas& sigmas, double voxel_size, HitBatch& batch) {
  constexpr hn::Rebind<float, DD> half;
  const VD one = hn::Set(dd, 1.0), voxel = hn::Set(dd, voxel_size);
  const VD a0 = hn::Set(dd, sigmas.a0), a1 = hn::Set(dd, sigmas.a1), a2 = hn::Set(dd, sigmas.a2),
           v = hn::Set(dd, sigmas.v), l0 = hn::Set(dd, sigmas.l0), l1 = hn::Set(dd, sigmas.l1),
           p0 = hn::Set(dd, sigmas.p0), p2 = hn::Set(dd, sigmas.p2);
  for (std::size_t i = 0; i < batch.count; i += kLanes) {
    const VD x = hn::PromoteTo(dd, hn::LoadU(half, batch.dx + i));
    const VD y = hn::PromoteTo(dd, hn::LoadU(half, batch.dy + i));
    const VD z = hn::PromoteTo(dd, hn::LoadU(half, batch.dz + i));
    const VD range = hn::Mul(hn::PromoteTo(dd, hn::LoadU(half, batch.range + i)), voxel);
    const VD t = hn::Max(range, hn::Set(dd, kMinNoiseRange));
    const VD from_vertex = hn::Sub(t, v);
    const VD axial =
        hn::Add(hn::Add(a0, hn::Mul(a1, t)), hn::Mul(a2, hn::Mul(from_vertex, from_vertex)));
    const VD lateral = hn::Add(l0, hn::Mul(l1, t));
    const VD xx = hn::Mul(x, x), yy = hn::Mul(y, y), zz = hn::Mul(z, z);
    // a = 1 / σ_lat², b = 1 / σ_ax², c = (b - a) / |d|², with one division. The direction is unit
    // to single precision only; with σ_ax far from σ_lat that would show, hence |d|².
    const VD norm = hn::Add(xx, hn::Add(yy, zz));
    const VD var_axial = hn::Add(hn::Mul(axial, axial), p0);
    const VD var_lateral =
        hn::Add(hn::Mul(lateral, lateral), hn::Add(p0, hn::Mul(p2, hn::Mul(t, t))));
    const VD both = hn::Mul(var_lateral, var_axial);
    const VD inverse = hn::Div(one, hn::Mul(both, norm));
    const VD a = hn::Mul(hn::Mul(var_axial, norm), inverse);
    const VD c = hn::Mul(hn::Sub(var_lateral, var_axial), inverse);
    hn::StoreInterleaved4(hn::Add(a, hn::Mul(c, xx)), hn::Add(a, hn::Mul(c, yy)),
                          hn::Add(a, hn::Mul(c, zz)), hn::Mul(c, hn::Mul(x, y)), dd,
                          batch.information_a[i]);
    hn::StoreInterleaved4(hn::Mul(c, hn::Mul(x, z)), hn::Mul(c, hn::Mul(y, z)), hn::Zero(dd),
                          hn::Zero(dd), dd, batch.information_b[i]);
  }
}

void accumulate(const HitBatch& batch, const std::uint32_t* places, const std::uint64_t* keep,
                VoxelSum* sums) {
  constexpr hn::CappedTag<double, 4> d;
  constexpr std::size_t kWidth = hn::MaxLanes(d);
  constexpr hn::RebindToUnsigned<decltype(d)> du;
  for (std::size_t i = 0; i < batch.count; ++i) {
    VoxelSum& sum = sums[places[i]];
    const auto kept = hn::BitCast(d, hn::Set(du, keep[i]));
    const auto add = [&](double* held, const double* information) HWY_ATTR {
      for (std::size_t k = 0; k < 4; k += kWidth) {
        const auto before = hn::And(kept, hn::Load(d, held + k));
        hn::Store(hn::Add(before, hn::Load(d, information + k)), d, held + k);
      }
    };
    add(sum.a, batch.information_a[i]);
    add(sum.b, batch.information_b[i]);
  }
}

void look_up(const BeliefBlock* const* blocks, const std::uint32_t* offsets, std::size_t count,
             MatrixHalf* known_a, MatrixHalf* known_b) {
  // Where the beliefs are is found some voxels ahead of reading them, so that memory can follow.
  constexpr std::size_t kAhead = 32;
  static constexpr Belief kNothing{};
  const Belief* found[kAhead];
  double shares[kAhead];
  constexpr hn::CappedTag<double, 4> d;
  constexpr hn::Rebind<float, decltype(d)> half;
  for (std::size_t begin = 0; begin < count; begin += kAhead) {
    const std::size_t n = count - begin < kAhead ? count - begin : kAhead;
    for (std::size_t i = 0; i < n; ++i) {
      const BeliefBlock* block = blocks[begin + i];
      const Belief* belief = block != nullptr ? block->find(offsets[begin + i]) : nullptr;
      found[i] = belief != nullptr ? belief : &kNothing;
      shares[i] = belief != nullptr ? surface_share(block->scale) : 1.0;
      __builtin_prefetch(found[i]);
    }
    for (std::size_t i = 0; i < n; ++i) {
      const float* information = found[i]->information.data();
      double* a = known_a[begin + i].value;
      double* b = known_b[begin + i].value;
      for (std::size_t k = 0; k < 4; k += hn::MaxLanes(d)) {
        const auto wide = hn::PromoteTo(d, hn::LoadU(half, information + k));
        hn::Store(hn::Mul(wide, hn::Set(d, shares[i])), d, a + k);
      }
      b[0] = static_cast<double>(information[4]) * shares[i];
      b[1] = static_cast<double>(information[5]) * shares[i];
      b[2] = static_cast<double>(found[i]->hits);
      b[3] = 0;
    }
  }
}

// Cofactors of the diagonal and the determinant of symmetric matrices.
struct Inverse {
  VD xx, yy, zz, determinant;
};
HWY_INLINE Inverse invert(VD xx, VD yy, VD zz, VD xy, VD xz, VD yz) {
  const VD c_xx = hn::Sub(hn::Mul(yy, zz), hn::Mul(yz, yz));
  const VD c_yy = hn::Sub(hn::Mul(xx, zz), hn::Mul(xz, xz));
  const VD c_zz = hn::Sub(hn::Mul(xx, yy), hn::Mul(xy, xy));
  const VD c_xy = hn::Sub(hn::Mul(xz, yz), hn::Mul(xy, zz));
  const VD c_xz = hn::Sub(hn::Mul(xy, yz), hn::Mul(xz, yy));
  const VD determinant = hn::Add(hn::Mul(xx, c_xx), hn::Add(hn::Mul(xy, c_xy), hn::Mul(xz, c_xz)));
  return {c_xx, c_yy, c_zz, determinant};
}

HWY_INLINE VD cube(VD x) { return hn::Mul(x, hn::Mul(x, x)); }
HWY_INLINE VD diagonal_product(const Inverse& m) { return hn::Mul(m.xx, hn::Mul(m.yy, m.zz)); }

// H(before) - H(after) in the form that GainKernels::finish names.
template <Criterion criterion>
HWY_INLINE VD reduction(const Inverse& before, const Inverse& after) {
  if constexpr (criterion == Criterion::log_diagonal) {
    return hn::Div(hn::Mul(diagonal_product(before), cube(after.determinant)),
                   hn::Mul(diagonal_product(after), cube(before.determinant)));
  } else if constexpr (criterion == Criterion::log_determinant) {
    return hn::Div(after.determinant, before.determinant);
  } else {
    const auto trace = [](const Inverse& m) HWY_ATTR {
      return hn::Div(hn::Add(m.xx, hn::Add(m.yy, m.zz)), m.determinant);
    };
    return hn::Sub(trace(before), trace(after));
  }
}

// Eight strands of a LogProduct in as many vectors as they need.
constexpr std::size_t kStrands = 8;
constexpr std::size_t kParts = kStrands / kLanes;

// Multiplies into one part of the strands and takes the exponents out. A product that is no
// positive normal number (a factor that is not, or NaN before) makes the strand NaN for good.
HWY_INLINE void multiply(LogProduct& product, std::size_t part, VD factor) {
  constexpr DI di;
  double* mantissa = product.mantissa + part * kLanes;
  std::int64_t* exponent = product.exponent + part * kLanes;
  const VD raw = hn::Mul(hn::Load(dd, mantissa), factor);
  const auto normal = hn::And(hn::Ge(raw, hn::Set(dd, std::numeric_limits<double>::min())),
                              hn::Le(raw, hn::Set(dd, std::numeric_limits<double>::max())));
  const auto bits = hn::BitCast(di, raw);
  const auto power = hn::Sub(hn::ShiftRight<52>(bits), hn::Set(di, std::int64_t{1023}));
  const auto fraction = hn::And(bits, hn::Set(di, (std::int64_t{1} << 52) - 1));
  const VD scaled = hn::BitCast(dd, hn::Or(fraction, hn::Set(di, std::int64_t{1023} << 52)));
  const VD nan = hn::Set(dd, std::numeric_limits<double>::quiet_NaN());
  hn::Store(hn::IfThenElse(normal, scaled, nan), dd, mantissa);
  hn::Store(hn::Add(hn::Load(di, exponent), power), di, exponent);
}

// What an inverse's diagonal has more: F det in each of its cofactors.
HWY_INLINE Inverse with_floor(Inverse m, VD floor) {
  const VD more = hn::Mul(floor, m.determinant);
  m.xx = hn::Add(m.xx, more), m.yy = hn::Add(m.yy, more), m.zz = hn::Add(m.zz, more);
  return m;
}

template <Criterion criterion, bool kWithPosterior, bool kWithFloor = false>
HWY_INLINE void finish_as(double prior_information, const VoxelClass& voxels, LogProduct& ratios,
                          LogProduct* posterior, double* each, double floor = 0) {
  const VD prior = hn::Set(dd, prior_information), zero = hn::Zero(dd), one = hn::Set(dd, 1.0);
  const Inverse unknown_before = invert(prior, prior, prior, zero, zero, zero);
  // Copies, so that the compiler may keep the strands in registers.
  LogProduct ratio_strands = ratios, posterior_strands;
  if constexpr (kWithPosterior) posterior_strands = *posterior;
  for (std::size_t i = 0; i < voxels.count; i += kStrands) {
    for (std::size_t part = 0; part < kParts; ++part) {
      const std::size_t first = i + part * kLanes;
      const std::size_t left = voxels.count > first ? voxels.count - first : 0;
      const auto live = hn::FirstN(dd, left);
      alignas(64) double rows_a[kLanes][4], rows_b[kLanes][4];
      const auto sum_of = [&](std::size_t lane) -> const VoxelSum& {
        return voxels.sums[lane < left ? voxels.members[first + lane] : 0];
      };
#if HWY_TARGET == HWY_AVX3
      // Whole vectors are written, since what is read back next are whole vectors.
      for (std::size_t lane = 0; lane < kLanes; lane += 2) {
        const VD even = hn::Load(dd, sum_of(lane).a), odd = hn::Load(dd, sum_of(lane + 1).a);
        hn::Store(hn::ConcatLowerLower(dd, odd, even), dd, rows_a[lane]);
        hn::Store(hn::ConcatUpperUpper(dd, odd, even), dd, rows_b[lane]);
      }
#else
      constexpr hn::CappedTag<double, 4> row;
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        for (std::size_t k = 0; k < 4; k += hn::MaxLanes(row)) {
          hn::Store(hn::Load(row, sum_of(lane).a + k), row, rows_a[lane] + k);
          hn::Store(hn::Load(row, sum_of(lane).b + k), row, rows_b[lane] + k);
        }
      }
#endif
      VD xx, yy, zz, xy, xz, yz, pad;
      hn::LoadInterleaved4(dd, rows_a[0], xx, yy, zz, xy);
      hn::LoadInterleaved4(dd, rows_b[0], xz, yz, pad, pad);
      Inverse before = unknown_before;
      if (voxels.known_a != nullptr) {
        VD kxx, kyy, kzz, kxy, kxz, kyz;
        hn::LoadInterleaved4(dd, voxels.known_a[first].value, kxx, kyy, kzz, kxy);
        hn::LoadInterleaved4(dd, voxels.known_b[first].value, kxz, kyz, pad, pad);
        before =
            invert(hn::Add(prior, kxx), hn::Add(prior, kyy), hn::Add(prior, kzz), kxy, kxz, kyz);
        xx = hn::Add(xx, kxx), yy = hn::Add(yy, kyy), zz = hn::Add(zz, kzz);
        xy = hn::Add(xy, kxy), xz = hn::Add(xz, kxz), yz = hn::Add(yz, kyz);
      }
      Inverse after =
          invert(hn::Add(prior, xx), hn::Add(prior, yy), hn::Add(prior, zz), xy, xz, yz);
      if constexpr (kWithFloor) {
        before = with_floor(before, hn::Set(dd, floor));
        after = with_floor(after, hn::Set(dd, floor));
      }
      const VD gained = reduction<criterion>(before, after);
      if constexpr (kWithPosterior) {
        const Inverse without_prior = invert(xx, yy, zz, xy, xz, yz);
        const VD left_over =
            hn::Div(diagonal_product(without_prior), cube(without_prior.determinant));
        multiply(posterior_strands, part, hn::IfThenElse(live, left_over, one));
      }
      if (each != nullptr) {
        hn::StoreU(gained, dd, each + first);
      } else {
        multiply(ratio_strands, part, hn::IfThenElse(live, gained, one));
      }
    }
  }
  ratios = ratio_strands;
  if constexpr (kWithPosterior) *posterior = posterior_strands;
}

template <Criterion criterion>
void finish_by(double prior_information, const VoxelClass& voxels, LogProduct& ratios,
               LogProduct* posterior, double* each) {
  if (posterior != nullptr) {
    finish_as<criterion, true>(prior_information, voxels, ratios, posterior, each);
  } else {
    finish_as<criterion, false>(prior_information, voxels, ratios, posterior, each);
  }
}

void finish(Criterion criterion, double prior_information, const VoxelClass& voxels,
            LogProduct& ratios, LogProduct* posterior, double* each) {
  switch (criterion) {
    case Criterion::log_diagonal:
      return finish_by<Criterion::log_diagonal>(prior_information, voxels, ratios, posterior, each);
    case Criterion::log_determinant:
      return finish_by<Criterion::log_determinant>(prior_information, voxels, ratios, posterior,
                                                   each);
    case Criterion::trace:
      return finish_by<Criterion::trace>(prior_information, voxels, ratios, posterior, each);
  }
}

void finish_with_floor(double prior_information, double floor, const VoxelClass& voxels,
                       double* each) {
  LogProduct unused;
  finish_as<Criterion::log_diagonal, false, true>(prior_information, voxels, unused, nullptr, each,
                                                  floor);
}

}  // namespace

const GainKernels& gain_kernel_table() {
  static const GainKernels table{append, expand, accumulate, look_up, finish, finish_with_floor};
  return table;
}

}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewgain::detail {

double LogProduct::log() const {
  double product = 1.0;  // of eight numbers in [1, 2)
  std::int64_t power = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    product *= mantissa[i];
    power += exponent[i];
  }
  return std::log(product) + static_cast<double>(power) * std::numbers::ln2;
}

const GainKernels& gain_kernels(Isa isa) { return VIEWGAIN_OF_ISA(isa, gain_kernel_table)(); }

}  // namespace viewgain::detail
#endif
