// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/gain_evaluator.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <mutex>
#include <sstream>
#include <string>

#include "gain_evaluator_impl.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/text.hpp"

namespace viewgain {
namespace {

// Information goes with the inverse square and determinants with its cube; within these bounds [m]
// they stay far from the ends of double precision.
constexpr double kMinPriorSigma = 1e-6;
constexpr double kMaxPriorSigma = 1e3;
// Determinants of Λ_r lose about the square of this ratio of a sensor's sigmas in digits.
constexpr double kMaxSigmaRatio = 1e4;

[[noreturn]] void reject(const std::string& what) {
  throw Error(ErrorCode::invalid_argument, what);
}

void check_range(const char* name, double value) {
  if (!std::isfinite(value) || value < 0) {
    reject(std::string(name) + " is " + short_text(value) + " m; it must be >= 0 and finite");
  }
}

void check(const GainConfig& config, const Sensor& sensor, const VoxelScene& scene) {
  const double min_range = config.min_range.value_or(sensor.min_range);
  const double max_range = config.max_range.value_or(sensor.max_range);
  const double prior_sigma = config.prior_sigma.value_or(scene.snapshot().prior_sigma);
  if (config.pixel_stride < 1) {
    reject("pixel stride is " + std::to_string(config.pixel_stride) + "; it must be >= 1");
  }
  check_range("min_range", min_range);
  check_range("max_range", max_range);
  if (min_range >= max_range) {
    reject("min_range " + short_text(min_range) + " m is not below max_range " +
           short_text(max_range) + " m");
  }
  if (!(prior_sigma >= kMinPriorSigma && prior_sigma <= kMaxPriorSigma)) {
    std::ostringstream text;
    text << "prior sigma is " << prior_sigma << " m; it must be in " << kMinPriorSigma << ".."
         << kMaxPriorSigma << " m";
    reject(text.str());
  }
  for (const double t : {min_range, sensor.working_distance, max_range}) {
    const MeasurementSigmas sigma = sensor.sigmas(t);
    const double ratio = sigma.axial / sigma.lateral;
    if (!(ratio <= kMaxSigmaRatio && ratio >= 1 / kMaxSigmaRatio)) {
      std::ostringstream text;
      text << "the sensor's sigmas at " << t << " m, " << sigma.axial << " m along the ray and "
           << sigma.lateral << " m across, differ by more than a factor of " << kMaxSigmaRatio;
      reject(text.str());
    }
  }
  for (const WeightRegion& region : config.weights) {
    if (!std::isfinite(region.weight) || region.weight < 0) {
      reject("task weight is " + short_text(region.weight) + "; it must be >= 0 and finite");
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!(region.box.min[axis] < region.box.max[axis]))
        reject("a task weight's box is inside out");
    }
  }
}

}  // namespace

GainEvaluator::Impl::Impl(std::shared_ptr<const VoxelScene> s, const Sensor& sensor,
                          const GainConfig& config, const ExecConfig& exec)
    : scene(std::move(s)),
      data(scene->data()),
      prior_sigma(config.prior_sigma.value_or(data.snapshot.prior_sigma)),
      min_range(config.min_range.value_or(sensor.min_range)),
      max_range(config.max_range.value_or(sensor.max_range)),
      tracer(data, sensor.camera, config.pixel_stride, min_range, max_range),
      camera(sensor.camera),
      pixel_stride(config.pixel_stride),
      kernels(&detail::gain_kernels(data.kernels->isa)),
      pool(exec.num_threads) {
  settings = {config.criterion, 1.0 / (prior_sigma * prior_sigma), detail::frontal_sigmas(sensor),
              config.weights};
  for (const std::uint16_t lanes : tracer.table().valid) {
    ray_count += static_cast<std::uint32_t>(std::popcount(lanes));
  }
}

bool GainEvaluator::Impl::is_in_occupied(const detail::PoseFrame& frame) const {
  const GridSnapshot& snapshot = data.snapshot;
  const std::array<std::int32_t, 3> size{snapshot.dims.x, snapshot.dims.y, snapshot.dims.z};
  std::array<std::int32_t, 3> voxel{};
  for (std::size_t i = 0; i < 3; ++i) {
    const float c = std::floor(frame.origin[i]);
    if (!(c >= 0 && c < static_cast<float>(size[i]))) return false;
    voxel[i] = static_cast<std::int32_t>(c);
  }
  const Index3& base = snapshot.min_index;
  const Index3 at{base.x + voxel[0], base.y + voxel[1], base.z + voxel[2]};
  const SnapshotLeaf* leaf = snapshot.find_leaf(at);
  return leaf != nullptr &&
         test_bit(leaf->occupied,
                  static_cast<unsigned>((at.x & 7) << 6 | (at.y & 7) << 3 | (at.z & 7)));
}

