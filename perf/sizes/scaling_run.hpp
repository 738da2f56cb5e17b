// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "methods/agreement.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::bench {

/// The numbers of rays per pose: every pixel of the SR4000 (176×144), every second pixel of every
/// second row, and a camera of 38×25 pixels with the same field of view, because no stride gives
/// 950.
inline constexpr int kFullRays = 25344, kHalfRays = 6336, kFewRays = 950;

struct RayPattern {
  Sensor sensor;
  GainConfig config;
};
/// Throws Error(invalid_argument) for other numbers.
[[nodiscard]] RayPattern ray_pattern(int rays_per_pose);

/// 1, 2, ... up to `most`; above eight only powers of two and `most` itself.
[[nodiscard]] std::vector<int> thread_counts(int most);

struct ScalingPlan {
  std::vector<int> voxels{64, 128, 256, 512};  ///< per side
  std::vector<int> rays{kFewRays, kHalfRays, kFullRays};
  std::vector<int> threads{1};
  ExecConfig::Tracer tracer = ExecConfig::Tracer::automatic;
  int poses = 100;  ///< at full resolution; with fewer rays, more poses give as many rays
  int repetitions = 7;
  std::filesystem::path mesh;
};

/// The full gain of a batch for one combination.
struct ScalingCase {
  int voxels = 0;
  int rays_per_pose = 0;
  int num_threads = 0;
  std::size_t poses = 0;
  std::string isa;
  std::vector<double> seconds;  ///< time of the batch, one per repetition
  Agreement agreement;          ///< for some of the poses
  bool same_bits = true;        ///< same as with the first number of threads?

  /// By the median time, or by another quantile of the times.
  [[nodiscard]] double poses_per_second(double share_of_times = 0.5) const;
  [[nodiscard]] bool agrees() const { return same_bits && agreement.agrees(); }
};

/// Runs all combinations once per repetition, after one run to warm up. Throws Error.
[[nodiscard]] std::vector<ScalingCase> run_scaling_cases(const ScalingPlan& plan);

}  // namespace viewgain::bench
