// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "block_kernels.hpp"
#include "cone_evidence.hpp"
#include "evidence.hpp"
#include "frame_hits.hpp"
#include "line_evidence.hpp"
#include "readings.hpp"
#include "scale_plan.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// Voxels changed by one frame.
struct ApplyCounts {
  std::uint64_t hit = 0;
  std::uint64_t crossed = 0;  ///< and not hit
};

/// Last stage of a frame: applies hits and evidence to a grid, region by region.
class FrameApply {
 public:
  FrameApply(const BlockKernels& kernels, bool literal);
  ~FrameApply();
  FrameApply(const FrameApply&) = delete;
  FrameApply& operator=(const FrameApply&) = delete;

  /// Changes states, log-odds and beliefs and appends the frame's view. If memory runs out, the
  /// grid has some of the frame's hits and crossings, but not the view. For ConeEvidence and
  /// LineEvidence.
  template <Evidence E>
  ApplyCounts run(BeliefGrid& grid, const PlacedFrame& frame, const E& evidence, FrameHits& hits,
                  const ScalePlan& plan, ThreadPool& pool);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain::detail
