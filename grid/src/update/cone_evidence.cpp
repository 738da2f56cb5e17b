// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "cone_evidence.hpp"

namespace viewgain::detail {

void ConeEvidence::gather(const Readings& readings, const ConeCamera& camera, double voxel_size) {
  readings_ = &readings;
  camera_ = &camera;
  voxel_size_ = voxel_size;
  pyramid_.build(readings.reach_taper(), camera.width, camera.height);
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

// A cell's centre stands for it: the block's cells are voxels of a coarser lattice.
bool ConeEvidence::deltas(std::uint64_t /*key*/, Index3 origin, int scale,
                          std::int8_t* deltas) const {
  const bool any = kernels_.project(
      *camera_, readings_->reach_taper().data(), voxel_size_ * (1 << scale),
      {origin.x >> scale, origin.y >> scale, origin.z >> scale}, kBlockSize >> scale, deltas);
  // Spread downwards in place: a cell's entry lies before those of its voxels.
  const auto s = static_cast<unsigned>(scale);
  for (unsigned i = kBlockVoxels; scale > 0 && i-- > 0;) {
    deltas[i] = deltas[(i >> 6U) >> s << 6U | (i >> 3U & 7U) >> s << 3U | (i & 7U) >> s];
  }
  return any;
}

}  // namespace viewgain::detail
