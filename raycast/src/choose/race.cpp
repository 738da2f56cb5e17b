// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The best views of a batch, very probably: by successive halving, or in two stages where rays go
// on through unknown voxels.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "gain/batch_loop.hpp"
#include "gain/gain_evaluator_impl.hpp"
#include "race_by_measure.hpp"
#include "ranking.hpp"
#include "tile_sample.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/text.hpp"

namespace viewgain {
namespace {

constexpr std::size_t kGroups = 4;
// Each round traces this many times the tiles of the one before, up to this share of all; the first
// what was asked for.
constexpr double kGrowth = 5, kLastShare = 0.25;
// Fewer tiles a group say nothing.
constexpr double kLeastTiles = 8;
// So few poses are scored in full without ado.
constexpr std::size_t kFewPoses = 32;

void check(const RaceConfig& config) {
  const auto reject = [](const char* name, double value, const char* rule) {
    throw Error(ErrorCode::invalid_argument,
                std::string(name) + " is " + short_text(value) + "; it must be in " + rule);
  };
  if (!(config.interval > 0 && config.interval < 1e6)) {
    reject("interval", config.interval, "(0, 1e6)");
  }
  if (!(config.first_share > 0 && config.first_share <= 1)) {
    reject("first share", config.first_share, "(0, 1]");
  }
  if (!(config.keep > 0 && config.keep <= 1)) reject("share to keep", config.keep, "(0, 1]");
}

// Of the surface and the combined gain all poses are scored by about so many rays of the image, and
// at least this share of them in full.
constexpr double kCoarseRays = 400;
constexpr double kInFull = 0.015;

struct Estimate {
  std::size_t index = 0;
  double gain = 0, standard_error = 0;
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

// Every so manieth pixel and row leave about kCoarseRays.
int coarse_step(const detail::EvaluatorCore& core) {
  return static_cast<int>(std::lround(std::sqrt(core.ray_count / kCoarseRays)));
}

// So many poses are scored in full in the second stage.
std::size_t in_second_stage(std::size_t k, std::size_t poses) {
  return std::max({kFewPoses, 4 * k,
                   static_cast<std::size_t>(std::ceil(kInFull * static_cast<double>(poses)))});
}

// Leaves those `few` that score best on every so manieth pixel and row; all where images have no
// more rays than that. False if it was stopped.
bool choose_by_coarse_rays(const detail::ViewDriver& driver, const VoxelScene& scene,
                           std::span<const Pose> T_world_camera, std::size_t few,
                           std::span<const double> costs, const BatchControl& control,
                           const Report& report, Field& field) {
  const detail::EvaluatorCore& core = *driver.core();
  const int every = coarse_step(core);
  if (every <= 1) return true;
  const int stride = core.config.pixel_stride * every;
  const detail::ViewDriver coarse(scene, std::make_shared<detail::EvaluatorCore>(core, stride));
  const bool complete = detail::for_each(
      driver, field.poses.size(), control, [&](std::size_t j, detail::ViewDriver::Lease& lease) {
        Estimate& e = field.poses[j];
        e.gain = coarse.evaluate(T_world_camera[e.index], lease).gain;
        if (!costs.empty()) e.gain -= costs[e.index];
      });
  if (!complete) return false;
  field.rays_traced += std::uint64_t{coarse.core()->ray_count} * field.poses.size();
  field.sort();
  if (field.poses.size() > few) field.poses.resize(few);
  report(T_world_camera.size() - field.poses.size());
  return true;
}

// Successive halving, until there are no more than `few`. False if it was stopped.
bool choose_by_bundles(const detail::ViewDriver& driver, std::span<const Pose> T_world_camera,
                       std::size_t k, std::size_t few, const RaceConfig& config,
                       const BatchControl& control, const Report& report, Field& field) {
  const detail::TileTable& table = driver.tracer().table();
  std::vector<Estimate>& poses = field.poses;
  for (double share = config.first_share;
       share <= std::max(kLastShare, config.first_share) && poses.size() > few; share *= kGrowth) {
    // Bundles are nested: each round's begin with those of the round before.
    const auto per_group = static_cast<std::size_t>(std::max(
        kLeastTiles, std::round(share * static_cast<double>(table.tile_count) / double{kGroups})));
    const auto tiles = detail::random_tiles(table, kGroups, per_group, config.seed);
    std::uint64_t rays = 0;
    for (const auto& group : tiles) rays += detail::rays_of(table, group);
    const double part = static_cast<double>(rays) / driver.core()->ray_count;
    const bool complete = detail::for_each(
        driver, poses.size(), control, [&](std::size_t j, detail::ViewDriver::Lease& lease) {
          std::array<double, kGroups> gains;
          detail::sample(driver, T_world_camera[poses[j].index], tiles, gains, lease);
          double sum = 0, squares = 0;
          for (const double gain : gains) sum += gain, squares += gain * gain;
          constexpr auto n = static_cast<double>(kGroups);
          poses[j].gain = sum;
          if (!config.costs.empty()) poses[j].gain -= part * config.costs[poses[j].index];
          poses[j].standard_error = std::sqrt(std::max(0.0, squares - sum * sum / n) * n / (n - 1));
        });
    if (!complete) return false;
    field.rays_traced += rays * poses.size();

    field.sort();
    if (poses.size() <= few) break;
    // Who is left: at most a share, and of those who may still be among the k best.
    std::vector<double> least;
    for (const Estimate& e : poses) least.push_back(e.gain - config.interval * e.standard_error);
    std::nth_element(least.begin(), least.begin() + static_cast<std::ptrdiff_t>(k - 1), least.end(),
                     std::greater<>());
    const double to_reach = least[k - 1];
    const auto kept =
        static_cast<std::size_t>(std::ceil(config.keep * static_cast<double>(poses.size())));
    poses.resize(std::min(poses.size(), std::max(few, kept)));
    std::size_t place = 0;
    std::erase_if(poses, [&](const Estimate& e) {
      return place++ >= few && e.gain + config.interval * e.standard_error < to_reach;
    });
    report(T_world_camera.size() - poses.size());
  }
  return true;
}

}  // namespace

RacedViews GainEvaluator::race(std::span<const Pose> T_world_camera, std::size_t k,
                               const RaceConfig& config, const BatchControl& control) const {
  check(config);
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
    if (const int every = coarse_step(core); every > 1) {
      coarse = GainEvaluator(std::make_unique<Impl>(
          impl_->scene,
          std::make_shared<detail::EvaluatorCore>(core, core.config.pixel_stride * every)));
    }
    return detail::race_by_measure(*this, coarse ? &*coarse : nullptr, T_world_camera, k,
                                   in_second_stage(k, count), config, control);
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
  if (driver.surface() == nullptr) {
    best.complete = choose_by_bundles(driver, T_world_camera, k, std::max(kFewPoses, 4 * k), config,
                                      control, report, field);
  } else {
    const std::size_t few = in_second_stage(k, count);
    best.complete =
        count <= few || choose_by_coarse_rays(driver, *impl_->scene, T_world_camera, few,
                                              config.costs, control, report, field);
  }
  best.rays_traced = field.rays_traced;
  if (!best.complete) return best;

  // Too few finite estimates for k poses: the others make up the number, NaN and all.
  std::vector<std::uint8_t> in_field(count, 0);
  for (const Estimate& e : field.poses) in_field[e.index] = 1;
  for (std::size_t i = 0; i < count && field.poses.size() < k; ++i) {
    if (in_field[i] == 0) field.poses.push_back({i, 0, 0});
  }
  for (const Estimate& e : field.poses) best.scored_indices.push_back(e.index);
  std::sort(best.scored_indices.begin(), best.scored_indices.end());
  best.scored_gains.resize(best.scored_indices.size());
  best.complete = detail::evaluate_some(driver, T_world_camera, best.scored_indices,
                                        best.scored_gains, control);
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
