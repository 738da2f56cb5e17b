// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "cone_evidence.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace viewgain::detail {
namespace {

// Rounding errors of the projections here and in the kernel are about 1e-13 of a pixel and of a
// range.
constexpr double kPixelMargin = 1e-6;
constexpr double kRangeMargin = 1e-9;
constexpr std::size_t kBoundsChunk = 8192;
// Squares along one side of a rectangle: more is tighter, fewer is faster.
constexpr std::int32_t kTexels = 4;

struct Interval {
  double low, high;
};
Interval operator+(Interval a, Interval b) { return {a.low + b.low, a.high + b.high}; }
Interval operator+(double a, Interval b) { return {a + b.low, a + b.high}; }
Interval operator*(Interval a, Interval b) {
  const double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
  return {std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s))};
}
Interval operator*(double a, Interval b) { return Interval{a, a} * b; }
Interval square(Interval a) {
  const double p = a.low * a.low, q = a.high * a.high;
  return {a.low <= 0 && a.high >= 0 ? 0.0 : std::min(p, q), std::max(p, q)};
}

RangeBounds joined(const RangeBounds& a, const RangeBounds& b) {
  return {std::min(a.clear, b.clear), std::max(a.reach, b.reach)};
}

}  // namespace

void RangePyramid::build(std::span<const double> reach_taper, std::int32_t width,
                         std::int32_t height, ThreadPool& pool) {
  const auto count = [](std::int32_t w, std::int32_t h) {
    return static_cast<std::size_t>(w) * static_cast<std::size_t>(h);
  };
  levels_.resize(static_cast<std::size_t>(
      std::bit_width(static_cast<std::uint32_t>(std::max(width, height) - 1)) + 1));
  Level& finest = levels_[0];
  finest.width = width;
  finest.height = height;
  finest.texels.resize(count(width, height));
  pool.for_each_chunk(finest.texels.size(), kBoundsChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      finest.texels[i] = RangeBounds::of(reach_taper[2 * i], reach_taper[2 * i + 1]).packed();
    }
  });
  for (std::size_t l = 1; l < levels_.size(); ++l) {
    const Level& fine = levels_[l - 1];
    Level& coarse = levels_[l];
    coarse.width = (fine.width + 1) / 2;
    coarse.height = (fine.height + 1) / 2;
    coarse.texels.resize(count(coarse.width, coarse.height));
    for (std::int32_t v = 0; v < coarse.height; ++v) {
      // With an odd size the last row or column counts twice.
      const std::uint64_t* row0 = fine.texels.data() + count(fine.width, 2 * v);
      const std::uint64_t* row1 =
          fine.texels.data() + count(fine.width, std::min(2 * v + 1, fine.height - 1));
      std::uint64_t* out = coarse.texels.data() + count(coarse.width, v);
      for (std::int32_t u = 0; u < coarse.width; ++u) {
        const std::int32_t u0 = 2 * u, u1 = std::min(2 * u + 1, fine.width - 1);
        out[u] = joined(joined(RangeBounds::unpacked(row0[u0]), RangeBounds::unpacked(row0[u1])),
                        joined(RangeBounds::unpacked(row1[u0]), RangeBounds::unpacked(row1[u1])))
                     .packed();
      }
    }
  }
}

RangeBounds RangePyramid::bounds(std::int32_t u0, std::int32_t v0, std::int32_t u1,
                                 std::int32_t v1) const {
  const std::int32_t span = std::max(u1 - u0, v1 - v0) + 1;
  std::size_t l = 0;
  while ((span >> l) > kTexels) ++l;
  const Level& level = levels_[l];
  const auto row = [&](std::int32_t v) {
    return level.texels.data() +
           static_cast<std::size_t>(v) * static_cast<std::size_t>(level.width);
  };
  RangeBounds result = RangeBounds::unpacked(row(v0 >> l)[u0 >> l]);
  for (std::int32_t v = v0 >> l; v <= v1 >> l; ++v) {
    for (std::int32_t u = u0 >> l; u <= u1 >> l; ++u) {
      result = joined(result, RangeBounds::unpacked(row(v)[u]));
    }
  }
  return result;
}

