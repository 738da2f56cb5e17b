// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "peer_map.hpp"

#include "methods/octomap_tree.hpp"

namespace viewgain::bench {
PeerMap::PeerMap(const Eigen::Vector3d& center, double size)
    : low_(center - Eigen::Vector3d::Constant(size)),
      high_(center + Eigen::Vector3d::Constant(size)),
      tree_(kVoxel) {
  tree_.setProbHit(0.7);
  tree_.setProbMiss(0.4);
  // Theirs steps by a voxel from the low corner, so that the last layer is set where a step falls
  // into it.
  for (double x = low_.x(); x <= high_.x(); x += kVoxel) {
    for (double y = low_.y(); y <= high_.y(); y += kVoxel) {
      for (double z = low_.z(); z <= high_.z(); z += kVoxel) {
        tree_.setNodeValue(octomap_point({x, y, z}), 0.0F, true);
      }
    }
  }
  tree_.updateInnerOccupancy();
}

void PeerMap::insert(std::span<const octomap::point3d> hits, const Eigen::Vector3d& eye) {
  octomap::Pointcloud cloud;
  for (const octomap::point3d& hit : hits) cloud.push_back(hit);
  // Lazily, which also keeps voxels from being merged.
  tree_.insertPointCloud(cloud, octomap_point(eye), -1, true);
  tree_.updateInnerOccupancy();
}

std::size_t PeerMap::occupied() const {
  std::size_t count = 0;
  for (auto leaf = tree_.begin_leafs(), end = tree_.end_leafs(); leaf != end; ++leaf) {
    const Eigen::Vector3d p(leaf.getX(), leaf.getY(), leaf.getZ());
    const bool inside = (p.array() >= low_.array()).all() && (p.array() <= high_.array()).all();
    if (inside && leaf->getOccupancy() > kOccupiedAbove) ++count;
  }
  return count;
}

std::size_t PeerMap::voxels_of(const std::vector<Eigen::Vector3d>& points) {
  const octomap::OcTree tree(kVoxel);
  octomap::KeySet voxels;
  for (const Eigen::Vector3d& p : points) voxels.insert(tree.coordToKey(octomap_point(p)));
  return voxels.size();
}

}  // namespace viewgain::bench
