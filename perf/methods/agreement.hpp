// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "oracle/walk.hpp"
#include "trace_method.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::bench {

/// Comparison of a method's answers with those of the oracle.
struct Agreement {
  std::size_t rays = 0;
  std::size_t same = 0;
  /// Rays that differ and pass within 1e-4 voxel of a boundary between the two answers.
  std::size_t ties = 0;

  Agreement& operator+=(const Agreement& o) {
    rays += o.rays, same += o.same, ties += o.ties;
    return *this;
  }
  [[nodiscard]] double share() const {
    return static_cast<double>(same) / static_cast<double>(std::max<std::size_t>(rays, 1));
  }
  [[nodiscard]] std::size_t wrong() const { return rays - same - ties; }
  [[nodiscard]] bool agrees() const { return share() >= 0.9999 && wrong() == 0; }
};

/// The ends of all rays of the task's poses by the oracle (double precision, tests/oracle), at full
/// resolution. Computed once for all methods. Refers to the task. Thread safe after construction.
class OracleEndings {
 public:
  OracleEndings(const TraceTask& task, ThreadPool& pool);

  /// Compares a method's answers on some of the task's poses with these.
  [[nodiscard]] Agreement compare(const TraceMethod& method, std::span<const Pose> poses,
                                  ThreadPool& pool) const;

 private:
  [[nodiscard]] Agreement compare(const Pose& pose, std::span<const Ending> actual) const;

  const TraceTask& task_;
  oracle::RayLimits limits_;
  std::size_t rays_per_pose_;
  std::vector<Ending> endings_;
};

/// The same for the endings that an evaluator with this sensor and config uses.
[[nodiscard]] Agreement compare_with_oracle(const oracle::DenseMap& map, const Sensor& sensor,
                                            const GainConfig& config,
                                            const GainEvaluator& evaluator,
                                            std::span<const Pose> poses);

}  // namespace viewgain::bench