namespace {

// The box of a cube's voxel centres in the camera's frame: its centre and half its extent along
// each grid axis.
struct CenterBox {
  double p[3];
  double half;

  CenterBox(const ConeCamera& camera, Index3 origin, int size, double voxel_size)
      : p{}, half(0.5 * (size - 1) * voxel_size) {
    const auto& T = camera.T_camera_grid;
    const double middle[3] = {(origin.x + 0.5 * size) * voxel_size,
                              (origin.y + 0.5 * size) * voxel_size,
                              (origin.z + 0.5 * size) * voxel_size};
    for (std::size_t r = 0; r < 3; ++r) {
      p[r] =
          T[4 * r] * middle[0] + T[4 * r + 1] * middle[1] + T[4 * r + 2] * middle[2] + T[4 * r + 3];
    }
  }
  [[nodiscard]] Interval depth(const ConeCamera& camera) const {
    double low = p[2], high = p[2];
    for (std::size_t a = 0; a < 3; ++a) {
      low -= std::abs(camera.T_camera_grid[8 + a]) * half;
      high += std::abs(camera.T_camera_grid[8 + a]) * half;
    }
    return {low, high};
  }
  [[nodiscard]] double distance() const {
    return std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
  }
  // The nearest centre lies behind the plane that touches the box and is perpendicular to the
  // direction to its centre.
  [[nodiscard]] double nearest(const ConeCamera& camera) const {
    const auto& T = camera.T_camera_grid;
    const double distance = this->distance();
    double nearest = distance;
    for (std::size_t a = 0; a < 3; ++a) {
      nearest -= half * std::abs(p[0] * T[a] + p[1] * T[4 + a] + p[2] * T[8 + a]) / distance;
    }
    return nearest;
  }
};

// A box in front of the camera, in the plane z = 1, and the squared range of its farthest corner.
struct SeenBox {
  Interval x{}, y{};
  double farthest2 = 0;  // range is convex, so a corner is the farthest

  SeenBox(const ConeCamera& camera, const CenterBox& box) {
    const auto& T = camera.T_camera_grid;
    const auto& [p, half] = box;
    for (int corner = 0; corner < 8; ++corner) {
      const double s[3] = {corner & 1 ? half : -half, corner & 2 ? half : -half,
                           corner & 4 ? half : -half};
      const double z = p[2] + T[8] * s[0] + T[9] * s[1] + T[10] * s[2];
      const double px = p[0] + T[0] * s[0] + T[1] * s[1] + T[2] * s[2];
      const double py = p[1] + T[4] * s[0] + T[5] * s[1] + T[6] * s[2];
      const double cx = px / z, cy = py / z;
      farthest2 = std::max(farthest2, px * px + py * py + z * z);
      if (corner == 0) {
        x = {cx, cx};
        y = {cy, cy};
      } else {
        x = {std::min(x.low, cx), std::max(x.high, cx)};
        y = {std::min(y.low, cy), std::max(y.high, cy)};
      }
    }
  }
};

// Where the box may be after the lens, and whether all of it surely is within the fold. False: all
// of it is beyond.
bool distort(const ConeCamera& camera, SeenBox& seen, bool& inside) {
  const auto& d = camera.distortion;
  const Interval x = seen.x, y = seen.y, xx = square(x), yy = square(y), xy = x * y;
  const Interval r2 = xx + yy;
  if (r2.low > camera.fold_r2 * (1.0 + kRangeMargin)) return false;
  if (!(r2.high < camera.fold_r2 * (1.0 - kRangeMargin))) inside = false;
  const Interval radial = 1.0 + r2 * (d[0] + r2 * (d[1] + d[4] * r2));
  seen.x = x * radial + 2.0 * d[2] * xy + d[3] * (r2 + 2.0 * xx);
  seen.y = y * radial + d[2] * (r2 + 2.0 * yy) + 2.0 * d[3] * xy;
  return true;
}

}  // namespace

