// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Compiled once per instruction set, like block_kernels.cpp: double precision, no fused
// multiply-add, sums in a fixed order.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "update/surface_kernels.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
//
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "surface_kernels.hpp"
#include "viewgain/core/noise.hpp"
#include "viewgain/support/isa_dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

constexpr double kSteepest = 2.0;  // depth per lateral distance
constexpr double kFewest = 6;

template <typename V>
struct Vector {
  V x, y, z;
};

// In Eigen's order.
template <typename V>
HWY_INLINE V dot(const Vector<V>& a, const Vector<V>& b) {
  return hn::Add(hn::Mul(a.x, b.x), hn::Add(hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)));
}
template <typename V>
HWY_INLINE Vector<V> cross(const Vector<V>& a, const Vector<V>& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

template <class D>
HWY_INLINE void find(D d, const Readings& readings, int u, int v, LocalSurfaces& surfaces) {
  using V = hn::Vec<D>;
  constexpr int kRadius = Readings::kDepthBorder;
  const PinholeCamera& camera = readings.sensor().camera;
  const auto width = static_cast<std::ptrdiff_t>(readings.row_length());
  const std::ptrdiff_t stride = width + 2 * kRadius;
  const double* const centre = readings.depths() + (v + kRadius) * stride + u + kRadius;
  const std::ptrdiff_t pixel = v * width + u;
  const hn::RebindToSigned<D> di;
  const auto lane = hn::Iota(di, 0);
  const auto two_lanes = hn::Add(lane, lane), three_lanes = hn::Add(two_lanes, lane);
  const double* const sigmas = &readings.all_sigmas()[static_cast<std::size_t>(pixel)].axial;
  const double* const rays = readings.rays()[static_cast<std::size_t>(pixel)].data();

  const V depth = hn::LoadU(d, centre);
  const V axial = hn::GatherIndex(d, sigmas, two_lanes);
  const V noise = hn::Mul(hn::Set(d, kTaperSigmas * std::numbers::sqrt2), axial);
  const V slope =
      hn::Div(hn::Mul(hn::Set(d, kSteepest), depth), hn::Set(d, std::min(camera.fx, camera.fy)));
  const V zero = hn::Zero(d);
  V n = zero, z = zero, pu = zero, pv = zero, zu = zero, zv = zero;
  V uu = zero, uv = zero, vv = zero;
  for (int j = -kRadius; j <= kRadius; ++j) {
    for (int i = -kRadius; i <= kRadius; ++i) {
      const V farther = hn::Sub(hn::LoadU(d, centre + j * stride + i), depth);
      const V most = hn::Add(hn::Mul(slope, hn::Set(d, std::sqrt(i * i + j * j))), noise);
      const auto taken = hn::Le(hn::Abs(farther), most);  // false without a reading
      const V dz = hn::IfThenElseZero(taken, farther);
      const auto add = [&](int value, V& sum) {
        if (value != 0) sum = hn::Add(sum, hn::IfThenElseZero(taken, hn::Set(d, value)));
      };
      n = hn::Add(n, hn::IfThenElseZero(taken, hn::Set(d, 1.0)));
      z = hn::Add(z, dz);
      add(i, pu);
      add(j, pv);
      if (i != 0) zu = hn::Add(zu, hn::Mul(dz, hn::Set(d, i)));
      if (j != 0) zv = hn::Add(zv, hn::Mul(dz, hn::Set(d, j)));
      add(i * i, uu);
      add(i * j, uv);
      add(j * j, vv);
    }
  }
  auto found = hn::Ge(n, hn::Set(d, kFewest));
  // Depth = z + gradient · (pixel - p), with the means p and z.
  pu = hn::Div(pu, n);
  pv = hn::Div(pv, n);
  z = hn::Div(z, n);
  const V sum_z = hn::Mul(n, z), sum_u = hn::Mul(n, pu), sum_v = hn::Mul(n, pv);
  zu = hn::Sub(zu, hn::Mul(sum_z, pu));
  zv = hn::Sub(zv, hn::Mul(sum_z, pv));
  uu = hn::Sub(uu, hn::Mul(sum_u, pu));
  uv = hn::Sub(uv, hn::Mul(sum_u, pv));
  vv = hn::Sub(vv, hn::Mul(sum_v, pv));
  const V determinant = hn::Sub(hn::Mul(uu, vv), hn::Mul(uv, uv));
  found = hn::And(found, hn::Gt(determinant, hn::Set(d, 1.0)));
  if (hn::AllFalse(d, found)) {
    surfaces.found.fill(false);
    return;
  }
  const V gu = hn::Div(hn::Sub(hn::Mul(vv, zu), hn::Mul(uv, zv)), determinant);
  const V gv = hn::Div(hn::Sub(hn::Mul(uu, zv), hn::Mul(uv, zu)), determinant);

  // Distance of the plane from the reading, in depth [m].
  const V off = hn::Sub(z, hn::Add(hn::Mul(gu, pu), hn::Mul(gv, pv)));
  const V of_plane = hn::Add(depth, off);
  const Vector<V> point{hn::Mul(hn::GatherIndex(d, rays, three_lanes), depth),
                        hn::Mul(hn::GatherIndex(d, rays + 1, three_lanes), depth), depth};
  const Vector<V> ray{hn::Div(point.x, depth), hn::Div(point.y, depth), hn::Set(d, 1.0)};
  const Vector<V> along_u{hn::Add(hn::Mul(gu, ray.x), hn::Div(of_plane, hn::Set(d, camera.fx))),
                          hn::Mul(gu, ray.y), gu};
  const Vector<V> along_v{hn::Mul(gv, ray.x),
                          hn::Add(hn::Mul(gv, ray.y), hn::Div(of_plane, hn::Set(d, camera.fy))),
                          gv};
  Vector<V> normal = cross(along_u, along_v);  // away from the camera
  const V length = hn::Sqrt(dot(normal, normal));
  normal = {hn::Div(normal.x, length), hn::Div(normal.y, length), hn::Div(normal.z, length)};
  const V norm = hn::LoadU(d, &readings.norms()[static_cast<std::size_t>(pixel)]);
  const Vector<V> direction{hn::Div(hn::GatherIndex(d, rays, three_lanes), norm),
                            hn::Div(hn::GatherIndex(d, rays + 1, three_lanes), norm),
                            hn::Div(hn::Set(d, 1.0), norm)};
  const V cosine = dot(normal, direction);
  found = hn::And(found, hn::Ge(cosine, hn::Set(d, kMinCosIncidence)));
  const V lateral = hn::GatherIndex(d, sigmas + 1, two_lanes);
  const V squared_sine = hn::Sub(hn::Set(d, 1.0), hn::Mul(cosine, cosine));
  const V sigma = hn::Sqrt(hn::Add(hn::Mul(hn::Mul(hn::Mul(axial, axial), cosine), cosine),
                                   hn::Mul(hn::Mul(lateral, lateral), squared_sine)));
  const V distance = hn::Mul(off, dot(normal, ray));
  found = hn::And(found, hn::Le(hn::Abs(distance), hn::Mul(hn::Set(d, kTaperSigmas), sigma)));

  hn::StoreU(hn::Add(point.x, hn::Mul(distance, normal.x)), d, surfaces.x.data());
  hn::StoreU(hn::Add(point.y, hn::Mul(distance, normal.y)), d, surfaces.y.data());
  hn::StoreU(hn::Add(point.z, hn::Mul(distance, normal.z)), d, surfaces.z.data());
  std::array<double, LocalSurfaces::kMost> flags;
  hn::StoreU(hn::IfThenElseZero(found, hn::Set(d, 1.0)), d, flags.data());
  for (std::size_t k = 0; k < hn::Lanes(d); ++k) surfaces.found[k] = flags[k] != 0;
}

void group(const Readings& readings, int u, int v, LocalSurfaces& surfaces) {
  find(hn::CappedTag<double, LocalSurfaces::kMost>(), readings, u, v, surfaces);
}

void one(const Readings& readings, int u, int v, LocalSurfaces& surfaces) {
  find(hn::CappedTag<double, 1>(), readings, u, v, surfaces);
}

}  // namespace

const SurfaceKernels& surface_kernels_of_target() {
  static const SurfaceKernels table{
      static_cast<int>(hn::Lanes(hn::CappedTag<double, LocalSurfaces::kMost>())), group, one};
  return table;
}

}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewgain::detail {

const SurfaceKernels& surface_kernels(Isa isa) {
  return VIEWGAIN_OF_ISA(isa, surface_kernels_of_target)();
}

}  // namespace viewgain::detail
#endif
