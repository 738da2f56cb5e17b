// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/simulated_sensor.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include "tof_pixel.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain {
namespace {

using detail::PixelRandom;
using detail::PixelReading;
using detail::RandomStream;
using detail::RayReturn;

constexpr int kMaxSubRays = 16;
constexpr std::size_t kPixelChunk = 1024;
constexpr std::size_t kRaysAtOnce = 256;  // or all rays of one pixel

void check(const Sensor& sensor, const SimulationConfig& config) {
  sensor.validate();
  const auto fail = [](const std::string& what) { refuse("simulated sensor: " + what); };
  if (!(config.background_radius >= 0) || !std::isfinite(config.background_radius)) {
    fail("the background radius must be at least 0 and finite, not " +
         short_text(config.background_radius) + " m");
  }
  if (config.sub_rays < 1 || config.sub_rays > kMaxSubRays) {
    fail("the number of sub-rays must be in 1.." + std::to_string(kMaxSubRays) + ", not " +
         std::to_string(config.sub_rays));
  }
  if (!(std::abs(config.scale_error) < 1)) {
    fail("the scale error must be in (-1, 1), not " + short_text(config.scale_error));
  }
  if (config.support_plane && !std::isfinite(*config.support_plane)) {
    fail("the height of the support plane must be finite, not " +
         short_text(*config.support_plane) + " m");
  }
}

// A pixel's rays in the camera frame: (x, y, 1) of its centre, and the change per pixel.
struct PixelRays {
  Eigen::Vector3d center;
  Eigen::Vector3d along_u = Eigen::Vector3d::Zero();
  Eigen::Vector3d along_v = Eigen::Vector3d::Zero();
};

std::vector<PixelRays> pixel_rays(const PinholeCamera& camera, bool with_steps) {
  std::vector<PixelRays> pixels;
  pixels.reserve(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
  for (const Eigen::Vector3d& center : camera.ray_table()) pixels.push_back({center});
  if (!with_steps) return pixels;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto u = static_cast<double>(i % static_cast<std::size_t>(camera.width));
    const auto v = static_cast<double>(i / static_cast<std::size_t>(camera.width));
    const Eigen::Vector3d along_u = camera.ray(u + 0.5, v) - camera.ray(u - 0.5, v);
    const Eigen::Vector3d along_v = camera.ray(u, v + 0.5) - camera.ray(u, v - 0.5);
    // If the lens model folds inside the pixel, all its rays are equal to that of the centre.
    if (!along_u.allFinite() || !along_v.allFinite()) continue;
    pixels[i].along_u = along_u;
    pixels[i].along_v = along_v;
  }
  return pixels;
}

SimulatedSensor::PixelTruth truth_of(std::span<const RayReturn> hits, double reading) {
  SimulatedSensor::PixelTruth truth;
  double low = 0, high = 0, nearest = 0;
  for (const RayReturn& hit : hits) {
    if (!std::isfinite(hit.range)) continue;
    if (truth.returns == 0) low = high = nearest = hit.range;
    low = std::min(low, hit.range);
    high = std::max(high, hit.range);
    if (std::abs(hit.range - reading) < std::abs(nearest - reading)) nearest = hit.range;
    ++truth.returns;
  }
  truth.min_range = static_cast<float>(low);
  truth.max_range = static_cast<float>(high);
  if (reading > 0) truth.nearest_range = static_cast<float>(nearest);
  return truth;
}

}  // namespace

struct SimulatedSensor::Impl {
  Sensor sensor;
  SimulationConfig config;
  detail::SimulatedRoom room;
  detail::TofPixel pixel_model;
  std::vector<PixelRays> pixels;
  mutable ThreadPool pool;

  Impl(std::shared_ptr<const SurfaceScene> scene, const Sensor& sensor_in,
       const SimulationConfig& config_in, int threads)
      : sensor(sensor_in),
        config(config_in),
        room{std::move(scene), config.background_radius, config.support_plane, config.surroundings},
        pixel_model(sensor, config),
        pixels(pixel_rays(sensor.camera, pixel_model.mixes())),
        pool(threads) {}

