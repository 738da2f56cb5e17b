// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <octomap/OcTree.h>

#include <array>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "oracle/dense_map.hpp"
#include "oracle/walk.hpp"
#include "viewgain/literature/classic_gains.hpp"

namespace viewgain::test {

/// The classic gains as their definitions say, slowly: the map is an octomap::OcTree, each voxel of
/// each ray is looked up by its key, and each gain goes through the list for itself. Shares no code
/// with raycast/.
class OctomapOracle {
 public:
  OctomapOracle(const BeliefGrid& grid, const Surroundings& surroundings,
                const std::optional<Acquisition>& acquisition);

  /// By ClassicGain, all ten (area_factor and proximity_count need the acquisition). `gains` of the
  /// config is not looked at.
  [[nodiscard]] std::array<double, 10> gains(const Sensor& sensor, const ClassicConfig& config,
                                             const Pose& T_world_camera) const;

  /// In units of voxels, its origin at the workspace's lowest corner.
  [[nodiscard]] int occlusion_steps(Index3 voxel) const;
  [[nodiscard]] bool is_surface_frontier(Index3 voxel) const;

 private:
  struct Visit {
    Index3 voxel;
    double begin, end;                // [voxels]
    const octomap::OcTreeNode* node;  // null: unknown
  };
  struct SeenRay {
    std::vector<Visit> visits;
    double solid_angle;
  };

  [[nodiscard]] const octomap::OcTreeNode* find(Index3 voxel) const;
  // What a ray visits between the limits, to the first occupied voxel if it is to end there.
  [[nodiscard]] std::vector<Visit> visits(const oracle::Ray& ray, double near, double far,
                                          bool ends_in_occupied) const;
  void mark_occlusion(const std::vector<Pose>& views, const Acquisition& acquisition);

  oracle::DenseMap map_;
  Surroundings surroundings_;
  octomap::OcTree tree_;
  std::map<std::tuple<int, int, int>, int> occlusion_;
  double occlusion_depth_ = 0;  // [voxels]
};

}  // namespace viewgain::test
