// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "methods/agreement.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::bench {

/// The rays a pose that results are stated for: every pixel of the SR4000 (176×144), every second
/// of every second row, and a camera of 38×25 pixels with the SR4000's field of view, since no
/// stride gives 950.
inline constexpr int kFullRays = 25344, kHalfRays = 6336, kFewRays = 950;

struct RayPattern {
  Sensor sensor;
  GainConfig config;
};
/// Throws Error(invalid_argument) for another number.
[[nodiscard]] RayPattern ray_pattern(int rays_per_pose);

/// 1, 2, ... up to `most`; beyond eight only powers of two and `most` itself.
[[nodiscard]] std::vector<int> thread_counts(int most);

struct ScalingPlan {
  std::vector<int> voxels{64, 128, 256, 512};  ///< a side
  std::vector<int> rays{kFewRays, kHalfRays, kFullRays};
  std::vector<int> threads{1};
  ExecConfig::Tracer tracer = ExecConfig::Tracer::automatic;
  int poses = 100;  ///< at full resolution; with fewer rays as many more as make the rays equal
  int repetitions = 7;
  std::filesystem::path mesh;
};

/// The full gain of a batch under one combination.
struct ScalingCase {
  int voxels = 0;
  int rays_per_pose = 0;
  int num_threads = 0;
  std::size_t poses = 0;
  std::string isa;
  std::vector<double> seconds;  ///< of the batch, one a repetition
  Agreement agreement;          ///< of some of the poses
  bool same_bits = true;        ///< as with the first number of threads

  /// Of the median time, or of another quantile of the times.
  [[nodiscard]] double poses_per_second(double share_of_times = 0.5) const;
  [[nodiscard]] bool agrees() const { return same_bits && agreement.agrees(); }
};

/// All combinations, in turns in every repetition, after one run to warm up. Throws Error.
[[nodiscard]] std::vector<ScalingCase> run_scaling_cases(const ScalingPlan& plan);

}  // namespace viewgain::bench