  // A camera's pose and the number of the frame.
  struct View {
    Eigen::Matrix3d R_world_camera;
    Eigen::Vector3d p_world;
    std::uint64_t frame_index = 0;
  };

  // Rays of some pixels and what they hit.
  struct Bundle {
    std::vector<SurfaceScene::Ray> rays;
    std::vector<RayReturn> returns;

    void add(const View& view, const Eigen::Vector3d& ray_world) {
      rays.push_back({view.p_world, ray_world * (1.0 / ray_world.norm())});
    }
    void trace(const detail::SimulatedRoom& room) {
      returns.resize(rays.size());
      room.first_returns(rays, returns);
    }
  };

  // Common shift of a pixel's rays by lateral noise. `center`: what the ray of the pixel's centre
  // hits.
  [[nodiscard]] Eigen::Vector3d displacement(const RayReturn& center, const Eigen::Vector3d& ray,
                                             const PixelRandom& random) const {
    const double length = ray.norm();
    const Eigen::Vector3d direction = ray / length;
    const bool nothing = !(center.range <= sensor.max_range);
    const double range = nothing ? sensor.max_range : std::max(center.range, kMinNoiseRange);
    const double sigma = sensor.noise_sigmas(range, nothing ? 1.0 : center.cos_incidence).lateral;
    const Eigen::Vector3d across_x = Eigen::Vector3d(direction.z(), 0, -direction.x()).normalized();
    const Eigen::Vector3d across_y = direction.cross(across_x);
    return sigma / range * length *
           (random.normal(RandomStream::lateral_x) * across_x +
            random.normal(RandomStream::lateral_y) * across_y);
  }

  struct Pixel {
    float depth = DepthFrame::kInvalid;
    float amplitude = 0;
  };

  [[nodiscard]] std::size_t rays_per_pixel() const {
    const auto n = static_cast<std::size_t>(config.sub_rays);
    return pixel_model.mixes() ? n * n : 1;
  }

  // Adds a pixel's rays.
  void add_rays(const View& view, const PixelRays& pixel, const Eigen::Vector3d& center,
                Bundle& bundle) const {
    const Eigen::Matrix3d& R = view.R_world_camera;
    const Eigen::Vector3d center_world = R * center;
    if (!pixel_model.mixes()) return bundle.add(view, center_world);
    const Eigen::Vector3d along_u = R * pixel.along_u, along_v = R * pixel.along_v;
    const int n = config.sub_rays;
    for (int j = 0; j < n; ++j) {
      const Eigen::Vector3d row = center_world + ((j + 0.5) / n - 0.5) * along_v;
      for (int i = 0; i < n; ++i) bundle.add(view, row + ((i + 0.5) / n - 0.5) * along_u);
    }
  }

  // Pixels [begin, end). All their rays are traced together.
  void acquire(const View& view, std::size_t begin, std::size_t end, Bundle& bundle,
               DepthFrame& frame, SimulatedSensor::PixelTruth* truth) const {
    const auto for_each_pixel = [&](const auto& visit) {
      for (std::size_t i = begin; i < end; ++i) {
        if (pixels[i].center.allFinite()) visit(i, PixelRandom(config.seed, view.frame_index, i));
      }
    };
    std::vector<RayReturn> centers;
    bundle.rays.clear();
    if (config.lateral_noise) {
      for_each_pixel([&](std::size_t i, const PixelRandom&) {
        bundle.add(view, view.R_world_camera * pixels[i].center);
      });
      bundle.trace(room);
      centers.swap(bundle.returns);
      bundle.rays.clear();
    }
    std::size_t k = 0;
    for_each_pixel([&](std::size_t i, const PixelRandom& random) {
      Eigen::Vector3d center = pixels[i].center;
      if (config.lateral_noise) center += displacement(centers[k++], center, random);
      add_rays(view, pixels[i], center, bundle);
    });
    bundle.trace(room);
    k = 0;
    for_each_pixel([&](std::size_t i, const PixelRandom& random) {
      const auto hits = std::span<const RayReturn>(bundle.returns).subspan(k, rays_per_pixel());
      k += hits.size();
      const double length = pixels[i].center.norm();
      const Pixel result =
          measured(pixel_model.mixes() ? pixel_model.mixed(hits) : pixel_model.single(hits[0]),
                   length, random);
      frame.depth[i] = result.depth;
      frame.amplitude[i] = result.amplitude;
      if (truth == nullptr) return;
      const bool is_reading = result.depth > 0 && std::isfinite(result.depth);
      truth[i] = truth_of(hits, is_reading ? result.depth * length : 0.0);
    });
  }

