// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "trace_method.hpp"

#include <vector>

namespace viewgain::bench {

void TraceMethod::run(std::span<const Pose> poses, ThreadPool& pool) {
  pool.for_each_chunk(poses.size(), 1, [&](std::size_t begin, std::size_t end) {
    thread_local std::vector<Ending> endings;
    endings.resize(rays_per_pose_);
    for (std::size_t i = begin; i < end; ++i) trace(poses[i], endings);
  });
}

}  // namespace viewgain::bench
