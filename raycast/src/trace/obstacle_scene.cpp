// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "obstacle_scene.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "scene_tracing.hpp"

namespace viewgain::detail {
namespace {

using Triangle = std::array<Eigen::Vector3f, 3>;

// A box's twelve triangles, added to a mesh.
void append_box(const Box& box, TriangleMesh& mesh) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  for (unsigned corner = 0; corner < 8; ++corner) {
    mesh.vertices.push_back({(corner & 1U) != 0 ? box.max[0] : box.min[0],
                             (corner & 2U) != 0 ? box.max[1] : box.min[1],
                             (corner & 4U) != 0 ? box.max[2] : box.min[2]});
  }
  constexpr std::array<std::array<std::uint32_t, 4>, 6> kFaces{
      {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}}};
  for (const auto& f : kFaces) {
    mesh.triangles.push_back({base + f[0], base + f[1], base + f[2]});
    mesh.triangles.push_back({base + f[0], base + f[2], base + f[3]});
  }
}

// Obstacles in the scene's coordinates: voxels from the workspace's lowest corner.
struct Soup {
  std::vector<float> vertices;
  std::vector<unsigned> indices;

  explicit Soup(const SceneData& data) {
    const Pose T_grid_world = data.snapshot.T_world_grid.inverse();
    const Eigen::Vector3d base(data.snapshot.min_index.x, data.snapshot.min_index.y,
                               data.snapshot.min_index.z);
    const auto append = [&](const TriangleMesh& mesh) {
      const auto first = static_cast<unsigned>(vertices.size() / 3);
      for (const auto& v : mesh.vertices) {
        const Eigen::Vector3d p_world(v[0], v[1], v[2]);
        const Eigen::Vector3d p = (T_grid_world * p_world) / data.snapshot.voxel_size - base;
        for (const double c : p) vertices.push_back(static_cast<float>(c));
      }
      for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t index : triangle) indices.push_back(first + index);
      }
    };
    TriangleMesh boxes;
    for (const Box& box : data.obstacles->boxes) append_box(box, boxes);
    append(boxes);
    for (const TriangleMesh& mesh : data.obstacles->meshes) append(mesh);
  }

  [[nodiscard]] std::vector<Triangle> triangles() const {
    std::vector<Triangle> all(indices.size() / 3);
    for (std::size_t i = 0; i < indices.size(); ++i) {
      all[i / 3][i % 3] =
          Eigen::Vector3f::Map(&vertices[3 * static_cast<std::size_t>(indices[i])]);
    }
    return all;
  }
};

// Axis-aligned, in voxels.
struct Bounds {
  Eigen::Vector3f low, high;

  explicit Bounds(const Triangle& t)
      : low(t[0].cwiseMin(t[1]).cwiseMin(t[2])), high(t[0].cwiseMax(t[1]).cwiseMax(t[2])) {}
  void add(const Bounds& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
};

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
    const Eigen::Vector3f middle =
        0.5F * (triangles[at][edge] + triangles[at][(edge + 1) % 3]);
    Triangle other = triangles[at];
    triangles[at][(edge + 1) % 3] = middle;
    other[edge] = middle;
    heap.back().first = size_of(triangles[at]);
    std::push_heap(heap.begin(), heap.end());
    heap.emplace_back(size_of(other), triangles.size());
    std::push_heap(heap.begin(), heap.end());
    triangles.push_back(other);
  }
}

// Ten bits an axis, interleaved: near points have near numbers (Morton's order).
std::uint32_t morton(const Eigen::Vector3f& unit) {
  std::uint32_t code = 0;
  const Eigen::Vector3f scaled = (unit * 1023.0F).cwiseMax(0.0F).cwiseMin(1023.0F);
  for (unsigned bit = 0; bit < 10; ++bit) {
    for (Eigen::Index a = 0; a < 3; ++a) {
      const auto v = static_cast<std::uint32_t>(scaled[a]);
      code |= (v >> bit & 1U) << (3 * bit + static_cast<unsigned>(a));
    }
  }
  return code;
}

// Boxes round groups of neighbours.
std::vector<Bounds> grouped(const std::vector<Triangle>& triangles) {
  Bounds all(triangles.front());
  for (const Triangle& t : triangles) all.add(Bounds(t));
  const Eigen::Vector3f extent = (all.high - all.low).cwiseMax(1e-6F);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> order(triangles.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    const Triangle& t = triangles[i];
    order[i] = {morton(((t[0] + t[1] + t[2]) / 3.0F - all.low).cwiseQuotient(extent)), i};
  }
  std::sort(order.begin(), order.end());
  const std::size_t size =
      (triangles.size() + ObstacleScene::kMostPieces - 1) / ObstacleScene::kMostPieces;
  std::vector<Bounds> groups;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Bounds bounds(triangles[order[i].second]);
    if (i % size == 0) {
      groups.push_back(bounds);
    } else {
      groups.back().add(bounds);
    }
  }
  return groups;
}

}  // namespace

ObstacleScene::ObstacleScene(const SceneData& data, Isa isa)
    : isa_(isa),
      workspace_{static_cast<float>(data.snapshot.dims.x), static_cast<float>(data.snapshot.dims.y),
                 static_cast<float>(data.snapshot.dims.z)} {
  const Soup soup(data);
  RTCDevice device = shared_device(isa);
  bvh_.reset(rtcNewScene(device));
  rtcSetSceneBuildQuality(bvh_.get(), RTC_BUILD_QUALITY_HIGH);
  // Without it a ray may slip between two triangles that share an edge.
  rtcSetSceneFlags(bvh_.get(), RTC_SCENE_FLAG_ROBUST);
  if (!soup.indices.empty()) {
    attach_triangles(device, bvh_.get(), 0, soup.vertices.data(), soup.vertices.size() / 3,
                     soup.indices.data(), soup.indices.size() / 3);
  }
  commit_scene(device, bvh_.get(), "building the obstacles");

  std::vector<Triangle> triangles = soup.triangles();
  if (triangles.empty()) return;
  const Eigen::Vector3f half = 0.5F * Eigen::Vector3f::Map(workspace_.data());
  split(triangles, half, half.norm());
  const std::vector<Bounds> boxes = grouped(triangles);
  piece_count_ = boxes.size();
  pieces_.resize((piece_count_ + kBoxVector - 1) / kBoxVector * kBoxVector);
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const Bounds& b = boxes[std::min(i, piece_count_ - 1)];
    // Against rounding where coordinates are large; near the workspace boxes have their margin.
    const Eigen::Vector3f margin = 1e-6F * (b.low.cwiseAbs() + b.high.cwiseAbs());
    PrimitiveBox box{};
    for (Eigen::Index a = 0; a < 3; ++a) {
      box.min[a] = b.low[a] - margin[a];
      box.max[a] = b.high[a] + margin[a];
    }
    pieces_.set(i, box);
  }
}

std::shared_ptr<const ObstacleScene> ObstacleScene::of(const SceneData& data, Isa isa,
                                                       const SceneData* before) {
  if (!data.has_obstacles) return nullptr;
  if (before != nullptr && before->obstacles == data.obstacles) {
    const auto& kept = before->tracing->obstacles;
    const GridSnapshot &a = before->snapshot, &b = data.snapshot;
    const bool same_place = a.voxel_size == b.voxel_size && a.min_index == b.min_index &&
                            a.dims == b.dims && a.T_world_grid == b.T_world_grid;
    if (kept != nullptr && kept->isa_ == isa && same_place) return kept;
  }
  return std::make_shared<const ObstacleScene>(data, isa);
}

}  // namespace viewgain::detail