  [[nodiscard]] Pixel measured(PixelReading reading, double ray_length,
                               const PixelRandom& random) const {
    if (reading.range < sensor.min_range) return {};
    if (reading.range > sensor.max_range) return {DepthFrame::kOutOfRange, 0};
    reading = pixel_model.disturbed(reading, random);
    reading.range *= 1 + config.scale_error;
    if (reading.range < sensor.min_range || pixel_model.too_dark(reading)) return {};
    if (reading.range > sensor.max_range) return {DepthFrame::kOutOfRange, 0};
    return {static_cast<float>(reading.range / ray_length), static_cast<float>(reading.amplitude)};
  }

  [[nodiscard]] DepthFrame acquire(const Pose& T_world_camera, std::uint64_t frame_index,
                                   SimulatedSensor::PixelTruth* truth) const {
    const std::optional<Pose> pose = rigid_pose(T_world_camera);
    if (!pose) refuse("the simulated sensor's pose is not a rigid transform");
    const View view{pose->rotation(), pose->translation(), frame_index};
    DepthFrame frame{sensor.camera.width, sensor.camera.height,
                     std::vector<float>(pixels.size(), DepthFrame::kInvalid),
                     std::vector<float>(pixels.size())};
    if (truth != nullptr) std::fill_n(truth, pixels.size(), SimulatedSensor::PixelTruth{});
    const std::size_t at_once = std::max<std::size_t>(1, kRaysAtOnce / rays_per_pixel());
    pool.for_each_chunk(pixels.size(), kPixelChunk, [&](std::size_t begin, std::size_t end) {
      Bundle bundle;
      for (std::size_t i = begin; i < end; i += at_once) {
        acquire(view, i, std::min(i + at_once, end), bundle, frame, truth);
      }
    });
    return frame;
  }
};

SimulatedSensor::SimulatedSensor(std::shared_ptr<const SurfaceScene> scene, const Sensor& sensor,
                                 const SimulationConfig& config, const ExecConfig& exec) {
  if (!scene) refuse("the simulated sensor has no scene");
  check(sensor, config);
  impl_ = std::make_unique<Impl>(std::move(scene), sensor, config, exec.num_threads);
}

SimulatedSensor::~SimulatedSensor() = default;
SimulatedSensor::SimulatedSensor(SimulatedSensor&&) noexcept = default;
SimulatedSensor& SimulatedSensor::operator=(SimulatedSensor&&) noexcept = default;

DepthFrame SimulatedSensor::acquire(const Pose& T_world_camera, std::uint64_t frame_index) const {
  return impl_->acquire(T_world_camera, frame_index, nullptr);
}

DepthFrame SimulatedSensor::acquire(const Pose& T_world_camera, std::uint64_t frame_index,
                                    std::vector<SimulatedSensor::PixelTruth>& truth) const {
  truth.resize(impl_->pixels.size());
  return impl_->acquire(T_world_camera, frame_index, truth.data());
}

}  // namespace viewgain
