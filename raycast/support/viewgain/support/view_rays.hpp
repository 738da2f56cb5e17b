// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "viewgain/core/export.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/walk_task.hpp"

namespace viewgain {

/// State of a RayConsumer for one view. Used by one thread at a time, and reused for later views.
class VIEWGAIN_EXPORT ViewScratch {
 public:
  virtual ~ViewScratch();
};

/// Receives the rays of views. Members are called from many threads at once. An exception ends the
/// batch.
class VIEWGAIN_EXPORT RayConsumer {
 public:
  virtual ~RayConsumer();
  [[nodiscard]] virtual std::unique_ptr<ViewScratch> make_scratch() const = 0;
  /// Called once per view.
  virtual void begin(ViewScratch& scratch) const = 0;
  /// Called for each tile of the view, in order.
  virtual void add(const detail::WalkLimits& limits, const detail::WalkTask& task,
                   ViewScratch& scratch) const = 0;
  /// `view` has only rays and status. With status bad_pose or camera_in_occupied no tile was added.
  virtual void finish(std::size_t i, const ViewGain& view, ViewScratch& scratch) const = 0;
};

/// Passes all rays of views to a consumer, each up to an obstacle or max_range. Traces only
/// obstacles: for libraries that walk rays through their own voxels (brick_walk-inl.hpp).
/// `from_occupied`: also for a camera in an occupied voxel. All calls with one evaluator must use
/// the same kind of consumer. Returns the number of finished views, which is less than all if
/// `control` ended the call.
VIEWGAIN_EXPORT std::size_t for_each_view_rays(const GainEvaluator& evaluator,
                                               std::span<const Pose> T_world_camera,
                                               bool from_occupied, const RayConsumer& consumer,
                                               const BatchControl& control = {});

}  // namespace viewgain
