// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "obstacle_scene.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "scene/gather_scene.hpp"
#include "scene_tracing.hpp"

namespace viewgain::detail {
namespace {

struct Triangle {
  std::array<Eigen::Vector3f, 3> corners;
  float reach;  // largest coordinate of the obstacle triangle that it is a part of

  const Eigen::Vector3f& operator[](std::size_t i) const { return corners[i]; }
};

// Embree leaves out triangles that reach farther [voxels].
constexpr float kFarthest = 1e18F;
// By so much of the largest coordinate Embree's distances, and ours, may be wrong.
constexpr float kRounding = 1e-6F;

// Obstacles in the scene's coordinates: voxels from the workspace's lowest corner.
struct Soup {
  std::vector<float> vertices;
  std::vector<unsigned> indices;

  explicit Soup(const SceneData& data) {
    const Pose T_grid_world = data.snapshot.T_world_grid.inverse();
    const Eigen::Vector3d base(data.snapshot.min_index.x, data.snapshot.min_index.y,
                               data.snapshot.min_index.z);
    const TriangleMesh mesh = join_obstacles(data.surroundings->obstacles);
    for (const auto& v : mesh.vertices) {
      const Eigen::Vector3d p_world(v[0], v[1], v[2]);
      const Eigen::Vector3d p = (T_grid_world * p_world) / data.snapshot.voxel_size - base;
      for (const double c : p) vertices.push_back(static_cast<float>(c));
    }
    for (const auto& triangle : mesh.triangles) {
      indices.insert(indices.end(), triangle.begin(), triangle.end());
    }
  }

  [[nodiscard]] std::vector<Triangle> triangles() const {
    std::vector<Triangle> all;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
      Triangle triangle{};
      for (std::size_t k = 0; k < 3; ++k) {
        triangle.corners.at(k) = Eigen::Vector3f::Map(&vertices[3 * std::size_t{indices[i + k]}]);
        // Embree does without triangles that are not finite, too.
        triangle.reach = std::max(triangle.reach, triangle[k].allFinite()
                                                      ? triangle[k].cwiseAbs().maxCoeff()
                                                      : std::numeric_limits<float>::infinity());
      }
      if (triangle.reach <= kFarthest) all.push_back(triangle);
    }
    return all;
  }
};

// Axis-aligned, in voxels.
struct Bounds {
  Eigen::Vector3f low, high;

  explicit Bounds(const Triangle& t)
      : low(t[0].cwiseMin(t[1]).cwiseMin(t[2]).array() - kRounding * t.reach),
        high(t[0].cwiseMax(t[1]).cwiseMax(t[2]).array() + kRounding * t.reach) {}
  void add(const Bounds& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
};

// Boxes round each so many that follow on one another.
std::vector<Bounds> round_each(const std::vector<Bounds>& boxes, std::size_t size) {
  std::vector<Bounds> groups;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (i % size == 0) {
      groups.push_back(boxes[i]);
    } else {
      groups.back().add(boxes[i]);
    }
  }
  return groups;
}

// Few large triangles in smaller ones, those first that are largest for how far off they are.
void split(std::vector<Triangle>& triangles, const Eigen::Vector3f& center, float radius) {
  constexpr float kFine = 1.0F / 32.0F;
  const auto longest = [](const Triangle& t) {
    const std::array<float, 3> edges{(t[1] - t[0]).norm(), (t[2] - t[1]).norm(),
                                     (t[0] - t[2]).norm()};
    const auto it = std::max_element(edges.begin(), edges.end());
    return std::pair(*it, static_cast<std::size_t>(it - edges.begin()));
  };
  const auto size_of = [&](const Triangle& t) {
    const Bounds bounds(t);
    const Eigen::Vector3f nearest = center.cwiseMax(bounds.low).cwiseMin(bounds.high);
    return longest(t).first / ((nearest - center).norm() + radius);
  };
  std::vector<std::pair<float, std::size_t>> heap;
  for (std::size_t i = 0; i < triangles.size(); ++i) heap.emplace_back(size_of(triangles[i]), i);
  std::make_heap(heap.begin(), heap.end());
  while (triangles.size() < ObstacleScene::kMostPieces && heap.front().first > kFine) {
    std::pop_heap(heap.begin(), heap.end());
    const std::size_t at = heap.back().second;
    const std::size_t edge = longest(triangles[at]).second;
    const Eigen::Vector3f middle = 0.5F * (triangles[at][edge] + triangles[at][(edge + 1) % 3]);
    Triangle other = triangles[at];
    triangles[at].corners[(edge + 1) % 3] = middle;
    other.corners[edge] = middle;
    heap.back().first = size_of(triangles[at]);
    std::push_heap(heap.begin(), heap.end());
    heap.emplace_back(size_of(other), triangles.size());
    std::push_heap(heap.begin(), heap.end());
    triangles.push_back(other);
  }
}

// Sorts triangles so that each run of so many that begins at a multiple is close together: halves
// by the middle along the longest axis, again and again.
void bring_together(std::span<Triangle> triangles, std::size_t size) {
  if (triangles.size() <= size) return;
  Bounds all(triangles.front());
  for (const Triangle& t : triangles) all.add(Bounds(t));
  Eigen::Index axis = 0;
  (all.high - all.low).maxCoeff(&axis);
  const std::size_t runs = (triangles.size() + size - 1) / size, half = (runs + 1) / 2 * size;
  const auto place = [&](const Triangle& t) { return t[0][axis] + t[1][axis] + t[2][axis]; };
  std::nth_element(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(half),
                   triangles.end(),
                   [&](const Triangle& a, const Triangle& b) { return place(a) < place(b); });
  bring_together(triangles.first(half), size);
  bring_together(triangles.subspan(half), size);
}

BoxArrays arrays_of(const std::vector<Bounds>& boxes) {
  BoxArrays arrays;
  arrays.resize((boxes.size() + kBoxVector - 1) / kBoxVector * kBoxVector);
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    const Bounds& b = boxes[std::min(i, boxes.size() - 1)];
    PrimitiveBox box{};
    for (Eigen::Index a = 0; a < 3; ++a) box.min[a] = b.low[a], box.max[a] = b.high[a];
    arrays.set(i, box);
  }
  return arrays;
}

}  // namespace