std::optional<detail::PoseFrame> GainEvaluator::Impl::open_view(const Pose& T_world_camera,
                                                                ViewGain& result) const {
  const auto frame = tracer.frame_of(T_world_camera);
  if (!frame) return std::nullopt;
  result.rays = ray_count;
  if (is_in_occupied(*frame)) {
    result.gain = result.exploration = result.refinement = result.posterior_entropy = 0;
    result.status = ViewStatus::camera_in_occupied;
    return std::nullopt;
  }
  return frame;
}

ViewGain GainEvaluator::Impl::evaluate(const Pose& T_world_camera, Lease& lease) const {
  ViewGain result;
  const auto frame = open_view(T_world_camera, result);
  if (!frame) return result;
  auto& [accumulator, bins, view_hits] = lease.get();
  accumulator.begin();
  tracer.trace(*frame, bins,
               [&](std::size_t, const detail::RayTile& tile) { accumulator.add(tile); });
  accumulator.finish(result);
  result.status = ViewStatus::ok;
  return result;
}

std::string_view view_status_name(ViewStatus status) {
  switch (status) {
    case ViewStatus::ok:
      return "ok";
    case ViewStatus::camera_in_occupied:
      return "camera_in_occupied";
    case ViewStatus::bad_pose:
      break;
  }
  return "bad_pose";
}

GainEvaluator::GainEvaluator(std::shared_ptr<const VoxelScene> scene, const Sensor& sensor,
                             const GainConfig& config, const ExecConfig& exec) {
  if (!scene) reject("the gain evaluator has no scene");
  sensor.validate();
  check(config, sensor, *scene);
  impl_ = std::make_unique<Impl>(std::move(scene), sensor, config, exec);
}

GainEvaluator::~GainEvaluator() = default;
GainEvaluator::GainEvaluator(GainEvaluator&&) noexcept = default;
GainEvaluator& GainEvaluator::operator=(GainEvaluator&&) noexcept = default;

ViewGain GainEvaluator::evaluate(const Pose& T_world_camera) const {
  if (impl_->pool.num_threads() > 1) return impl_->evaluate_together(T_world_camera);
  Impl::Lease lease(*impl_);
  return impl_->evaluate(T_world_camera, lease);
}

std::size_t GainEvaluator::evaluate(std::span<const Pose> T_world_camera,
                                    std::span<ViewGain> results,
                                    const BatchControl& control) const {
  if (T_world_camera.size() != results.size()) {
    reject(std::to_string(T_world_camera.size()) + " poses but room for " +
           std::to_string(results.size()) + " results");
  }
  std::fill(results.begin(), results.end(), ViewGain{});
  return impl_->for_each_pose(results.size(), control, [&](std::size_t i, Impl::Lease& lease) {
    results[i] = impl_->evaluate(T_world_camera[i], lease);
  });
}

std::vector<ViewGain> GainEvaluator::evaluate(std::span<const Pose> T_world_camera) const {
  std::vector<ViewGain> results(T_world_camera.size());
  evaluate(T_world_camera, results);
  return results;
}

std::vector<RayHit> GainEvaluator::trace(const Pose& T_world_camera) const {
  const auto frame = impl_->tracer.frame_of(T_world_camera);
  if (!frame) return {};
  const VoxelScene::Data& data = impl_->data;
  const detail::TileTable& table = impl_->tracer.table();
  std::vector<RayHit> hits(table.ray_count());
  detail::TileBins bins;
  impl_->tracer.trace(*frame, bins, [&](std::size_t number, const detail::RayTile& tile) {
    for (std::uint32_t left = tile.hit | tile.blocked; left != 0; left &= left - 1) {
      const int lane = std::countr_zero(left);
      RayHit& hit = hits[table.ray_index(number, lane)];
      hit.range = static_cast<double>(tile.range[lane]) * data.snapshot.voxel_size;
      if ((tile.blocked >> lane & 1U) != 0) {
        hit.kind = RayHit::Kind::obstacle;
        continue;
      }
      const std::uint32_t primitive = tile.primitive[lane], offset = tile.offset[lane];
      hit.kind = data.occupied_leaf(primitive, offset) != nullptr ? RayHit::Kind::occupied
                                                                  : RayHit::Kind::unknown;
      hit.voxel = data.voxel_index(primitive, offset);
    }
  });
  return hits;
}

std::size_t GainEvaluator::rays_per_pose() const noexcept {
  return impl_->tracer.table().ray_count();
}
const PinholeCamera& GainEvaluator::camera() const noexcept { return impl_->camera; }
int GainEvaluator::pixel_stride() const noexcept { return impl_->pixel_stride; }
int GainEvaluator::num_threads() const noexcept { return impl_->pool.num_threads(); }
double GainEvaluator::prior_sigma() const noexcept { return impl_->prior_sigma; }
const VoxelScene& GainEvaluator::scene() const noexcept { return *impl_->scene; }

}  // namespace viewgain
