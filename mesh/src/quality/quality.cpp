// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/mesh/quality.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <string>
#include <unsupported/Eigen/BVH>

#include "viewgain/core/error.hpp"
#include "viewgain/support/hash64.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain {
namespace {

using Eigen::Vector3d;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kOutlierDistance = 0.010;  // [m]; farther points are outliers
constexpr double kClip = 25.0;              // of z²
constexpr std::size_t kChunk = 256;

Vector3d vector_of(const std::array<double, 3>& p) { return {p[0], p[1], p[2]}; }

// In [0, 1), the same on every machine.
double uniform(std::uint64_t seed, std::uint64_t counter) {
  return unit_number(mix64(seed * 0xD1B54A32D192ED03ULL + counter * kMixStep));
}

struct Triangle {
  Vector3d a, b, c;
  Vector3d normal;  // unit
  double area = 0;
};

// The point of segment ab that is nearest to p.
Vector3d nearest_on_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d ab = b - a;
  return a + std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0) * ab;
}

Vector3d nearest_on_triangle(const Vector3d& p, const Triangle& t) {
  const bool inside_ab = t.normal.cross(t.b - t.a).dot(p - t.a) >= 0;
  const bool inside_bc = t.normal.cross(t.c - t.b).dot(p - t.b) >= 0;
  const bool inside_ca = t.normal.cross(t.a - t.c).dot(p - t.c) >= 0;
  if (inside_ab && inside_bc && inside_ca) return p - t.normal.dot(p - t.a) * t.normal;
  // Beyond an edge. At an obtuse corner the nearest point can be on another edge.
  Vector3d nearest = nearest_on_segment(p, t.a, t.b);
  for (const Vector3d& q : {nearest_on_segment(p, t.b, t.c), nearest_on_segment(p, t.c, t.a)}) {
    if ((q - p).squaredNorm() < (nearest - p).squaredNorm()) nearest = q;
  }
  return nearest;
}

// Omits triangles without area, which have no normal.
std::vector<Triangle> triangles_of(const TriangleMesh& mesh) {
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!vector_of(mesh.vertices[v]).allFinite()) {
      refuse("a coordinate of vertex " + std::to_string(v) + " is not finite");
    }
  }
  std::vector<Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    for (const std::uint32_t v : mesh.triangles[f]) {
      if (v >= mesh.vertices.size()) {
        refuse("triangle " + std::to_string(f) + " refers to vertex " + std::to_string(v) +
               ", but the mesh has " + std::to_string(mesh.vertices.size()) + " vertices");
      }
    }
    const auto corner = [&](std::size_t k) {
      return vector_of(mesh.vertices[mesh.triangles[f][k]]);
    };
    Triangle t{corner(0), corner(1), corner(2), Vector3d::Zero(), 0};
    const Vector3d cross = (t.b - t.a).cross(t.c - t.a);
    t.area = 0.5 * cross.stableNorm();
    if (!(t.area > 0)) continue;
    t.normal = cross.stableNormalized();
    triangles.push_back(t);
  }
  return triangles;
}

// Finds the nearest of some items by their boxes. Thread safety: const members may run from many
// threads.
class NearestItem {
 public:
  explicit NearestItem(const std::vector<Eigen::AlignedBox3d>& boxes) {
    std::vector<std::uint32_t> items(boxes.size());
    std::iota(items.begin(), items.end(), 0U);
    tree_.init(items.begin(), items.end(), boxes.begin(), boxes.end());
  }

  struct Nearest {
    std::uint32_t item = 0;
    double squared_distance = std::numeric_limits<double>::infinity();
  };
  // The item with the smallest item_distance(item), the squared distance of p to it. There must be
  // an item.
  template <typename ItemDistance>
  [[nodiscard]] Nearest of(const Vector3d& p, const ItemDistance& item_distance) const {
    Minimizer<ItemDistance> minimizer{p, item_distance, {}};
    (void)Eigen::BVMinimize(tree_, minimizer);
    return minimizer.best;
  }

 private:
  // Interface that BVMinimize requires.
  template <typename ItemDistance>
  struct Minimizer {
    using Scalar = double;
    const Vector3d& p;
    const ItemDistance& item_distance;
    Nearest best;

