// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Gains from random sub-bundles of a view's rays.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "gain/batch_loop.hpp"
#include "gain/gain_evaluator_impl.hpp"
#include "tile_sample.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/text.hpp"

namespace viewgain {
namespace {

using detail::ViewDriver;

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
  detail::check_room(poses, results);
}

// Groups of tiles, and their sums as estimates of a view's gain.
class Sampler {
 public:
  Sampler(const ViewDriver& driver, const ApproximateConfig& config) : driver_(driver) {
    const detail::TileTable& table = driver.tracer().table();
    const auto groups = static_cast<std::size_t>(config.groups);
    const auto per_group = static_cast<std::size_t>(
        std::max(1.0, std::round(config.share * static_cast<double>(table.tile_count) /
                                 static_cast<double>(groups))));
    tiles_ = detail::random_tiles(table, groups, per_group, config.seed);
    // A tile at the image's edge may hold fewer rays: groups are scaled by their rays.
    for (const auto& group : tiles_) {
      const auto rays = static_cast<double>(detail::rays_of(table, group));
      scale_.push_back(rays > 0 ? static_cast<double>(driver.core()->ray_count) / rays : 0.0);
    }
  }

  [[nodiscard]] ApproximateGain estimate(const Pose& T_world_camera,
                                         ViewDriver::Lease& lease) const {
    std::vector<double> gains(tiles_.size());
    detail::sample(driver_, T_world_camera, tiles_, gains, lease);
    double sum = 0, squares = 0;
    for (std::size_t g = 0; g < gains.size(); ++g) {
      const double gain = scale_[g] * gains[g];
      sum += gain;
      squares += gain * gain;
    }
    const auto n = static_cast<double>(gains.size());
    const double mean = sum / n;
    return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1))};
  }

 private:
  const ViewDriver& driver_;
  std::vector<std::vector<std::uint32_t>> tiles_;
  std::vector<double> scale_;
};

// What voxels lose to rays of other tiles, from poses spread evenly over the batch.
struct Anchors {
  std::vector<std::size_t> indices;  // ascending
  std::vector<ApproximateGain> estimates;
  std::vector<ViewGain> truth;

  Anchors(std::size_t count, std::size_t poses) : estimates(count), truth(count) {
    for (std::size_t j = 0; j < count; ++j) indices.push_back(j * poses / count);
  }
  [[nodiscard]] const ApproximateGain* find(std::size_t i) const {
    const auto at = std::lower_bound(indices.begin(), indices.end(), i);
    if (at == indices.end() || *at != i) return nullptr;
    return &estimates[static_cast<std::size_t>(at - indices.begin())];
  }
};

// The ratio of true gains to estimates, and the standard error of a corrected estimate as a share
// of the estimate.
struct Correction {
  double ratio, error;

  [[nodiscard]] ApproximateGain applied(const ApproximateGain& estimate) const {
    return {estimate.gain * ratio, error * estimate.gain};
  }
};

// Nothing if there are too few to tell.
std::optional<Correction> correction_of(const Anchors& anchors) {
  std::vector<double> ratios;
  for (std::size_t j = 0; j < anchors.indices.size(); ++j) {
    const double truth = anchors.truth[j].gain, estimate = anchors.estimates[j].gain;
    if (truth > 0 && estimate > 0) ratios.push_back(truth / estimate);
  }
  if (ratios.size() < 2) return std::nullopt;
  // Medians, for views that see next to nothing have wild ratios; 1.4826 makes the median deviation
  // of a normal distribution its standard deviation.
  const auto n = static_cast<double>(ratios.size());
  const double ratio = median(ratios);
  for (double& r : ratios) r = std::abs(r - ratio);
  const double scatter = 1.4826 * median(ratios);
  return Correction{ratio, scatter * std::sqrt(1 + 1 / n)};
}

}  // namespace

std::size_t GainEvaluator::approximate(std::span<const Pose> T_world_camera,
                                       std::span<ApproximateGain> results,
                                       const ApproximateConfig& config,
                                       const BatchControl& control) const {
  check(config, T_world_camera.size(), results.size());
  std::fill(results.begin(), results.end(), ApproximateGain{});
  const ViewDriver& driver = impl_->driver;
  const Sampler sampler(driver, config);

  // The correction comes first, so that a call that is stopped hands out no estimate without it.
  const std::size_t count = std::min(config.anchors, results.size());
  Anchors anchors(count < 2 ? 0 : count, results.size());
  const bool is_anchored = detail::for_each(driver, anchors.indices.size(), control,
                                            [&](std::size_t j, ViewDriver::Lease& lease) {
                                              const Pose& pose = T_world_camera[anchors.indices[j]];
                                              anchors.estimates[j] = sampler.estimate(pose, lease);
                                              anchors.truth[j] = driver.evaluate(pose, lease);
                                            });
  if (!is_anchored) return 0;
  const std::optional<Correction> correction = correction_of(anchors);

  return detail::for_each_pose(
      driver, results.size(), control, [&](std::size_t i, ViewDriver::Lease& lease) {
        const ApproximateGain* known = anchors.find(i);
        const ApproximateGain estimate =
            known != nullptr ? *known : sampler.estimate(T_world_camera[i], lease);
        results[i] = correction ? correction->applied(estimate) : estimate;
      });
}

}  // namespace viewgain
