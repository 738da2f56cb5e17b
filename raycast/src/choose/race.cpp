// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The best views of a batch, very probably: all are scored by few of their rays, the best of these
// in full.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "gain/batch_loop.hpp"
#include "gain/gain_evaluator_impl.hpp"
#include "gain/sampled_views.hpp"
#include "race_by_measure.hpp"
#include "ranking.hpp"
#include "ray_lattices.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

// So few poses are scored in full without ado.
constexpr std::size_t kFewPoses = 24;

// All poses are scored by about so many rays of the image, and at least this share of them in full.
constexpr double kCoarseRays = 400;
constexpr double kInFull = 0.016, kInFullByPaper = 0.05;

struct Estimate {
  std::size_t index = 0;
  double gain = 0;
};

// The poses that are still in, and what they were compared by.
struct Field {
  std::vector<Estimate> poses;
  std::uint64_t rays_traced = 0;

  // The best first, ties to the lower index, without those that have no gain.
  void sort() {
    std::erase_if(poses, [](const Estimate& e) { return std::isnan(e.gain); });
    std::sort(poses.begin(), poses.end(), [](const Estimate& a, const Estimate& b) {
      return a.gain != b.gain ? a.gain > b.gain : a.index < b.index;
    });
  }
};

using Report = std::function<void(std::size_t done)>;

// So many poses are scored in full in the second stage.
std::size_t in_second_stage(std::size_t k, std::size_t poses, double share) {
  return std::max(
      {kFewPoses, 4 * k, static_cast<std::size_t>(std::ceil(share * static_cast<double>(poses)))});
}

// Leaves those `few` that score best by a lattice of their rays; all where images have no more rays
// than that. False if it was stopped.
bool choose_by_few_rays(const detail::ViewDriver& driver, const VoxelScene& scene,
                        std::span<const Pose> T_world_camera, std::size_t few,
                        const RaceConfig& config, const BatchControl& control, const Report& report,
                        Field& field) {
  const detail::EvaluatorCore& core = *driver.core();
  const int step = detail::step_for_rays(core, kCoarseRays);
  if (step <= 1) return true;
  const detail::SampledViews coarse(scene, driver,
                                    driver.surface() == nullptr
                                        ? detail::random_lattice(core, step, config.seed)
                                        : detail::centred_lattice(core, step));
  const bool complete = detail::for_each(
      driver, field.poses.size(), control, [&](std::size_t j, detail::ViewDriver::Lease& lease) {
        Estimate& e = field.poses[j];
        e.gain = coarse.estimate(T_world_camera[e.index], lease).gain;
        if (!config.costs.empty()) e.gain -= config.costs[e.index];
      });
  if (!complete) return false;
  field.rays_traced += std::uint64_t{coarse.rays()} * field.poses.size();
  field.sort();
  if (field.poses.size() > few) field.poses.resize(few);
  report(T_world_camera.size() - field.poses.size());
  return true;
}

}  // namespace

RacedViews GainEvaluator::race(std::span<const Pose> T_world_camera, std::size_t k,
                               const RaceConfig& config, const BatchControl& control) const {
  const std::size_t count = T_world_camera.size();
  detail::check_costs(config.costs, count);
  k = std::min(k, count);
  if (config.measure != nullptr && config.run_measure != nullptr) {
    throw Error(ErrorCode::invalid_argument, "views are chosen by one measure, not by two");
  }
  RacedViews best;
  if (k == 0) return best;
  if (config.measure != nullptr || config.run_measure != nullptr) {
    const detail::EvaluatorCore& core = *impl_->driver.core();
    std::optional<GainEvaluator> coarse;
    if (const int step = detail::step_for_rays(core, kCoarseRays); step > 1) {
      coarse = GainEvaluator(std::make_unique<Impl>(
          impl_->scene,
          std::make_shared<detail::EvaluatorCore>(core, detail::centred_lattice(core, step))));
    }
    return detail::race_by_measure(*this, coarse ? &*coarse : nullptr, T_world_camera, k,
                                   in_second_stage(k, count, kInFull), config, control);
  }
  // Poses are done when they are out.
  const Report report = [&](std::size_t done) {
    if (control.progress) control.progress(done, count);
  };
  report(0);
  const detail::ViewDriver& driver = impl_->driver;
  Field field;
  field.poses.resize(count);
  for (std::size_t i = 0; i < count; ++i) field.poses[i].index = i;
  const std::size_t few =
      in_second_stage(k, count, driver.surface() == nullptr ? kInFullByPaper : kInFull);
  best.complete = count <= few || choose_by_few_rays(driver, *impl_->scene, T_world_camera, few,
                                                     config, control, report, field);
  best.rays_traced = field.rays_traced;
  if (!best.complete) return best;

  // Too few finite estimates for k poses: the others make up the number, NaN and all.
  std::vector<std::uint8_t> in_field(count, 0);
  for (const Estimate& e : field.poses) in_field[e.index] = 1;
  for (std::size_t i = 0; i < count && field.poses.size() < k; ++i) {
    if (in_field[i] == 0) field.poses.push_back({i, 0});
  }
  for (const Estimate& e : field.poses) best.scored_indices.push_back(e.index);
  std::sort(best.scored_indices.begin(), best.scored_indices.end());
  best.scored_gains.resize(best.scored_indices.size());
  best.complete = detail::for_each(driver, best.scored_indices.size(), control,
                                   [&](std::size_t j, detail::ViewDriver::Lease& lease) {
                                     best.scored_gains[j] = driver.evaluate(
                                         T_world_camera[best.scored_indices[j]], lease);
                                   });
  if (!best.complete) {
    // Those that were not reached look like bad poses.
    std::size_t kept = 0;
    for (std::size_t j = 0; j < best.scored_gains.size(); ++j) {
      if (std::isnan(best.scored_gains[j].gain)) continue;
      best.scored_indices[kept] = best.scored_indices[j];
      best.scored_gains[kept++] = best.scored_gains[j];
    }
    best.scored_indices.resize(kept);
    best.scored_gains.resize(kept);
  }
  best.rays_traced += best.scored_indices.size() * std::uint64_t{driver.core()->ray_count};
  std::vector<double> worth;
  for (std::size_t j = 0; j < best.scored_gains.size(); ++j) {
    const double cost = config.costs.empty() ? 0.0 : config.costs[best.scored_indices[j]];
    worth.push_back(best.scored_gains[j].gain - cost);
  }
  for (const std::size_t j : detail::largest(worth, k)) {
    best.indices.push_back(best.scored_indices[j]);
    best.gains.push_back(best.scored_gains[j]);
    best.worth.push_back(worth[j]);
  }
  if (best.complete) report(count);
  return best;
}

}  // namespace viewgain