CubeClass ConeCull::classify(Index3 origin, int size) const {
  const CenterBox box(camera_, origin, size, voxel_size_);
  const Interval z = box.depth(camera_);
  const double rounding = kRangeMargin * (std::abs(box.p[2]) + size * voxel_size_);
  if (z.high < -rounding) return CubeClass::untouched;
  if (z.low <= rounding) return CubeClass::mixed;  // straddles the camera's plane
  SeenBox seen(camera_, box);
  bool inside = true;  // all centres project into the image
  if (camera_.distorted && !distort(camera_, seen, inside)) return CubeClass::untouched;

  // Pixel q contains the centres with coordinates in [q - 0.5, q + 0.5).
  const double u_low = std::floor(camera_.fx * seen.x.low + camera_.cx + 0.5 - kPixelMargin);
  const double u_high = std::floor(camera_.fx * seen.x.high + camera_.cx + 0.5 + kPixelMargin);
  const double v_low = std::floor(camera_.fy * seen.y.low + camera_.cy + 0.5 - kPixelMargin);
  const double v_high = std::floor(camera_.fy * seen.y.high + camera_.cy + 0.5 + kPixelMargin);
  const double last_u = camera_.width - 1, last_v = camera_.height - 1;
  if (u_high < 0 || u_low > last_u || v_high < 0 || v_low > last_v) return CubeClass::untouched;
  if (!(u_low >= 0 && u_high <= last_u && v_low >= 0 && v_high <= last_v)) inside = false;
  // Written so that NaN from an overflow extends the rectangle to the image.
  const auto lower = [](double value) {
    return value > 0 ? static_cast<std::int32_t>(value) : std::int32_t{0};
  };
  const auto upper = [](double value, double last) {
    return static_cast<std::int32_t>(value < last ? value : last);
  };
  const RangeBounds bounds =
      pyramid_.bounds(lower(u_low), lower(v_low), upper(u_high, last_u), upper(v_high, last_v));
  const double margin = kRangeMargin * (box.distance() + size * voxel_size_);
  if (box.nearest(camera_) - margin > static_cast<double>(bounds.reach))
    return CubeClass::untouched;
  if (std::sqrt(seen.farthest2) + margin < static_cast<double>(bounds.clear)) {
    return inside ? CubeClass::crossed : CubeClass::cut;
  }
  return CubeClass::mixed;
}

void ConeEvidence::gather(const Readings& readings, const ConeCamera& camera, double voxel_size,
                          ThreadPool& pool) {
  readings_ = &readings;
  camera_ = &camera;
  voxel_size_ = voxel_size;
  pyramid_.build(readings.reach_taper(), camera.width, camera.height, pool);
  cull_.emplace(camera, pyramid_, voxel_size);
}

std::vector<std::uint64_t> ConeEvidence::regions(const BlockLattice& lattice) const {
  std::vector<std::uint64_t> regions;
  for (std::uint64_t node = 0; node < lattice.node_count(); ++node) {
    if (classify(lattice.origin(node << 12U), kNodeSize) == CubeClass::untouched) continue;
    for (std::uint64_t region = node << 6U; region < (node + 1) << 6U; ++region) {
      if (lattice.overlaps(lattice.origin(region << 6U), kRegionSize)) regions.push_back(region);
    }
  }
  return regions;
}

// A cell is represented by its centre: the block's cells are voxels of a coarser lattice.
bool ConeEvidence::deltas(std::uint64_t /*key*/, Index3 origin, int scale,
                          std::int8_t* deltas) const {
  const bool any = kernels_.project(
      *camera_, {readings_->reach_taper().data(), pyramid_.pixels()}, voxel_size_ * (1 << scale),
      {origin.x >> scale, origin.y >> scale, origin.z >> scale}, kBlockSize >> scale, deltas);
  // Expanded downwards in place: a cell's entry precedes those of its voxels.
  const auto s = static_cast<unsigned>(scale);
  for (unsigned i = kBlockVoxels; scale > 0 && i-- > 0;) {
    deltas[i] = deltas[(i >> 6U) >> s << 6U | (i >> 3U & 7U) >> s << 3U | (i & 7U) >> s];
  }
  return any;
}

}  // namespace viewgain::detail
