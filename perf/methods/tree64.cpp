// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "tree64.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

namespace viewgain::bench {
namespace {

constexpr int kMostLevels = 8;

// Children of a node are those of its bits, in order, from `first` on; of the lowest level there
// are none: bits are voxels. A bit is x << 4 | y << 2 | z.
struct Node {
  std::uint64_t bits = 0;
  std::uint32_t first = 0;
};

struct Tree64 {
  int levels = 1;           // of nodes; the root is a cube of 4^levels voxels
  std::vector<Node> nodes;  // the root first

  explicit Tree64(const oracle::DenseMap& map) : map_(map) {
    const int edge = std::max({map.dims.x, map.dims.y, map.dims.z});
    while ((1 << (2 * levels)) < edge) ++levels;
    nodes.resize(1);
    fill(0, {0, 0, 0}, levels);
  }

 private:
  // What lies in a cube of 4^level voxels. Breadth within a node first, so that siblings adjoin.
  void fill(std::size_t node, Index3 low, int level) {
    const int edge = 1 << (2 * (level - 1));  // of a child
    std::vector<Index3> children;
    std::uint64_t bits = 0;
    for (unsigned i = 0; i < 64; ++i) {
      const Index3 at{low.x + static_cast<int>(i >> 4U) * edge,
                      low.y + static_cast<int>(i >> 2U & 3U) * edge,
                      low.z + static_cast<int>(i & 3U) * edge};
      if (!holds_any(at, edge)) continue;
      bits |= std::uint64_t{1} << i;
      children.push_back(at);
    }
    nodes[node].bits = bits;
    if (level == 1) return;
    const std::size_t first = nodes.size();
    nodes[node].first = static_cast<std::uint32_t>(first);
    nodes.resize(first + children.size());
    for (std::size_t i = 0; i < children.size(); ++i) fill(first + i, children[i], level - 1);
  }
  [[nodiscard]] bool holds_any(Index3 low, int edge) const {
    const Index3 end{std::min(low.x + edge, map_.dims.x), std::min(low.y + edge, map_.dims.y),
                     std::min(low.z + edge, map_.dims.z)};
    for (int x = low.x; x < end.x; ++x) {
      for (int y = low.y; y < end.y; ++y) {
        for (int z = low.z; z < end.z; ++z) {
          const Index3 voxel{map_.min_index.x + x, map_.min_index.y + y, map_.min_index.z + z};
          if (map_.state(voxel) != VoxelState::free) return true;
        }
      }
    }
    return false;
  }

  const oracle::DenseMap& map_;
};

class Tree64Method final : public TraceMethod {
 public:
  explicit Tree64Method(const TraceTask& task)
      : TraceMethod("tree64", task.sensor.camera.ray_table().size()),
        map_(task.map),
        T_grid_world_(task.map.T_world_grid.inverse()),
        max_range_(static_cast<float>(task.sensor.max_range / task.map.voxel_size)),
        dims_{task.map.dims.x, task.map.dims.y, task.map.dims.z},
        tree_(task.map) {
    for (const Eigen::Vector3d& d : task.sensor.camera.ray_table()) {
      directions_.push_back(d.normalized());
    }
  }

  void trace(const Pose& T_world_camera, std::span<Ending> endings) const override {
    const Pose T_grid_camera = T_grid_world_ * T_world_camera;
    const Index3 low = map_.min_index;
    const Eigen::Vector3f o =
        (T_grid_camera.translation() / map_.voxel_size - Eigen::Vector3d(low.x, low.y, low.z))
            .cast<float>();
    const Eigen::Matrix3d R = T_grid_camera.rotation();
    for (std::size_t i = 0; i < directions_.size(); ++i) {
      endings[i] = ending_of(o, (R * directions_[i]).cast<float>());
    }
  }

 private:
  [[nodiscard]] Ending ending_of(const Eigen::Vector3f& o, const Eigen::Vector3f& d) const {
    std::array<float, 3> inverse;
    std::array<int, 3> at;
    float t = 0, end = max_range_;
    for (int a = 0; a < 3; ++a) {
      const auto k = static_cast<std::size_t>(a);
      inverse[k] = 1.0F / (d[a] != 0 ? d[a] : 1e-20F);
      const float first = -o[a] * inverse[k],
                  last = (static_cast<float>(dims_[k]) - o[a]) * inverse[k];
      t = std::max(t, std::min(first, last)), end = std::min(end, std::max(first, last));
    }
    if (!(t < end)) return kMiss;
    for (int a = 0; a < 3; ++a) {
      const auto k = static_cast<std::size_t>(a);
      at[k] = std::clamp(static_cast<int>(o[a] + d[a] * t), 0, dims_[k] - 1);
    }
    std::array<std::uint32_t, kMostLevels + 1> path{};  // nodes by level; the root at tree_.levels
    int level = tree_.levels;
    while (true) {
      // Down to the cell that the ray is in: empty, or a voxel.
      unsigned bit = 0;
      std::uint64_t bits = 0;
      while (true) {
        const Node& node = tree_.nodes[path[static_cast<std::size_t>(level)]];
        const auto shift = static_cast<unsigned>(2 * (level - 1));
        const auto part = [&](std::size_t k) { return static_cast<unsigned>(at[k]) >> shift & 3U; };
        bit = part(0) << 4U | part(1) << 2U | part(2);
        bits = node.bits;
        if ((bits >> bit & 1U) == 0) break;
        if (level == 1) {
          return static_cast<Ending>(map_.position(
              {map_.min_index.x + at[0], map_.min_index.y + at[1], map_.min_index.z + at[2]}));
        }
        path[static_cast<std::size_t>(level - 1)] =
            node.first +
            static_cast<std::uint32_t>(std::popcount(bits & ((std::uint64_t{1} << bit) - 1)));
        --level;
      }
      // 2³ cells that are empty are left together.
      constexpr std::uint64_t kEight = 0x0000000000330033;
      const bool is_pair = (bits & kEight << (bit & 0x2AU)) == 0;
      const int edge = 1 << (2 * (level - 1) + (is_pair ? 1 : 0));
      std::array<float, 3> leaves;
      std::array<int, 3> low;
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = at[k] & -edge;
        leaves[k] =
            (static_cast<float>(inverse[k] > 0 ? low[k] + edge : low[k]) - o[static_cast<int>(k)]) *
            inverse[k];
      }
      const float exit = std::min(leaves[0], std::min(leaves[1], leaves[2]));
      if (!(exit < end)) return kMiss;
      unsigned moved = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const int before = at[k];
        if (leaves[k] <= exit) {
          at[k] = inverse[k] > 0 ? low[k] + edge : low[k] - 1;
        } else {
          at[k] =
              std::clamp(static_cast<int>(o[static_cast<int>(k)] + d[static_cast<int>(k)] * exit),
                         low[k], low[k] + edge - 1);
        }
        if (at[k] < 0 || at[k] >= dims_[k]) return kMiss;
        moved |= static_cast<unsigned>(before ^ at[k]);
      }
      // The lowest node on the stack that still holds it.
      while (level < tree_.levels && moved >> (2 * level) != 0) ++level;
    }
  }

  const oracle::DenseMap& map_;
  Pose T_grid_world_;
  float max_range_;  // [voxel]
  std::array<int, 3> dims_;
  std::vector<Eigen::Vector3d> directions_;
  Tree64 tree_;
};

}  // namespace

std::unique_ptr<TraceMethod> make_tree64_method(const TraceTask& task) {
  return std::make_unique<Tree64Method>(task);
}

}  // namespace viewgain::bench
