// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The best views of a batch, by a gain or a custom measure: exactly, by scoring all with all rays,
// or with high probability, in two stages.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "choose/way_pricing.hpp"
#include "gain/gain_evaluator_impl.hpp"
#include "gain/sampled_views.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/stopwatch.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

using detail::ViewDriver;

// Up to this number, all poses are scored in full.
constexpr std::size_t kFewPoses = 24;
// Rays per pose in the first stage, and minimum fraction of poses that the second stage scores in
// full.
constexpr double kCoarseRays = 400;
constexpr double kInFull = 0.016, kInFullByPaper = 0.05;
// Largest fraction of the time that the first stage gets.
constexpr double kFirstStage = 0.5;
// Fraction of the time by which the scale of coarse measures must be known.
constexpr double kScaled = 0.75;
// Number of poses that determine the scale between a measure with few rays and with all rays.
constexpr std::size_t kAnchors = 8;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

void check(const BestConfig& config, std::size_t poses) {
  detail::check_costs(config.costs, poses);
  if (config.measure != nullptr && config.run_measure != nullptr) {
    refuse("measure and run_measure cannot be used together");
  }
  if (!(config.deadline >= 0)) {
    refuse("the deadline is " + short_text(config.deadline) + " s; it must be at least 0");
  }
}

// Indices of the k largest values, ties to the lower index, NaN last.
std::vector<std::size_t> largest(std::span<const double> values, std::size_t k) {
  std::vector<std::size_t> indices(values.size());
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  k = std::min(k, indices.size());
  const auto better = [&](std::size_t a, std::size_t b) {
    const double ga = values[a], gb = values[b];
    if (std::isnan(ga) || std::isnan(gb)) {
      return std::isnan(ga) == std::isnan(gb) ? a < b : std::isnan(gb);
    }
    return ga != gb ? ga > gb : a < b;
  };
  std::partial_sort(indices.begin(), indices.begin() + static_cast<std::ptrdiff_t>(k),
                    indices.end(), better);
  indices.resize(k);
  return indices;
}

// Numbers below `count`, in an order in which every prefix is spread over the whole range.
std::vector<std::size_t> spread(std::size_t count) {
  auto step = static_cast<std::size_t>(0.618 * static_cast<double>(count)) + 1;
  while (std::gcd(step, count) != 1) ++step;
  std::vector<std::size_t> order(count);
  for (std::size_t j = 0; j < count; ++j) order[j] = j * step % count;
  return order;
}

// Search in two stages: scores all poses with some of their rays, then some in full.
class Search {
 public:
  Search(const VoxelScene& scene, const ViewDriver& driver, std::span<const Pose> poses,
         const BestConfig& config, const BatchControl& control)
      : scene_(scene),
        driver_(driver),
        poses_(poses),
        config_(config),
        control_(control),
        by_gain_(config.measure == nullptr && config.run_measure == nullptr) {
    check(config, poses.size());
    if (config.run_measure != nullptr) (void)driver.ordered();  // its errors on this thread
    if (std::isfinite(config.deadline)) {
      open_ = spread(poses.size());
    } else {
      open_.resize(poses.size());
      std::iota(open_.begin(), open_.end(), std::size_t{0});
    }
  }

