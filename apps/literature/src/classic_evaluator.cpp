// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include "classic_table.hpp"
#include "gain_sums.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/literature/classic_gains.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/support/view_rays.hpp"

namespace viewgain {
const std::vector<std::string>& classic_gain_names() {
  static const std::vector<std::string> names{
      "occlusion_aware",   "unobserved_voxel",      "average_entropy", "rear_side_voxel",
      "rear_side_entropy", "proximity_count",       "area_factor",     "unknown_volume",
      "unknown_count",     "surface_frontier_count"};
  return names;
}
std::string_view classic_gain_name(ClassicGain gain) {
  return classic_gain_names().at(static_cast<std::size_t>(gain));
}
ClassicGain parse_classic_gain(std::string_view name) {
  return static_cast<ClassicGain>(place_of_name(name, classic_gain_names(), "classic gain"));
}
std::string_view classic_gain_unit(ClassicGain gain) {
  static constexpr std::array<std::string_view, 10> kUnits{
      "nat", "nat", "nat", "rays", "nat", "voxels", "1", "m^3", "voxels", "voxels"};
  return kUnits.at(static_cast<std::size_t>(gain));
}
bool needs_occlusion(ClassicGain gain) {
  return gain == ClassicGain::proximity_count || gain == ClassicGain::area_factor;
}

}  // namespace viewgain

namespace viewgain::detail {
namespace {

constexpr double kPart = 4096;        // the first part of -log2 q is a multiple of 1 / kPart
constexpr double kAllAbsorbed = 200;  // replaces -log2 0; 2^-200 is 0 in single precision

double entropy_of(double p) {
  if (!(p > 0 && p < 1)) return 0;
  return -p * std::log(p) - (1 - p) * std::log(1 - p);
}

}  // namespace

VoxelValues::VoxelValues(const ClassicConfig& config) {
  static_assert(kMaxCode < 128 && kZeroCode < kPassed);
  for (int i = 0; i <= kMaxCode; ++i) {
    const auto code = static_cast<std::uint8_t>(i);
    const auto at = static_cast<std::size_t>(i);
    const double p = code != kUnknownCode
                         ? 1 / (1 + std::exp(-static_cast<double>(code_log_odds(code))))
                         : config.unknown_prior;
    const double H = entropy_of(p), q = 1 - p;
    entropy[at] = static_cast<float>(H);
    if (i > kZeroCode) continue;
    passed_entropy[at] = entropy[at];
    const double absorbs = q > 0 ? std::min(-std::log2(q), kAllAbsorbed) : kAllAbsorbed;
    const double first = std::floor(absorbs * kPart) / kPart;
    absorbed[at] = static_cast<float>(first);
    absorbed_rest[at] = static_cast<float>(absorbs - first);
    per_taken[at] = H > 0 ? static_cast<float>(H / (1 - q)) : 0.0F;
  }
}

}  // namespace viewgain::detail

namespace viewgain {
namespace detail {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

void check_gains(const std::vector<ClassicGain>& gains) {
  if (gains.empty()) refuse("the list of gains is empty");
  for (std::size_t i = 0; i < gains.size(); ++i) {
    if (std::find(gains.begin(), gains.begin() + static_cast<std::ptrdiff_t>(i), gains[i]) !=
        gains.begin() + static_cast<std::ptrdiff_t>(i)) {
      std::string text("the classic gain ");
      refuse(text.append(classic_gain_name(gains[i])).append(" is requested twice"));
    }
  }
}

const ClassicConfig& checked(const ClassicConfig& config) {
  check_gains(config.gains);
  const double prior = config.unknown_prior;
  if (!(prior >= 0 && prior <= 1)) {
    refuse("the prior probability of unknown voxels must be in 0..1, not " + short_text(prior));
  }
  return config;
}

std::shared_ptr<const ClassicMap> checked(std::shared_ptr<const ClassicMap> map,
                                          const ClassicConfig& config) {
  if (!map) refuse("the classic gains require a map");
  const OcclusionKnown known = ClassicAccess::data(*map).occlusion;
  for (const ClassicGain gain : config.gains) {
    if (!needs_occlusion(gain) || known == OcclusionKnown::yes) continue;
    std::string text(classic_gain_name(gain));
    text.append(" depends on which voxels earlier views could not see behind surfaces, but ");
    refuse(text.append(known == OcclusionKnown::no_views
                           ? "the map records no views"
                           : "the sensor that these views used is not given"));
  }
  return map;
}

GainConfig rays_of(const ClassicConfig& config) {
  return {.model = GainModel::paper,
          .pixel_stride = config.pixel_stride,
          .min_range = config.min_range,
          .max_range = config.max_range};
}

// f(x; a): two cubics with value 0 at 0 and 1, value 1 at a, and slope 0 at all three.
double area_weight(double x, double a) {
  if (x <= a) return (-2 * x / a + 3) * (x / a) * (x / a);
  return (((-2 * x + 3 * (a + 1)) * x - 6 * a) * x + 3 * a - 1) / std::pow(a - 1, 3);
}

}  // namespace
}  // namespace detail