    [[nodiscard]] double minimumOnVolume(const Eigen::AlignedBox3d& box) const {
      return box.squaredExteriorDistance(p);
    }
    double minimumOnObject(std::uint32_t item) {
      const double d2 = item_distance(item);
      if (d2 < best.squared_distance) best = {item, d2};
      return d2;
    }
  };

  Eigen::KdBVH<double, 3, std::uint32_t> tree_;
};

std::vector<Eigen::AlignedBox3d> boxes_of(const std::vector<Triangle>& triangles) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Triangle& t : triangles)
    boxes.emplace_back(Eigen::AlignedBox3d(t.a).extend(t.b).extend(t.c));
  return boxes;
}

// Stratified: sample i lies in the i-th of `count` parts of equal area.
std::vector<SurfaceSample> sample(const std::vector<Triangle>& triangles, std::size_t count,
                                  std::uint64_t seed) {
  double total = 0;
  for (const Triangle& t : triangles) total += t.area;
  std::vector<SurfaceSample> samples(count);
  std::size_t face = 0;
  double before = 0;  // area of the faces before `face`
  for (std::size_t i = 0; i < count; ++i) {
    const double share =
        (static_cast<double>(i) + uniform(seed, 3 * i)) / static_cast<double>(count);
    while (face + 1 < triangles.size() && before + triangles[face].area <= share * total) {
      before += triangles[face++].area;
    }
    const Triangle& t = triangles[face];
    const double r = std::sqrt(uniform(seed, 3 * i + 1)), s = uniform(seed, 3 * i + 2);
    samples[i] = {t.a + r * (1 - s) * (t.b - t.a) + r * s * (t.c - t.a), t.normal};
  }
  return samples;
}

void check_finite(std::span<const std::array<double, 3>> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!vector_of(points[i]).allFinite()) {
      refuse("a coordinate of point " + std::to_string(i) + " is not finite");
    }
  }
}

// The smallest value that at least a fraction q of the values does not exceed.
double quantile(std::vector<double>& values, double q) {
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(q * static_cast<double>(values.size())));
  const auto it = values.begin() + std::max<std::ptrdiff_t>(rank - 1, 0);
  std::nth_element(values.begin(), it, values.end());
  return *it;
}

std::vector<Triangle> with_area(const TriangleMesh& mesh) {
  std::vector<Triangle> triangles = triangles_of(mesh);
  if (triangles.empty()) refuse("the area of the mesh is 0");
  return triangles;
}

}  // namespace

struct GroundTruth::Impl {
  std::vector<Triangle> triangles;
  NearestItem tree;
  std::vector<SurfaceSample> samples;
  mutable ThreadPool pool;

  Impl(const TriangleMesh& mesh, std::size_t sample_count, std::uint64_t seed,
       const ExecConfig& exec)
      : triangles(with_area(mesh)),
        tree(boxes_of(triangles)),
        samples(sample(triangles, sample_count, seed)),
        pool(exec.num_threads) {}

  // Distance of each sample to the nearest of the items with these boxes; item_distance(p, item) is
  // squared.
  template <typename ItemDistance>
  [[nodiscard]] std::vector<double> distances_to(const std::vector<Eigen::AlignedBox3d>& boxes,
                                                 const ItemDistance& item_distance) const {
    std::vector<double> distances(samples.size(), std::numeric_limits<double>::infinity());
    if (boxes.empty()) return distances;
    const NearestItem nearest(boxes);
    pool.for_each_chunk(distances.size(), kChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Vector3d& s = samples[i].position;
        const auto found = nearest.of(s, [&](std::uint32_t j) { return item_distance(s, j); });
        distances[i] = std::sqrt(found.squared_distance);
      }
    });
    return distances;
  }

  // From the nearest point of the surface to the point, and the normal there.
  struct Offset {
    Vector3d vector, normal;
  };

  [[nodiscard]] std::vector<Offset> offsets(std::span<const std::array<double, 3>> points) const {
    check_finite(points);
    std::vector<Offset> result(points.size());
    pool.for_each_chunk(points.size(), kChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Vector3d p = vector_of(points[i]);
        const auto nearest = tree.of(p, [&](std::uint32_t t) {
          return (nearest_on_triangle(p, triangles[t]) - p).squaredNorm();
        });
        const Triangle& t = triangles[nearest.item];
        result[i] = {p - nearest_on_triangle(p, t), t.normal};
      }
    });
    return result;
  }
};