  // Keeps the best `few` poses. Poses without an estimate are kept only if fewer than k others
  // remain.
  void estimate(std::size_t k, std::size_t few) {
    const detail::EvaluatorCore& core = *driver_.core();
    const int step = detail::step_for_rays(core, kCoarseRays);
    if (step <= 1 || poses_.size() <= few) return;
    if (control_.progress) control_.progress(0, poses_.size());
    const bool is_random = by_gain_ && driver_.surface() == nullptr;
    const detail::SampledViews coarse(scene_, driver_,
                                      is_random ? detail::random_lattice(core, step, config_.seed)
                                                : detail::centred_lattice(core, step));
    if (config_.run_measure != nullptr) (void)coarse.driver().ordered();
    std::vector<double> estimates(poses_.size(), kNone);
    std::atomic<std::size_t> done{0};
    best_.complete = detail::for_each(
        driver_, open_.size(), until(kFirstStage), [&](std::size_t j, ViewDriver::Lease& lease) {
          const Pose& pose = poses_[open_[j]];
          estimates[open_[j]] =
              by_gain_ ? coarse.estimate(pose, lease).gain : measured(coarse.driver(), pose, lease);
          ++done;
        });
    best_.estimated = done;
    best_.rays_traced += done * std::uint64_t{coarse.rays()};
    if (was_stopped()) return;
    if (!config_.costs.empty()) {
      const double scale = by_gain_ ? 1.0 : scale_of(estimates);
      for (std::size_t i = 0; i < estimates.size(); ++i) {
        estimates[i] = scale * estimates[i] - config_.costs[i];
      }
    }
    open_ = largest(estimates, few);
    while (open_.size() > k && std::isnan(estimates[open_.back()])) open_.pop_back();
  }

  // Scores the remaining poses with all rays, the most promising first, and returns the best k.
  BestViews score(std::size_t k) {
    if (was_stopped()) {
      best_.complete = false;
      return std::move(best_);
    }
    std::vector<ViewGain> gains(by_gain_ ? open_.size() : 0);
    std::vector<double> worth(open_.size(), kNone);
    std::vector<std::uint8_t> is_scored(open_.size(), 0);
    BatchControl control = until(1);
    const std::size_t out = poses_.size() - open_.size();
    if (control_.progress) {
      control_.progress(out, poses_.size());
      control.progress = [&](std::size_t done, std::size_t) {
        control_.progress(out + done, poses_.size());
      };
    }
    const std::size_t scored = detail::for_each_pose(
        driver_, open_.size(), control, [&](std::size_t j, ViewDriver::Lease& lease) {
          const Pose& pose = poses_[open_[j]];
          if (by_gain_) gains[j] = driver_.evaluate(pose, lease);
          const double known = full_.empty() ? kNone : full_[open_[j]];
          worth[j] = by_gain_            ? gains[j].gain
                     : std::isnan(known) ? measured(driver_, pose, lease)
                                         : known;
          if (!config_.costs.empty()) worth[j] -= config_.costs[open_[j]];
          is_scored[j] = 1;
        });
    best_.complete = best_.complete && scored == open_.size();
    best_.rays_traced += scored * std::uint64_t{driver_.core()->ray_count};

    std::vector<std::size_t> order(open_.size());  // by index of the pose
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::erase_if(order, [&](std::size_t j) { return is_scored[j] == 0; });
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return open_[a] < open_[b]; });
    std::vector<double> worth_of_scored;
    for (const std::size_t j : order) {
      best_.scored_indices.push_back(open_[j]);
      if (by_gain_) best_.scored_gains.push_back(gains[j]);
      worth_of_scored.push_back(worth[j]);
    }
    for (const std::size_t j : largest(worth_of_scored, k)) {
      if (std::isnan(worth_of_scored[j])) continue;  // invalid poses are never chosen
      best_.indices.push_back(best_.scored_indices[j]);
      if (by_gain_) best_.gains.push_back(best_.scored_gains[j]);
      best_.worth.push_back(worth_of_scored[j]);
    }
    return std::move(best_);
  }

 private:
  double measured(const ViewDriver& driver, const Pose& pose, ViewDriver::Lease& lease) const {
    return config_.measure != nullptr ? detail::measured(driver, pose, lease, *config_.measure)
                                      : detail::measured(driver, pose, lease, *config_.run_measure);
  }

  // Ends a part of the search when the caller stops it, or after this fraction of the time.
  [[nodiscard]] BatchControl until(double share) {
    BatchControl part;
    part.stop = control_.stop;
    if (!control_.is_cancelled && !std::isfinite(config_.deadline)) return part;
    part.is_cancelled = [this, share] {
      was_cancelled_ = was_cancelled_ || (control_.is_cancelled && control_.is_cancelled());
      return was_cancelled_ || watch_.seconds() >= share * config_.deadline;
    };
    return part;
  }
  [[nodiscard]] bool was_stopped() const {
    return was_cancelled_ || control_.stop.stop_requested();
  }

  // Median ratio of the measure with all rays to that with few rays.
  [[nodiscard]] double scale_of(std::span<const double> coarse) {
    std::vector<std::size_t> known;
    for (std::size_t i = 0; i < coarse.size(); ++i) {
      if (std::isfinite(coarse[i])) known.push_back(i);
    }
    std::vector<double> ratios(std::min(known.size(), kAnchors), kNone);
    std::atomic<std::size_t> done{0};
    full_.assign(poses_.size(), kNone);
    detail::for_each(driver_, ratios.size(), until(kScaled),
                     [&](std::size_t j, ViewDriver::Lease& lease) {
                       const std::size_t i = known[j * known.size() / ratios.size()];
                       full_[i] = measured(driver_, poses_[i], lease);
                       ratios[j] = full_[i] / coarse[i];
                       ++done;
                     });
    best_.rays_traced += done * std::uint64_t{driver_.core()->ray_count};
    std::erase_if(ratios, [](double ratio) { return !(std::isfinite(ratio) && ratio > 0); });
    if (ratios.empty()) return 1;
    const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
    std::nth_element(ratios.begin(), middle, ratios.end());
    return *middle;
  }

  const VoxelScene& scene_;
  const ViewDriver& driver_;
  std::span<const Pose> poses_;
  const BestConfig& config_;
  const BatchControl& control_;
  bool by_gain_;
  Stopwatch watch_;
  bool was_cancelled_ = false;
  std::vector<std::size_t> open_;  // remaining poses, the most promising first
  // Measure with all rays of the poses that determine the scale, otherwise NaN.
  std::vector<double> full_;
  BestViews best_;
};

}  // namespace