using namespace detail;

struct ClassicGainEvaluator::Impl {
  ClassicConfig config;
  std::shared_ptr<const ClassicMap> map;
  VoxelValues values;
  GainEvaluator rays;

  [[nodiscard]] const ClassicMapData& data() const { return ClassicAccess::data(*map); }
};

namespace {

// Sums the gains along the rays of views.
class SumConsumer final : public RayConsumer {
 public:
  SumConsumer(const ClassicMapData& data, const ClassicConfig& config, const VoxelValues& values,
              std::span<double> results, std::span<ViewGain::Status> statuses)
      : data_(data),
        gains_(config.gains),
        view_{data.table, values, 2 * data.occlusion_depth,
              std::any_of(gains_.begin(), gains_.end(),
                          [](ClassicGain gain) {
                            return gain == ClassicGain::unknown_count ||
                                   gain == ClassicGain::surface_frontier_count;
                          })},
        kernels_(classic_kernels(select_isa())),
        results_(results),
        statuses_(statuses) {}

  [[nodiscard]] std::unique_ptr<ViewScratch> make_scratch() const override {
    return std::make_unique<Scratch>();
  }
  void begin(ViewScratch& scratch) const override {
    auto& own = static_cast<Scratch&>(scratch);
    own.sums = {};
    if (view_.is_distinct) own.distinct.begin(data_.table);
  }
  void add(const WalkLimits& limits, const WalkTask& task, ViewScratch& scratch) const override {
    auto& own = static_cast<Scratch&>(scratch);
    kernels_.add(view_, limits, task, own.sums, own.distinct);
  }
  void finish(std::size_t i, const ViewGain& view, ViewScratch& scratch) const override {
    if (!statuses_.empty()) statuses_[i] = view.status;
    if (view.status == ViewGain::Status::bad_pose) return;
    for (std::size_t g = 0; g < gains_.size(); ++g) {
      results_[i * gains_.size() + g] =
          view.status == ViewGain::Status::camera_in_occupied
              ? 0.0
              : value(gains_[g], static_cast<Scratch&>(scratch), view);
    }
  }

 private:
  struct Scratch final : ViewScratch {
    ClassicSums sums;
    DistinctVoxels distinct;
  };

  [[nodiscard]] double value(ClassicGain gain, const Scratch& scratch, const ViewGain& view) const {
    const ClassicSums& sums = scratch.sums;
    const double V = data_.scene->snapshot().voxel_size;
    const auto share = [&](std::uint64_t rays) {
      return view.rays == 0 ? 0.0 : static_cast<double>(rays) / static_cast<double>(view.rays);
    };
    switch (gain) {
      case ClassicGain::occlusion_aware:
        return sums.occlusion_aware;
      case ClassicGain::unobserved_voxel:
        return sums.unobserved;
      case ClassicGain::average_entropy:
        return sums.voxels > 0 ? sums.entropy / sums.voxels : 0.0;
      case ClassicGain::rear_side_voxel:
        return static_cast<double>(sums.rear_side);
      case ClassicGain::rear_side_entropy:
        return sums.rear_side_entropy;
      case ClassicGain::proximity_count:
        return sums.proximity;
      case ClassicGain::area_factor:
        return area_weight(share(sums.on_surface), 0.2) + area_weight(share(sums.on_hidden), 0.8);
      case ClassicGain::unknown_volume:
        return sums.volume * V * V * V;
      case ClassicGain::unknown_count:
        return static_cast<double>(scratch.distinct.count());
      case ClassicGain::surface_frontier_count:
        return static_cast<double>(scratch.distinct.frontiers());
    }
    return kNaN;
  }