GroundTruth::GroundTruth(const TriangleMesh& mesh, std::size_t sample_count, std::uint64_t seed,
                         const ExecConfig& exec)
    : impl_(std::make_unique<Impl>(mesh, sample_count, seed, exec)) {}
GroundTruth::~GroundTruth() = default;
GroundTruth::GroundTruth(GroundTruth&&) noexcept = default;
GroundTruth& GroundTruth::operator=(GroundTruth&&) noexcept = default;

const std::vector<SurfaceSample>& GroundTruth::samples() const noexcept { return impl_->samples; }

std::vector<double> GroundTruth::distances_to(std::span<const std::array<double, 3>> points) const {
  check_finite(points);
  std::vector<Eigen::AlignedBox3d> boxes;
  boxes.reserve(points.size());
  for (const auto& point : points) boxes.emplace_back(vector_of(point));
  return impl_->distances_to(boxes, [&](const Vector3d& p, std::uint32_t j) {
    return (vector_of(points[j]) - p).squaredNorm();
  });
}

std::vector<double> GroundTruth::distances_to(const TriangleMesh& mesh) const {
  const std::vector<Triangle> triangles = triangles_of(mesh);
  return impl_->distances_to(boxes_of(triangles), [&](const Vector3d& p, std::uint32_t j) {
    return (nearest_on_triangle(p, triangles[j]) - p).squaredNorm();
  });
}

std::vector<double> GroundTruth::distances_of(std::span<const std::array<double, 3>> points) const {
  std::vector<double> distances;
  distances.reserve(points.size());
  for (const Impl::Offset& offset : impl_->offsets(points)) {
    distances.push_back(offset.vector.norm());
  }
  return distances;
}

ErrorStatistics GroundTruth::error(std::span<const std::array<double, 3>> points) const {
  if (points.empty()) return {kNaN, kNaN, 0};
  std::vector<double> distances;
  distances.reserve(points.size());
  double sum = 0;
  for (const Impl::Offset& offset : impl_->offsets(points)) {
    distances.push_back(offset.vector.norm());
    sum += offset.vector.squaredNorm();
  }
  return {std::sqrt(sum / static_cast<double>(points.size())), quantile(distances, 0.95),
          points.size()};
}

Consistency GroundTruth::consistency(std::span<const std::array<double, 3>> points,
                                     std::span<const SymmetricMatrix3> covariances) const {
  if (points.size() != covariances.size()) {
    refuse("one covariance per point is required; points: " + std::to_string(points.size()) +
           ", covariances: " + std::to_string(covariances.size()));
  }
  Consistency result{kNaN, kNaN, kNaN, 0, 0};
  std::vector<double> z2;
  double clipped = 0;
  std::size_t above = 0;
  const std::vector<Impl::Offset> offsets = impl_->offsets(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = offsets[i].vector.norm();
    if (distance > kOutlierDistance) {
      ++result.outliers;
      continue;
    }
    const Vector3d n = distance > 0 ? Vector3d(offsets[i].vector / distance) : offsets[i].normal;
    const double variance = n.dot(covariances[i] * n);
    if (!(variance > 0) || !std::isfinite(variance)) {
      refuse("the covariance of point " + std::to_string(i) + " has the variance " +
             short_text(variance) + " along the normal; it must be positive and finite");
    }
    z2.push_back(distance * distance / variance);
    clipped += std::min(z2.back(), kClip);
    if (z2.back() > 9) ++above;
  }
  result.points = z2.size();
  if (z2.empty()) return result;
  const auto count = static_cast<double>(z2.size());
  result.mean_clipped = clipped / count;
  result.median = quantile(z2, 0.5);
  result.above_9 = static_cast<double>(above) / count;
  return result;
}

double coverage(std::span<const double> distances, double radius,
                std::span<const std::uint8_t> mask) {
  if (!mask.empty() && mask.size() != distances.size()) {
    refuse("one mask value per distance is required; distances: " +
           std::to_string(distances.size()) + ", mask values: " + std::to_string(mask.size()));
  }
  std::size_t counted = 0, covered = 0;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    if (!mask.empty() && mask[i] == 0) continue;
    ++counted;
    if (distances[i] <= radius) ++covered;
  }
  return counted == 0 ? kNaN : static_cast<double>(covered) / static_cast<double>(counted);
}

}  // namespace viewgain