std::vector<std::size_t> best_indices(std::span<const ViewGain> results, std::size_t k) {
  std::vector<double> gains;
  gains.reserve(results.size());
  for (const ViewGain& result : results) gains.push_back(result.gain);
  return largest(gains, k);
}

BestViews GainEvaluator::best(std::span<const Pose> T_world_camera, std::size_t k,
                              const BestConfig& config, const BatchControl& control) const {
  Search search(*impl_->scene, impl_->driver, T_world_camera, config, control);
  if (k == 0 || T_world_camera.empty()) return {};
  return search.score(k);
}

BestViews GainEvaluator::race(std::span<const Pose> T_world_camera, std::size_t k,
                              const BestConfig& config, const BatchControl& control) const {
  Search search(*impl_->scene, impl_->driver, T_world_camera, config, control);
  if (k == 0 || T_world_camera.empty()) return {};
  k = std::min(k, T_world_camera.size());
  const bool by_paper = impl_->driver.surface() == nullptr && config.measure == nullptr &&
                        config.run_measure == nullptr;
  const double share =
      (by_paper ? kInFullByPaper : kInFull) * static_cast<double>(T_world_camera.size());
  search.estimate(k, std::max({kFewPoses, 4 * k, static_cast<std::size_t>(std::ceil(share))}));
  return search.score(k);
}

std::size_t GainEvaluator::approximate(std::span<const Pose> T_world_camera,
                                       std::span<ApproximateGain> results,
                                       const ApproximateConfig& config,
                                       const BatchControl& control) const {
  if (!(config.share > 0 && config.share <= 1)) {
    throw Error(ErrorCode::invalid_argument, std::string("the share of the rays is ") +
                                                 short_text(config.share) +
                                                 "; it must be in (0, 1]");
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
