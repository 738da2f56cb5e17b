// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Gains from a lattice of a view's rays.
#include <algorithm>
#include <optional>
#include <string>

#include "gain/batch_loop.hpp"
#include "gain/gain_evaluator_impl.hpp"
#include "gain/sampled_views.hpp"
#include "ray_lattices.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {

std::size_t GainEvaluator::approximate(std::span<const Pose> T_world_camera,
                                       std::span<ApproximateGain> results,
                                       const ApproximateConfig& config,
                                       const BatchControl& control) const {
  if (!(config.share > 0 && config.share <= 1)) {
    throw Error(
        ErrorCode::invalid_argument,
        std::string("share of the rays is ") + short_text(config.share) + "; it must be in (0, 1]");
  }
  detail::check_room(T_world_camera.size(), results.size());
  std::fill(results.begin(), results.end(), ApproximateGain{});
  const detail::ViewDriver& driver = impl_->driver;
  const detail::EvaluatorCore& core = *driver.core();
  const int step = detail::step_for_share(core, config.share);
  std::optional<detail::SampledViews> sample;
  if (step > 1) {
    sample.emplace(*impl_->scene, driver, detail::random_lattice(core, step, config.seed));
  }
  return detail::for_each_pose(
      driver, results.size(), control, [&](std::size_t i, detail::ViewDriver::Lease& lease) {
        if (sample) {
          results[i] = sample->estimate(T_world_camera[i], lease);
          results[i].rays = sample->rays();
          return;
        }
        const ViewGain whole = driver.evaluate(T_world_camera[i], lease);
        results[i] = {whole.gain, whole.status == ViewGain::Status::bad_pose ? whole.gain : 0.0,
                      whole.rays};
      });
}

}  // namespace viewgain
