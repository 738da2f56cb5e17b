// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The best views of a batch, very probably, by successive halving.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

#include "gain/batch_loop.hpp"
#include "gain/gain_evaluator_impl.hpp"
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

struct Estimate {
  std::size_t index = 0;
  double gain = 0, standard_error = 0;
};

}  // namespace

RacedViews GainEvaluator::race(std::span<const Pose> T_world_camera, std::size_t k,
                               const RaceConfig& config, const BatchControl& control) const {
  check(config);
  const std::size_t count = T_world_camera.size();
  detail::check_costs(config.costs, count);
  k = std::min(k, count);
  RacedViews best;
  if (k == 0) return best;
  // Poses are done when they are out.
  const auto report = [&](std::size_t done) {
    if (control.progress) control.progress(done, count);
  };
  report(0);
  const std::size_t few = std::max(kFewPoses, 4 * k);

  std::vector<Estimate> field(count);
  for (std::size_t i = 0; i < count; ++i) field[i].index = i;
  const detail::ViewDriver& driver = impl_->driver;
  const detail::TileTable& table = driver.tracer().table();
  for (double share = config.first_share;
       share <= std::max(kLastShare, config.first_share) && field.size() > few; share *= kGrowth) {
    // Bundles are nested: each round's begin with those of the round before.
    const auto per_group = static_cast<std::size_t>(std::max(
        kLeastTiles, std::round(share * static_cast<double>(table.tile_count) / double{kGroups})));
    const auto tiles = detail::random_tiles(table, kGroups, per_group, config.seed);
    std::uint64_t rays = 0;
    for (const auto& group : tiles) rays += detail::rays_of(table, group);
    const double part = static_cast<double>(rays) / driver.core()->ray_count;
    best.complete = detail::for_each(
        driver, field.size(), control, [&](std::size_t j, detail::ViewDriver::Lease& lease) {
          std::array<double, kGroups> gains;
          detail::sample(driver, T_world_camera[field[j].index], tiles, gains, lease);
          double sum = 0, squares = 0;
          for (const double gain : gains) sum += gain, squares += gain * gain;
          constexpr auto n = static_cast<double>(kGroups);
          field[j].gain = sum;
          if (!config.costs.empty()) field[j].gain -= part * config.costs[field[j].index];
          field[j].standard_error = std::sqrt(std::max(0.0, squares - sum * sum / n) * n / (n - 1));
        });
    if (!best.complete) return best;
    best.rays_traced += rays * field.size();

    std::erase_if(field, [](const Estimate& e) { return std::isnan(e.gain); });
    std::sort(field.begin(), field.end(), [](const Estimate& a, const Estimate& b) {
      return a.gain != b.gain ? a.gain > b.gain : a.index < b.index;
    });
    if (field.size() <= few) break;
    // Who is left: at most a share, and of those who may still be among the k best.
    std::vector<double> least;
    for (const Estimate& e : field) least.push_back(e.gain - config.interval * e.standard_error);
    std::nth_element(least.begin(), least.begin() + static_cast<std::ptrdiff_t>(k - 1), least.end(),
                     std::greater<>());
    const double to_reach = least[k - 1];
    const auto kept =
        static_cast<std::size_t>(std::ceil(config.keep * static_cast<double>(field.size())));
    field.resize(std::min(field.size(), std::max(few, kept)));
    std::size_t place = 0;
    std::erase_if(field, [&](const Estimate& e) {
      return place++ >= few && e.gain + config.interval * e.standard_error < to_reach;
    });
    report(count - field.size());
  }

  // Too few finite estimates for k poses: the others make up the number, NaN and all.
  std::vector<std::uint8_t> in_field(count, 0);
  for (const Estimate& e : field) in_field[e.index] = 1;
  for (std::size_t i = 0; i < count && field.size() < k; ++i) {
    if (in_field[i] == 0) field.push_back({i, 0, 0});
  }
  for (const Estimate& e : field) best.scored_indices.push_back(e.index);
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
