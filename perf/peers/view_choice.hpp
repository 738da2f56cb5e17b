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

/// How views are ranked: by a gain, by a count or at random.
enum class Ranker : std::uint8_t {
  combined,  ///< the combined gain
  surface,   ///< the surface gain
  paper,     ///< the paper's gain
  frontier,  ///< the number of unknown voxels in view
  random,    ///< by a hash of seed and step
};
[[nodiscard]] const std::vector<std::string>& ranker_names();
/// Throws Error(invalid_argument) that lists the valid names.
[[nodiscard]] Ranker parse_ranker(const std::string& name);

/// Our side of another system's protocol: a map, and the choice of the next of given views.
class ViewChoice {
 public:
  /// Voxels of `voxel` [m] in the workspace [m]. Views are scored on every stride-th pixel and row.
  ViewChoice(Ranker ranker, const Sensor& sensor, const Box& workspace, double voxel, int stride,
             std::uint64_t seed, const ExecConfig& exec);

  void add(const DepthFrame& frame, const Pose& T_world_camera);

  /// The index of the best pose with `taken` 0, or nothing if all are taken. The score is
  /// (1 - travel) · value / Σ values - travel · distance / Σ distances. Both sums are over all
  /// poses. Distances are from the pose of the last add(). Ties go to the lower index.
  [[nodiscard]] std::optional<std::size_t> next(std::span<const Pose> T_world_camera,
                                                std::span<const std::uint8_t> taken, double travel);

 private:
  [[nodiscard]] std::vector<double> values(std::span<const Pose> T_world_camera);

  Ranker ranker_;
  std::uint64_t seed_;
  ViewScorer scorer_;        ///< its map stays empty if the choice is random
  std::uint64_t views_ = 0;  ///< number of added views
  Eigen::Vector3d eye_ = Eigen::Vector3d::Zero();
};

}  // namespace viewgain::bench
