// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "viewgain/core/exec_config.hpp"
#include "viewgain/raycast/view_scorer.hpp"

namespace viewgain::bench {

/// What ranks views: a gain, or what others count.
enum class Ranker : std::uint8_t {
  combined,  ///< the combined gain
  surface,   ///< the surface gain
  paper,     ///< the paper's gain
  frontier,  ///< unknown voxels in view
  random,    ///< a hash of seed and step
};
[[nodiscard]] const std::vector<std::string>& ranker_names();
/// Throws Error(invalid_argument) that lists the valid names.
[[nodiscard]] Ranker parse_ranker(const std::string& name);

/// Our side of a protocol of others: a map of our own, and the next of given views.
class ViewChoice {
 public:
  /// A grid of `voxel` [m] in the workspace [m]. Views are scored on every stride-th pixel and row.
  ViewChoice(Ranker ranker, const Sensor& sensor, const Box& workspace, double voxel, int stride,
             std::uint64_t seed, const ExecConfig& exec);

  void add(const DepthFrame& frame, const Pose& T_world_camera);

  /// The best of the poses whose `taken` is 0: of (1 - travel) · value / Σ values - travel ·
  /// distance / Σ distances, both sums over all poses, distances from the pose of the last add().
  /// Ties go to the lower index; nothing if all are taken.
  [[nodiscard]] std::optional<std::size_t> next(std::span<const Pose> T_world_camera,
                                                std::span<const std::uint8_t> taken, double travel);

 private:
  [[nodiscard]] std::vector<double> values(std::span<const Pose> T_world_camera);

  Ranker ranker_;
  std::uint64_t seed_;
  ViewScorer scorer_;        ///< its map stays empty where the choice is random
  std::uint64_t views_ = 0;  ///< added
  Eigen::Vector3d eye_ = Eigen::Vector3d::Zero();
};

}  // namespace viewgain::bench
