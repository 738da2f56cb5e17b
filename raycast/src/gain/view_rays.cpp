// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// All rays of views, for gains that walk them themselves.
#include "viewgain/support/view_rays.hpp"

#include "batch_loop.hpp"
#include "gain_evaluator_impl.hpp"

namespace viewgain {

using namespace detail;

ViewScratch::~ViewScratch() = default;
RayConsumer::~RayConsumer() = default;

std::size_t for_each_view_rays(const GainEvaluator& evaluator, std::span<const Pose> T_world_camera,
                               bool from_occupied, const RayConsumer& consumer,
                               const BatchControl& control) {
  const ViewDriver& driver = EvaluatorAccess::driver(evaluator);
  const ViewDriver::From from =
      from_occupied ? ViewDriver::From::anywhere : ViewDriver::From::outside_occupied;
  return for_each_pose(
      driver, T_world_camera.size(), control, [&](std::size_t i, ViewDriver::Lease& lease) {
        std::unique_ptr<ViewScratch>& scratch = lease.workspace().scratch;
        if (!scratch) scratch = consumer.make_scratch();
        consumer.begin(*scratch);
        ViewGain view;
        if (const auto frame = driver.open(T_world_camera[i], view, from)) {
          const WalkLimits limits = walk_limits(driver.scene(), *frame);
          WalkTask task;
          driver.tracer().place(*frame, [&](std::size_t number, const RayTile& rays) {
            set_up(driver.tracer().table(), number, *frame, rays, task);
            std::fill_n(task.near, kTileRays, 0.0F);
            task.lanes = rays.valid;
            consumer.add(limits, task, *scratch);
          });
          view.status = ViewGain::Status::ok;
        }
        consumer.finish(i, view, *scratch);
      });
}

}  // namespace viewgain