ObstacleScene::ObstacleScene(const SceneData& data, Isa isa)
    : isa_(isa),
      workspace_{static_cast<float>(data.snapshot.dims.x), static_cast<float>(data.snapshot.dims.y),
                 static_cast<float>(data.snapshot.dims.z)} {
  const Soup soup(data);
  triangles_.emplace(isa, soup.vertices, soup.indices, "building the obstacles");

  std::vector<Triangle> triangles = soup.triangles();
  if (triangles.empty()) return;
  for (const Triangle& t : triangles) rounding_ = std::max(rounding_, kRounding * t.reach);
  const Eigen::Vector3f half = 0.5F * Eigen::Vector3f::Map(workspace_.data());
  split(triangles, half, half.norm());
  const std::size_t each = (triangles.size() + kMostPieces - 1) / kMostPieces;
  bring_together(triangles, each * kBoxVector);
  for (std::size_t i = 0; i < triangles.size(); i += each * kBoxVector) {
    const std::size_t count = std::min(each * kBoxVector, triangles.size() - i);
    bring_together(std::span(triangles).subspan(i, count), each);
  }
  std::vector<Bounds> boxes;
  for (const Triangle& t : triangles) boxes.emplace_back(t);
  boxes = round_each(boxes, each);
  piece_count_ = boxes.size();
  pieces_ = arrays_of(boxes);
  groups_ = arrays_of(round_each(boxes, kBoxVector));
}

std::uint32_t ObstacleScene::cut(const PoseFrame& frame, const RayTile& rays, std::uint32_t lanes,
                                 float* far) const {
  static_assert(kTileRays == TriangleRays::kCount);
  TriangleRays packet;
  std::fill_n(packet.ox, kTileRays, frame.origin[0]);
  std::fill_n(packet.oy, kTileRays, frame.origin[1]);
  std::fill_n(packet.oz, kTileRays, frame.origin[2]);
  std::copy_n(rays.dx, kTileRays, packet.dx);
  std::copy_n(rays.dy, kTileRays, packet.dy);
  std::copy_n(rays.dz, kTileRays, packet.dz);
  std::copy_n(far, kTileRays, packet.far);
  const std::uint32_t met = triangles_->meet(packet, lanes);
  std::copy_n(packet.far, kTileRays, far);
  return met;
}

std::shared_ptr<const ObstacleScene> ObstacleScene::of(const SceneData& data, Isa isa,
                                                       const SceneData* before) {
  if (!data.has_obstacles) return nullptr;
  if (before != nullptr && before->surroundings == data.surroundings) {
    const auto& kept = before->tracing->obstacles;
    const GridSnapshot &a = before->snapshot, &b = data.snapshot;
    const bool same_place = a.voxel_size == b.voxel_size && a.min_index == b.min_index &&
                            a.dims == b.dims && a.T_world_grid == b.T_world_grid;
    if (kept != nullptr && kept->isa_ == isa && same_place) return kept;
  }
  return std::make_shared<const ObstacleScene>(data, isa);
}

}  // namespace viewgain::detail
