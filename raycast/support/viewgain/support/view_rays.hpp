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

/// What a RayConsumer keeps while a view is walked. Used by one thread at a time, for view after
/// view.
class VIEWGAIN_EXPORT ViewScratch {
 public:
  virtual ~ViewScratch();
};

/// What becomes of the rays of views. Members are called from many threads at once. What they throw
/// ends the batch.
class VIEWGAIN_EXPORT RayConsumer {
 public:
  virtual ~RayConsumer();
  [[nodiscard]] virtual std::unique_ptr<ViewScratch> make_scratch() const = 0;
  /// Once a view.
  virtual void begin(ViewScratch& scratch) const = 0;
  /// Its tiles, in order.
  virtual void add(const detail::WalkLimits& limits, const detail::WalkTask& task,
                   ViewScratch& scratch) const = 0;
  /// `view` has only rays and status. Where that is bad_pose, or camera_in_occupied, no tile was
  /// added.
  virtual void finish(std::size_t i, const ViewGain& view, ViewScratch& scratch) const = 0;
};

/// Hands over all rays of views, each until an obstacle or max_range, nothing traced but obstacles:
/// for libraries that walk rays through voxels of their own (brick_walk-inl.hpp). `from_occupied`:
/// also those of a camera in an occupied voxel. An evaluator's calls are for one kind of consumer.
/// Returns how many views were finished: all, unless `control` ended the call.
VIEWGAIN_EXPORT std::size_t for_each_view_rays(const GainEvaluator& evaluator,
                                               std::span<const Pose> T_world_camera,
                                               bool from_occupied, const RayConsumer& consumer,
                                               const BatchControl& control = {});

}  // namespace viewgain
