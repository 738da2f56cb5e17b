// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "evaluator_core.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::detail {
namespace {

// Information goes with the inverse square and determinants with its cube; within these bounds [m]
// they stay far from the ends of double precision.
constexpr double kMinPriorSigma = 1e-6;
constexpr double kMaxPriorSigma = 1e3;
// Beliefs lose the square of this ratio of a sensor's sigmas in digits, of single precision's 2^24.
constexpr double kMaxSigmaRatio = 1e3;
// What a smaller sigma [m] tells has a square that single precision does not hold.
constexpr double kMinSigma = 1e-8;

void check_range(const char* name, double value) {
  if (!std::isfinite(value) || value < 0) {
    refuse(std::string(name) + " is " + short_text(value) + " m; it must be at least 0 and finite");
  }
}

void check(const GainConfig& config, const Sensor& sensor) {
  const double min_range = config.min_range.value_or(sensor.min_range);
  const double max_range = config.max_range.value_or(sensor.max_range);
  if (config.pixel_stride < 1) {
    refuse("the pixel stride must be at least 1, not " + std::to_string(config.pixel_stride));
  }
  check_range("min_range", min_range);
  check_range("max_range", max_range);
  if (min_range >= max_range) {
    refuse("min_range, " + short_text(min_range) + " m, must be below max_range, " +
           short_text(max_range) + " m");
  }
  if (config.model == GainModel::combined && config.criterion == Criterion::trace) {
    refuse("the criterion trace requires the gain paper, because the combined gain is in nat");
  }
  if (!std::isfinite(config.refinement_weight) || config.refinement_weight < 0) {
    refuse("the refinement weight must be at least 0 and finite, not " +
           short_text(config.refinement_weight));
  }
  for (const double t : {min_range, sensor.working_distance, max_range}) {
    const MeasurementSigmas sigma = sensor.sigmas(t);
    const double ratio = sigma.axial / sigma.lateral;
    if (!(ratio <= kMaxSigmaRatio && ratio >= 1 / kMaxSigmaRatio)) {
      refuse("the sensor's standard deviations at a range of " + short_text(t) + " m are " +
             short_text(sigma.axial) + " m along the ray and " + short_text(sigma.lateral) +
             " m across the ray; they may differ by at most a factor of " +
             short_text(kMaxSigmaRatio));
    }
    if (const double least = std::min(sigma.axial, sigma.lateral); least < kMinSigma) {
      refuse("the sensor's standard deviation at a range of " + short_text(t) + " m is " +
             short_text(least) + " m; the minimum is " + short_text(kMinSigma) + " m");
    }
  }
  for (const GainConfig::WeightRegion& region : config.weights) {
    if (!std::isfinite(region.weight) || region.weight < 0) {
      refuse("a task weight must be at least 0 and finite, not " + short_text(region.weight));
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!(region.box.min[axis] < region.box.max[axis]))
        refuse("the box of a task weight is inside out or empty");
    }
  }
}

// The sensor, once it and the configuration are known to be good.
const Sensor& checked(const Sensor& sensor, const GainConfig& config) {
  sensor.validate();
  check(config, sensor);
  return sensor;
}

std::uint32_t rays_of(const SensorRays& rays) {
  std::uint32_t count = 0;
  for (const std::uint16_t lanes : rays.table.valid) {
    count += static_cast<std::uint32_t>(std::popcount(lanes));
  }
  return count;
}

}  // namespace

GainAccumulator::GainAccumulator(const SceneData& scene, const GainSettings& settings,
                                 std::size_t max_rays)
    : VoxelSums(scene, settings, max_rays) {
  if (settings.criterion == Criterion::trace || !settings.weights.empty()) {
    each_.resize(max_rays + 2 * kOverhang);
  }
}

GainAccumulator::ClassGain GainAccumulator::explored() {
  LogProduct ratios, posterior;
  double* each = each_.empty() ? nullptr : each_.data();
  finish_unknown(ratios, settings().posterior_entropy ? &posterior : nullptr, each);
  return gain_of(unknown(), ratios, posterior, each);
}

GainAccumulator::ClassGain GainAccumulator::refined() {
  look_up();
  LogProduct ratios, posterior;
  double* each = each_.empty() ? nullptr : each_.data() + unknown().size() + kOverhang;
  finish_occupied(ratios, settings().posterior_entropy ? &posterior : nullptr, each);
  return gain_of(occupied(), ratios, posterior, each);
}

GainAccumulator::ClassGain GainAccumulator::gain_of(std::span<const std::uint32_t> members,
                                                    const LogProduct& ratios,
                                                    const LogProduct& posterior,
                                                    const double* each) const {
  const double left =
      settings().posterior_entropy ? posterior.log() : std::numeric_limits<double>::quiet_NaN();
  if (each == nullptr) return {0.5 * ratios.log(), left};
  const bool logarithmic = settings().criterion != Criterion::trace;
  double sum = 0;
  for (std::size_t i = 0; i < members.size(); ++i) {
    sum += weight(members[i]) * (logarithmic ? 0.5 * std::log(each[i]) : each[i]);
  }
  return {sum, left};
}

void GainAccumulator::finish(const ClassGain& explored, const ClassGain& refined,
                             ViewGain& result) const {
  result.exploration = explored.gain;
  result.refinement = refined.gain;
  result.gain = result.exploration + result.refinement;
  result.posterior_entropy = explored.posterior_entropy + refined.posterior_entropy;
  result.hits = hit_count();
  result.unknown_voxels = static_cast<std::uint32_t>(unknown().size());
  result.occupied_voxels = static_cast<std::uint32_t>(occupied().size());
}

EvaluatorCore::EvaluatorCore(const Sensor& sensor, const GainConfig& gain_config,
                             const ExecConfig& exec)
    : config(gain_config),
      sigmas(frontal_sigmas(checked(sensor, gain_config))),
      working_distance(sensor.working_distance),
      min_range(gain_config.min_range.value_or(sensor.min_range)),
      max_range(gain_config.max_range.value_or(sensor.max_range)),
      tracer(exec.tracer),
      rays(std::make_shared<const SensorRays>(sensor.camera, gain_config.pixel_stride)),
      ray_count(rays_of(*rays)),
      pool(exec.num_threads) {}

EvaluatorCore::EvaluatorCore(const EvaluatorCore& full, const RayLattice& lattice, int num_threads)
    : config(full.config),
      sigmas(full.sigmas),
      working_distance(full.working_distance),
      min_range(full.min_range),
      max_range(full.max_range),
      tracer(full.tracer),
      rays(std::make_shared<const SensorRays>(*full.rays, lattice)),
      ray_count(rays_of(*rays)),
      pool(num_threads) {
  config.pixel_stride = rays->pixel_stride;
}

double EvaluatorCore::prior_sigma_in(const VoxelScene& scene) const {
  const double prior_sigma = config.prior_sigma.value_or(scene.snapshot().prior_sigma);
  if (!(prior_sigma >= kMinPriorSigma && prior_sigma <= kMaxPriorSigma)) {
    refuse("the prior sigma is " + short_text(prior_sigma) + " m; it must be in " +
           short_text(kMinPriorSigma) + ".." + short_text(kMaxPriorSigma) + " m");
  }
  return prior_sigma;
}

}  // namespace viewgain::detail
