// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "octomap_tree.hpp"

#include <algorithm>
#include <cmath>

namespace viewgain::bench {
namespace {

constexpr float kHit = 0.85F;
constexpr float kMiss = -0.4F;

double probability(double log_odds) { return 1 / (1 + std::exp(-log_odds)); }

}  // namespace

octomap::OcTreeKey key_of(Index3 voxel) {
  const auto key = [](std::int32_t i) {
    return static_cast<octomap::key_type>(i + kOctomapKeyOffset);
  };
  return {key(voxel.x), key(voxel.y), key(voxel.z)};
}

Index3 voxel_of(const octomap::OcTreeKey& key) {
  return {key[0] - kOctomapKeyOffset, key[1] - kOctomapKeyOffset, key[2] - kOctomapKeyOffset};
}

octomap::point3d octomap_point(const Eigen::Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

std::unique_ptr<octomap::OcTree> empty_octree(double voxel_size) {
  auto tree = std::make_unique<octomap::OcTree>(voxel_size);
  tree->setProbHit(probability(static_cast<double>(kHit)));
  tree->setProbMiss(probability(static_cast<double>(kMiss)));
  tree->setClampingThresMin(probability(-2.0));
  tree->setClampingThresMax(probability(3.5));
  return tree;
}

std::unique_ptr<octomap::OcTree> octree_of(const oracle::DenseMap& map) {
  auto tree = empty_octree(map.voxel_size);
  for (int x = 0; x < map.dims.x; ++x) {
    for (int y = 0; y < map.dims.y; ++y) {
      for (int z = 0; z < map.dims.z; ++z) {
        const Index3 voxel{map.min_index.x + x, map.min_index.y + y, map.min_index.z + z};
        const VoxelState state = map.state(voxel);
        if (state == VoxelState::unknown) continue;
        tree->setNodeValue(key_of(voxel), state == VoxelState::occupied ? kHit : kMiss, true);
      }
    }
  }
  tree->updateInnerOccupancy();
  tree->prune();
  return tree;
}

std::optional<ClippedSegment> clip_to_workspace(const oracle::DenseMap& map,
                                                const Eigen::Vector3d& from,
                                                const Eigen::Vector3d& to) {
  const double v = map.voxel_size;
  const Eigen::Vector3d low =
      v * Eigen::Vector3d(map.min_index.x, map.min_index.y, map.min_index.z);
  const Eigen::Vector3d high = low + v * Eigen::Vector3d(map.dims.x, map.dims.y, map.dims.z);
  const Eigen::Vector3d d = to - from;
  double begin = 0;
  double end = 1;
  for (int k = 0; k < 3; ++k) {
    if (d[k] == 0) {
      if (from[k] < low[k] || from[k] >= high[k]) return std::nullopt;
      continue;
    }
    const double a = (low[k] - from[k]) / d[k];
    const double b = (high[k] - from[k]) / d[k];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  if (!(begin < end)) return std::nullopt;
  const auto inside = [&](double s) -> Eigen::Vector3d {
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(1e-5 * v);
    return (from + s * d).cwiseMax(low + margin).cwiseMin(high - margin);
  };
  return ClippedSegment{inside(begin), inside(end), end < 1};
}

}  // namespace viewgain::bench
