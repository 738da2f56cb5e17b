// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <random>
#include <vector>

#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain::test {

/// A frame of the object with all three kinds of pixel, readings too near and too far among them;
/// `out_of_range`: else those are invalid.
[[nodiscard]] DepthFrame mixed_frame(const Sensor& sensor, const Pose& pose, std::mt19937& random,
                                     bool out_of_range = true);

/// The map update of grid/README.md as plain loops over all voxels and all pixels, one entry a
/// voxel. For sensors whose noise does not depend on the angle of incidence.
class VoxelOracle {
 public:
  explicit VoxelOracle(const BeliefGrid& grid);

  void integrate(const Sensor& sensor, const DepthFrame& frame, const Pose& T_world_camera,
                 const IntegrationConfig& config);

  /// Voxels whose state, log-odds or belief is not the grid's: exactly for the first two, beliefs
  /// to single precision. Each of the workspace's voxels is compared.
  [[nodiscard]] std::uint64_t differences(const BeliefGrid& grid) const;

  [[nodiscard]] std::uint64_t voxels() const { return steps_.size(); }
  [[nodiscard]] std::uint64_t crossed() const { return crossed_; }  ///< and not hit, last frame
  [[nodiscard]] std::uint64_t hit() const { return hit_; }          ///< last frame
  /// Readings of the last frame that count for another voxel than the one they lie in.
  [[nodiscard]] std::uint64_t moved() const { return moved_; }

 private:
  struct Fused {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d vector = Eigen::Vector3d::Zero();
    std::uint32_t hits = 0;
  };
  [[nodiscard]] std::size_t position(Index3 voxel) const;
  [[nodiscard]] Eigen::Vector3d center(Index3 voxel) const;
  [[nodiscard]] Index3 voxel_of(std::size_t position) const;
  [[nodiscard]] std::optional<std::size_t> voxel_at(const Eigen::Vector3d& p_grid) const;
  [[nodiscard]] std::size_t best_supported(const Eigen::Vector3d& start, const Eigen::Vector3d& ray,
                                           double sigma,
                                           const std::map<std::size_t, double>& support) const;

  Index3 min_, dims_;
  double voxel_size_;
  Pose T_world_grid_;
  std::vector<int> steps_;  ///< log-odds in steps of 0.05, kUnknown
  std::map<std::size_t, Fused> fused_;
  std::uint64_t crossed_ = 0, hit_ = 0, moved_ = 0;
};

}  // namespace viewgain::test
