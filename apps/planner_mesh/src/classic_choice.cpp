// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/planner_mesh/classic_choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace viewgain {
namespace {

// At which a view has about 400 rays, which rank views nearly as well as all.
int coarse_stride(const PinholeCamera& camera) {
  const double pixels = static_cast<double>(camera.width) * camera.height;
  return std::max(1, static_cast<int>(std::lround(std::sqrt(pixels / 400))));
}

}  // namespace

ClassicChoice::ClassicChoice(const SurfaceModel& model, const Sensor& sensor, ClassicGain gain,
                             const ExecConfig& exec)
    : model_(model), sensor_(sensor), gain_(gain), exec_(exec) {}

std::vector<double> ClassicChoice::gains(std::span<const Pose> T_world_camera, bool all) {
  const auto acquisition =
      needs_occlusion(gain_) ? std::optional(Acquisition{sensor_}) : std::nullopt;
  const auto map = ClassicMap::build(model_.scene(), model_.grid(), acquisition, exec_);
  const auto follow = [&](std::optional<ClassicGainEvaluator>& evaluator, int stride) {
    if (evaluator) {
      evaluator = evaluator->with_map(map);
      return;
    }
    ClassicConfig config;
    config.gains = {gain_};
    config.pixel_stride = stride;
    evaluator.emplace(map, sensor_, config, exec_);
  };
  follow(full_, 1);
  if (all || T_world_camera.size() <= kInFull) return full_->evaluate(T_world_camera);

  follow(coarse_, coarse_stride(sensor_.camera));
  std::vector<double> few = coarse_->evaluate(T_world_camera);
  for (double& gain : few) {
    if (std::isnan(gain)) gain = -std::numeric_limits<double>::infinity();
  }
  std::vector<std::size_t> order(few.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return few[a] > few[b]; });
  order.resize(kInFull);
  std::vector<Pose> best;
  for (const std::size_t i : order) best.push_back(T_world_camera[i]);
  const std::vector<double> exact = full_->evaluate(best);
  std::vector<double> gains(few.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < order.size(); ++k) gains[order[k]] = exact[k];
  return gains;
}

}  // namespace viewgain