  const ClassicMapData& data_;
  const std::vector<ClassicGain>& gains_;
  ClassicView view_;
  const ClassicKernels& kernels_;
  std::span<double> results_;
  std::span<ViewGain::Status> statuses_;
};

}  // namespace

ClassicGainEvaluator::ClassicGainEvaluator(std::shared_ptr<const ClassicMap> map,
                                           const Sensor& sensor, const ClassicConfig& config,
                                           const ExecConfig& exec) {
  map = checked(std::move(map), checked(config));
  GainEvaluator rays(ClassicAccess::data(*map).scene, sensor, rays_of(config),
                     {exec.num_threads});  // used only for its rays, which no tracer traces
  impl_ =
      std::make_unique<Impl>(Impl{config, std::move(map), VoxelValues(config), std::move(rays)});
}
ClassicGainEvaluator::ClassicGainEvaluator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ClassicGainEvaluator::~ClassicGainEvaluator() = default;
ClassicGainEvaluator::ClassicGainEvaluator(ClassicGainEvaluator&&) noexcept = default;
ClassicGainEvaluator& ClassicGainEvaluator::operator=(ClassicGainEvaluator&&) noexcept = default;

ClassicGainEvaluator ClassicGainEvaluator::with_map(std::shared_ptr<const ClassicMap> map) const {
  map = checked(std::move(map), config());
  GainEvaluator rays = impl_->rays.with_scene(ClassicAccess::data(*map).scene);
  return ClassicGainEvaluator(
      std::make_unique<Impl>(Impl{config(), std::move(map), impl_->values, std::move(rays)}));
}

std::size_t ClassicGainEvaluator::evaluate(std::span<const Pose> T_world_camera,
                                           std::span<double> results,
                                           std::span<ViewGain::Status> statuses,
                                           const BatchControl& control) const {
  const std::size_t poses = T_world_camera.size(), gains = config().gains.size();
  if (results.size() != poses * gains) {
    refuse("there are " + std::to_string(poses) + " poses and " + std::to_string(gains) +
           " gains, but the array has room for " + std::to_string(results.size()) + " results");
  }
  if (!statuses.empty() && statuses.size() != poses) {
    refuse("there are " + std::to_string(poses) + " poses, but the array has room for " +
           std::to_string(statuses.size()) + " statuses");
  }
  std::fill(results.begin(), results.end(), kNaN);
  std::fill(statuses.begin(), statuses.end(), ViewGain::Status::bad_pose);
  const SumConsumer consumer(impl_->data(), config(), impl_->values, results, statuses);
  return for_each_view_rays(impl_->rays, T_world_camera, /*from_occupied=*/false, consumer,
                            control);
}

std::vector<double> ClassicGainEvaluator::evaluate(std::span<const Pose> T_world_camera) const {
  std::vector<double> results(T_world_camera.size() * config().gains.size());
  evaluate(T_world_camera, results);
  return results;
}

const ClassicConfig& ClassicGainEvaluator::config() const noexcept { return impl_->config; }
const ClassicMap& ClassicGainEvaluator::map() const noexcept { return *impl_->map; }
std::size_t ClassicGainEvaluator::rays_per_pose() const noexcept {
  return impl_->rays.rays_per_pose();
}
int ClassicGainEvaluator::num_threads() const noexcept { return impl_->rays.num_threads(); }

}  // namespace viewgain
