// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "tof_pixel.hpp"

#include <algorithm>
#include <array>
#include <variant>

namespace viewgain::detail {
namespace {

// Hits the sphere and the table if they are nearer.
void meet_walls(const SimulatedRoom& room, const SurfaceScene::Ray& ray, RayReturn& first) {
  const Eigen::Vector3d &origin = ray.origin, &direction = ray.direction;
  if (const double r = room.background_radius; r > 0) {
    const double b = origin.dot(direction), c = origin.squaredNorm() - r * r;
    // The sphere is ignored from outside. A hit inside the sphere is nearer than its wall.
    if (c <= 0 && !(first.range * (first.range + 2 * b) + c < 0)) {
      const double wall = -b + std::sqrt(b * b - c);
      if (wall < first.range)
        first = {wall, std::abs((origin + wall * direction).dot(direction)) / r};
    }
  }
  if (room.support_plane) {
    const double table =
        (*room.support_plane - origin.z()) / direction.z();  // NaN inside the plane
    if (table > 0 && table < first.range) first = {table, std::abs(direction.z())};
  }
}

constexpr double kTwoPi = 2.0 * std::numbers::pi;

double amplitude_of(const RayReturn& hit) {
  const double range = std::max(hit.range, kMinNoiseRange);
  return hit.cos_incidence / (range * range);
}

}  // namespace

void SimulatedRoom::first_returns(std::span<const SurfaceScene::Ray> rays,
                                  std::span<RayReturn> returns) const {
  constexpr std::size_t kAtOnce = 64;
  std::array<SurfaceScene::Hit, kAtOnce> hits;
  for (std::size_t first = 0; first < rays.size(); first += kAtOnce) {
    const auto some = rays.subspan(first, std::min(kAtOnce, rays.size() - first));
    const auto found = returns.subspan(first, some.size());
    std::fill(found.begin(), found.end(), RayReturn{});
    for (const SurfaceScene* scene : {object.get(), surroundings.get()}) {
      if (scene == nullptr) continue;
      scene->intersect(some, hits);
      for (std::size_t i = 0; i < some.size(); ++i) {
        if (!(hits[i].range < found[i].range)) continue;
        found[i] = {hits[i].range, std::abs(hits[i].normal.dot(some[i].direction))};
      }
    }
    for (std::size_t i = 0; i < some.size(); ++i) meet_walls(*this, some[i], found[i]);
  }
}

TofPixel::TofPixel(const Sensor& sensor, const SimulationConfig& config)
    : sensor_(sensor),
      config_(config),
      unambiguous_range_(unambiguous_range(sensor.noise)),
      mixes_(config.sub_rays > 1 && std::isfinite(unambiguous_range_)),
      folds_(mixes_ || (config.ambiguity && std::isfinite(unambiguous_range_))) {
  if (const auto* shot = std::get_if<ShotNoise>(&sensor.noise)) {
    min_amplitude_ = shot->min_amplitude;
  }
}

double TofPixel::folded(double range) const {
  if (!folds_ || !std::isfinite(range)) return range;
  return range - unambiguous_range_ * std::floor(range / unambiguous_range_);
}

double TofPixel::sigma_at(double range, double cos_incidence) const {
  return config_.noise ? sensor_.noise_sigmas(range, cos_incidence).axial : 0.0;
}

PixelReading TofPixel::single(const RayReturn& hit) const {
  if (!std::isfinite(hit.range)) return {hit.range, 0, 0};
  const double cos_incidence = std::min(1.0, hit.cos_incidence);
  return {folded(hit.range), cos_incidence, amplitude_of(hit), sigma_at(hit.range, cos_incidence)};
}

PixelReading TofPixel::mixed(std::span<const RayReturn> hits) const {
  const double per_metre = kTwoPi / unambiguous_range_;
  // Phases relative to that of the strongest return are small, which is faster and more accurate.
  const auto strongest =
      std::max_element(hits.begin(), hits.end(), [](const RayReturn& a, const RayReturn& b) {
        if (!std::isfinite(a.range) || !std::isfinite(b.range))
          return std::isfinite(b.range) && !std::isfinite(a.range);
        return amplitude_of(a) < amplitude_of(b);
      });
  if (strongest == hits.end() || !std::isfinite(strongest->range)) return single(RayReturn{});
  double real = 0, imaginary = 0;
  for (const RayReturn& hit : hits) {
    if (!std::isfinite(hit.range)) continue;
    const double phase = per_metre * (hit.range - strongest->range);
    const double amplitude = amplitude_of(hit);
    real += amplitude * std::cos(phase);
    imaginary += amplitude * std::sin(phase);
  }
  const double way = strongest->range + std::atan2(imaginary, real) / per_metre;
  const double range = folded(way);
  const double amplitude = std::hypot(real, imaginary) / static_cast<double>(hits.size());
  return {range, std::min(1.0, amplitude * range * range), amplitude,
          sigma_at(way, std::min(1.0, amplitude * way * way))};
}

PixelReading TofPixel::disturbed(PixelReading reading, const PixelRandom& random) const {
  if (config_.noise) {
    const double sigma = reading.sigma;
    reading.range += sigma * random.normal(RandomStream::axial);
    // Phase and amplitude come from the same four samples, so the relative noise of the amplitude
    // equals the noise of the phase in radians.
    reading.amplitude *= std::max(
        0.0, 1.0 + kTwoPi * sigma / unambiguous_range_ * random.normal(RandomStream::amplitude));
  }
  reading.range = folded(reading.range);
  return reading;
}

}  // namespace viewgain::detail
