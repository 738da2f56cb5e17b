// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Gains from random sub-bundles of a view's rays.
#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "gain/gain_evaluator_impl.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/mix64.hpp"
#include "viewgain/core/text.hpp"

namespace viewgain {
namespace {

// Irrational steps of a two-dimensional sequence whose points keep apart: 1/g and 1/g², g³ = g + 1.
constexpr double kStepX = 0.7548776662466927, kStepY = 0.5698402909980532;

// For fewer of a view's tiles than this share the BVH is quicker than lists for all tiles.
constexpr double kLeastListedShare = 0.08;

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void check(const ApproximateConfig& config, std::size_t poses, std::size_t results) {
  const auto reject = [](const std::string& what) {
    throw Error(ErrorCode::invalid_argument, what);
  };
  if (!(config.share > 0 && config.share <= 1)) {
    reject(std::string("share of the tiles is ") + short_text(config.share) +
           "; it must be in (0, 1]");
  }
  if (config.groups < 2 || config.groups > 64) {
    reject(std::string("number of groups is ") + std::to_string(config.groups) +
           "; it must be in 2..64");
  }
  if (poses != results) {
    reject(std::to_string(poses) + " poses but room for " + std::to_string(results) + " results");
  }
}

}  // namespace

std::vector<std::vector<std::uint32_t>> GainEvaluator::Impl::random_tiles(
    std::size_t groups, std::size_t per_group, std::uint64_t seed) const {
  const detail::TileTable& table = tracer.table();
  const auto columns =
      static_cast<std::size_t>((table.columns + detail::kTileEdge - 1) / detail::kTileEdge);
  const std::size_t rows = table.tile_count / columns;
  const std::size_t count = std::min(groups * per_group, table.tile_count);
  std::vector<std::uint32_t> tiles;
  std::vector<std::uint8_t> taken(table.tile_count, 0);
  const std::uint64_t start = mix64(seed);
  double x = unit_number(mix64(start)), y = unit_number(mix64(start + 1));
  // The sequence comes by every tile sooner or later; the last few are taken as they stand.
  for (std::size_t i = 0; tiles.size() < count && i < 16 * table.tile_count; ++i) {
    const std::size_t tile =
        std::min(static_cast<std::size_t>(y * static_cast<double>(rows)), rows - 1) * columns +
        std::min(static_cast<std::size_t>(x * static_cast<double>(columns)), columns - 1);
    if (taken[tile] == 0) tiles.push_back(static_cast<std::uint32_t>(tile));
    taken[tile] = 1;
    x += kStepX, y += kStepY;
    x -= std::floor(x), y -= std::floor(y);
  }
  for (std::uint32_t tile = 0; tiles.size() < count; ++tile) {
    if (taken[tile] == 0) tiles.push_back(tile);
  }
  std::vector<std::vector<std::uint32_t>> dealt(groups);
  // None is empty, if the view has so few tiles that one must be in several.
  for (std::size_t i = 0; i < std::max(count, groups); ++i) {
    dealt[i % groups].push_back(tiles[i % count]);
  }
  return dealt;
}

std::uint64_t GainEvaluator::Impl::rays_of(std::span<const std::uint32_t> tiles) const {
  std::uint64_t rays = 0;
  for (const std::uint32_t tile : tiles) {
    rays += static_cast<std::uint64_t>(std::popcount(tracer.table().valid[tile]));
  }
  return rays;
}

void GainEvaluator::Impl::sample(const Pose& T_world_camera,
                                 std::span<const std::vector<std::uint32_t>> groups,
                                 std::span<double> gains, Lease& lease) const {
  const auto frame = tracer.frame_of(T_world_camera);
  const bool sees = frame && !frame->sees_nothing && !is_in_occupied(*frame);
  std::fill(gains.begin(), gains.end(), frame ? 0.0 : std::numeric_limits<double>::quiet_NaN());
  if (!sees) return;
  auto& [accumulator, bins, view_hits] = lease.get();
  std::size_t tile_count = 0;
  for (const auto& group : groups) tile_count += group.size();
  if (static_cast<double>(tile_count) >=
      kLeastListedShare * static_cast<double>(tracer.table().tile_count)) {
    tracer.prepare(*frame, bins);
  } else {
    bins.invalidate();
  }
  if (!bins.valid()) data.ensure_bvh();
  for (std::size_t g = 0; g < groups.size(); ++g) {
    accumulator.begin();
    tracer.trace_listed(*frame, groups[g], bins,
                        [&](std::size_t, const detail::RayTile& tile) { accumulator.add(tile); });
    ViewGain result;
    accumulator.finish(result);
    gains[g] = result.gain;
  }
}

bool GainEvaluator::Impl::evaluate_some(std::span<const Pose> T_world_camera,
                                        std::span<const std::size_t> indices,
                                        std::span<ViewGain> results,
                                        const BatchControl& control) const {
  return for_each(indices.size(), 1, control, [&](std::size_t j, Lease& lease) {
    results[j] = evaluate(T_world_camera[indices[j]], lease);
  });
}

std::size_t GainEvaluator::approximate(std::span<const Pose> T_world_camera,
                                       std::span<ApproximateGain> results,
                                       const ApproximateConfig& config,
                                       const BatchControl& control) const {
  check(config, T_world_camera.size(), results.size());
  std::fill(results.begin(), results.end(), ApproximateGain{});
  const auto groups = static_cast<std::size_t>(config.groups);
  const auto all = static_cast<double>(impl_->tracer.table().tile_count);
  const auto per_group = static_cast<std::size_t>(
      std::max(1.0, std::round(config.share * all / static_cast<double>(groups))));
  const auto tiles = impl_->random_tiles(groups, per_group, config.seed);
  // A tile at the image's edge may hold fewer rays: groups are scaled by their rays.
  std::vector<double> scale;
  for (const auto& group : tiles) {
    const auto rays = static_cast<double>(impl_->rays_of(group));
    scale.push_back(rays > 0 ? static_cast<double>(impl_->ray_count) / rays : 0.0);
  }

  const auto score = [&](std::size_t i, Impl::Lease& lease) {
    std::vector<double> gains(groups);
    impl_->sample(T_world_camera[i], tiles, gains, lease);
    double sum = 0, squares = 0;
    for (std::size_t g = 0; g < groups; ++g) {
      const double gain = scale[g] * gains[g];
      sum += gain;
      squares += gain * gain;
    }
    const auto n = static_cast<double>(groups);
    const double mean = sum / n;
    results[i] = {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1))};
  };
  const std::size_t done = impl_->for_each_pose(results.size(), control, score);
  if (done < results.size()) return done;

  // What voxels lose to rays of other tiles, from poses spread evenly over the batch.
  const std::size_t anchors = std::min(config.anchors, results.size());
  if (anchors < 2) return done;
  std::vector<std::size_t> indices;
  for (std::size_t j = 0; j < anchors; ++j) indices.push_back(j * results.size() / anchors);
  std::vector<ViewGain> truth(anchors);
  if (!impl_->evaluate_some(T_world_camera, indices, truth, control)) return done;
  std::vector<double> ratios;
  for (std::size_t j = 0; j < anchors; ++j) {
    const double estimate = results[indices[j]].gain;
    if (truth[j].gain > 0 && estimate > 0) ratios.push_back(truth[j].gain / estimate);
  }
  if (ratios.size() < 2) return done;
  // Medians, for views that see next to nothing have wild ratios; 1.4826 makes the median deviation
  // of a normal distribution its standard deviation.
  const auto n = static_cast<double>(ratios.size());
  const double ratio = median(ratios);
  for (double& r : ratios) r = std::abs(r - ratio);
  const double scatter = 1.4826 * median(ratios);
  for (ApproximateGain& r : results) {
    r.standard_error = scatter * std::sqrt(1 + 1 / n) * r.gain;
    r.gain *= ratio;
  }
  return done;
}

}  // namespace viewgain
