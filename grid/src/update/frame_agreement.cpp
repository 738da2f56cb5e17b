// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/grid/frame_agreement.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "map/grid_layout.hpp"
#include "update/map_update.hpp"
#include "viewgain/core/noise.hpp"
#include "viewgain/support/frame_displacement.hpp"
#include "viewgain/support/hash64.hpp"
#include "viewgain/support/shared_rays.hpp"

namespace viewgain {
namespace {

constexpr std::size_t kSamples = 600;     // readings of a frame
constexpr std::size_t kFewSamples = 300;  // with fewer, more are sought
constexpr std::size_t kKept = 40'000;     // readings of all frames
constexpr std::size_t kOthers = 600;      // of these, compared with a frame
constexpr std::size_t kImages = 64;       // remembered images
constexpr std::size_t kHashed = 20'000;   // pixels of an image by which copies are recognised
// Relative to range: errors of real cameras and trackers beyond those declared.
constexpr double kUndeclared = 0.01;
constexpr double kSigmas = 3;            // sigmas explained by noise
constexpr double kSteepest = 3;          // largest slope of a surface to the image plane
constexpr int kMostSteps = 12;           // along a ray, on both sides of a reading
constexpr double kLeastCosine = 0.4;     // of the angle of incidence, for measuring distances
constexpr double kCommon = 0.0035;       // relative to range: largest noise common to all readings
constexpr double kSameDirection = 0.85;  // least cosine between normals of one surface
// Relative to range, in addition to noise; farther readings belong to another surface.
constexpr double kSameSurface = 0.03;

// Equal images from poses that differ by less are not suspicious.
constexpr double kMoved = 0.005, kTurned = 0.01;  // [m], [rad]

bool has_moved(const Pose& a, const Pose& b) {
  const double turned = (a.rotation() - b.rotation()).norm() / std::sqrt(2.0);
  return (a.translation() - b.translation()).norm() > kMoved || turned > kTurned;
}

bool is_depth(float z) { return z > 0 && std::isfinite(z); }

// Smallest depth in a square of pixels, 0 if one is invalid; samples a few pixels of a large
// square.
float nearest_round(const DepthFrame& frame, std::size_t u, std::size_t v, std::size_t reach) {
  const std::size_t step = (reach + 2) / 3;
  const auto last_u = std::min(u + reach, static_cast<std::size_t>(frame.width) - 1);
  const auto last_v = std::min(v + reach, static_cast<std::size_t>(frame.height) - 1);
  float nearest = std::numeric_limits<float>::infinity();
  for (std::size_t y = v - std::min(v, reach); y <= last_v; y += step) {
    for (std::size_t x = u - std::min(u, reach); x <= last_u; x += step) {
      nearest = std::min(nearest, frame.depth[y * static_cast<std::size_t>(frame.width) + x]);
    }
  }
  return nearest;
}

// Errors of a pose for readings at this range, assumed common.
MeasurementSigmas of_pose(const PoseSigma& pose_sigma, double range) {
  return {pose_sigma.translation, std::hypot(pose_sigma.translation, pose_sigma.rotation * range)};
}

bool is_free(const BeliefGrid& grid, const Eigen::Vector3d& p_world) {
  const std::optional<Index3> voxel = grid.index_of(p_world);
  return voxel && grid.state(*voxel) == VoxelState::free;
}

}  // namespace

FrameAgreement::FrameAgreement(const Sensor& sensor, std::optional<double> support_plane)
    : sensor_(sensor), support_plane_(support_plane) {
  sensor.validate();
  rays_ = shared_rays(sensor.camera);
}

bool FrameAgreement::is_smooth(const DepthFrame& frame, std::size_t u, std::size_t v) const {
  const auto width = static_cast<std::size_t>(frame.width);
  if (u < 1 || v < 1 || u + 1 >= width || v + 1 >= static_cast<std::size_t>(frame.height)) {
    return false;
  }
  const std::size_t i = v * width + u;
  const auto z = static_cast<double>(frame.depth[i]);
  const double noise = 2 * kSigmas * sensor_.noise_sigmas(z * (*rays_)[i].norm()).axial;
  const double step = kSteepest * z / std::min(sensor_.camera.fx, sensor_.camera.fy) + noise;
  for (std::size_t y = v - 1; y <= v + 1; ++y) {
    for (std::size_t x = u - 1; x <= u + 1; ++x) {
      const float other = frame.depth[y * width + x];
      if (!is_depth(other) || std::abs(static_cast<double>(other) - z) > step) return false;
    }
  }
  return true;
}

std::vector<FrameAgreement::Reading> FrameAgreement::sampled(const BeliefGrid& map,
                                                             const DepthFrame& frame,
                                                             const Pose& T_world_camera,
                                                             const PoseSigma& pose_sigma,
                                                             std::size_t stride) const {
  const auto width = static_cast<std::size_t>(frame.width);
  const auto height = static_cast<std::size_t>(frame.height);
  const Eigen::Matrix3d R_world_camera = T_world_camera.rotation();
  std::vector<Reading> readings;
  for (std::size_t v = stride / 2; v < height; v += stride) {
    for (std::size_t u = stride / 2; u < width; u += stride) {
      const std::size_t i = v * width + u;
      if (!is_depth(frame.depth[i]) || !(*rays_)[i].allFinite() || frame.shows_known(i)) continue;
      const Eigen::Vector3d p_camera = static_cast<double>(frame.depth[i]) * (*rays_)[i];
      const double range = p_camera.norm();
      if (range < sensor_.min_range || range > sensor_.max_range) continue;
      const Eigen::Vector3d p_world = T_world_camera * p_camera;
      if (!map.index_of(p_world) || !is_smooth(frame, u, v)) continue;
      const Eigen::Vector3d ray = R_world_camera * p_camera / range;
      const MeasurementSigmas own = sigmas(range, pose_sigma);
      if (support_plane_ && is_of_plane(p_world.z() - *support_plane_, ray.z(), own)) continue;
      readings.push_back({p_world, ray.cast<float>(), static_cast<float>(own.axial),
                          static_cast<float>(own.lateral), of_pose(both(pose_sigma), range),
                          seen_normal(frame, u, v, range, R_world_camera),
                          static_cast<std::uint32_t>(frames_.size())});
    }
  }
  return readings;
}

Eigen::Vector3f FrameAgreement::seen_normal(const DepthFrame& frame, std::size_t u, std::size_t v,
                                            double range,
                                            const Eigen::Matrix3d& R_world_camera) const {
  const double noise = sensor_.noise_sigmas(range).axial;
  const auto plane = plane_at(frame, sensor_.camera, *rays_, u, v, noise);
  if (!plane) return Eigen::Vector3f::Zero();
  return (R_world_camera * plane->normalized()).cast<float>();
}

void FrameAgreement::look(const BeliefGrid& before, const DepthFrame& frame,
                          const Pose& T_world_camera_in, const PoseSigma& pose_sigma) {
  check_frame_size(frame, sensor_.camera);
  detail::check_pose_sigma(pose_sigma);
  const Pose T_world_camera = detail::rigid_view(T_world_camera_in);
  FrameContradiction found;
  look_at_others(frame, T_world_camera, pose_sigma, found);
  look_for_copy(frame, T_world_camera, found);

  const double pixels = static_cast<double>(frame.width) * static_cast<double>(frame.height);
  auto stride = static_cast<std::size_t>(std::max(1.0, std::ceil(std::sqrt(pixels / kSamples))));
  std::vector<Reading> readings = sampled(before, frame, T_world_camera, pose_sigma, stride);
  // The mapped part can be small in the image.
  while (readings.size() < kFewSamples && stride > 1) {
    stride /= 2;
    readings = sampled(before, frame, T_world_camera, pose_sigma, stride);
  }
  for (Reading& reading : readings) {
    reading.in_free = lies_in_free(before, reading);
    found.in_free += reading.in_free ? 1 : 0;
  }
  found.readings = readings.size();
  keep(std::move(readings));
  frames_.push_back(found);
}

// Whether everything near is free where a reading can come from: along its ray, and across it where
// errors exceed a cell.
bool FrameAgreement::lies_in_free(const BeliefGrid& grid, const Reading& reading) {
  const Eigen::Vector3d& p_world = reading.p_world;
  const Eigen::Vector3d ray = reading.ray.cast<double>();
  const std::optional<Index3> voxel = grid.index_of(p_world);
  if (!voxel || grid.state(*voxel) != VoxelState::free) return false;
  const double cell = grid.voxel_size() * static_cast<double>(1 << grid.scale(*voxel));
  const auto is_free_along = [&](const Eigen::Vector3d& direction, double margin) {
    const int steps = std::clamp(static_cast<int>(std::ceil(margin / cell)), 1, kMostSteps);
    for (int k = 1; k <= steps; ++k) {
      const Eigen::Vector3d offset = margin * k / steps * direction;
      if (!is_free(grid, p_world + offset) || !is_free(grid, p_world - offset)) return false;
    }
    return true;
  };
  if (!is_free_along(ray, std::max(cell, kSigmas * static_cast<double>(reading.axial))))
    return false;
  const double beside = kSigmas * static_cast<double>(reading.lateral);
  if (beside < cell) return true;
  const Eigen::Vector3d across = ray.unitOrthogonal(), other = ray.cross(across);
  return is_free_along(across, beside) && is_free_along(other, beside) &&
         is_free_along((across + other).normalized(), beside) &&
         is_free_along((across - other).normalized(), beside);
}

MeasurementSigmas FrameAgreement::sigmas(double range, const PoseSigma& pose_sigma) const {
  const MeasurementSigmas own = sensor_.sigmas(range);
  const double moved = std::hypot(pose_sigma.translation, pose_sigma.rotation * range);
  return {std::hypot(own.axial, pose_sigma.translation, sensor_.scale_sigma * range),
          std::hypot(own.lateral, moved, sensor_.scale_sigma * range)};
}

// Distance of a reading of an earlier frame from the surface that this frame sees there, if that is
// flat, and the distance that declared errors allow: both poses, the scale, and the part of the
// noise that all readings can share, which for noisy cameras is less than all of it.
void FrameAgreement::compare(const DepthFrame& frame, std::size_t u, std::size_t v,
                             const Reading& earlier, const Pose& T_camera_world,
                             const PoseSigma& pose_sigma, DisplacementFit& fit) const {
  if (earlier.normal.isZero()) return;
  if (frame.shows_known(v * static_cast<std::size_t>(frame.width) + u)) return;
  const Eigen::Vector3d p_camera = T_camera_world * earlier.p_world;
  const double range = p_camera.norm();
  const MeasurementSigmas noise = sensor_.noise_sigmas(range);
  const auto plane = plane_at(frame, sensor_.camera, *rays_, u, v, noise.axial);
  if (!plane) return;
  const double size = plane->norm(), cosine = std::min(1.0, 1 / (size * range));
  const Eigen::Vector3d normal = *plane / size;
  const Eigen::Vector3d earlier_normal = T_camera_world.rotation() * earlier.normal.cast<double>();
  if (normal.dot(earlier_normal) < kSameDirection) return;
  const double distance = normal.dot(p_camera) - 1 / size;
  const double axial = std::hypot(sigmas(range, pose_sigma).axial, earlier.axial);
  if (cosine < kLeastCosine || std::abs(distance) > kSigmas * axial + kSameSurface * range) return;
  const double earlier_cosine =
      std::abs(normal.dot(T_camera_world.rotation() * earlier.ray.cast<double>()));
  const double by_pose = sigma_along_normal(of_pose(both(pose_sigma), range), cosine);
  const double by_earlier = sigma_along_normal(earlier.of_pose, earlier_cosine);
  const double by_noise = std::min(sigma_along_normal(noise, cosine), kCommon * range);
  fit.add(p_camera, normal, distance,
          std::hypot(by_noise, std::numbers::sqrt2 * std::hypot(by_pose, by_earlier),
                     sensor_.scale_sigma * range));
}

PoseSigma FrameAgreement::both(const PoseSigma& pose_sigma) const {
  return {std::hypot(sensor_.pose_sigma.translation, pose_sigma.translation),
          std::hypot(sensor_.pose_sigma.rotation, pose_sigma.rotation)};
}

void FrameAgreement::look_at_others(const DepthFrame& frame, const Pose& T_world_camera,
                                    const PoseSigma& pose_sigma, FrameContradiction& found) const {
  const Pose T_camera_world = T_world_camera.inverse();
  const auto width = static_cast<std::size_t>(frame.width);
  const std::size_t step = kept_.size() / kOthers + 1;
  DisplacementFit fit;
  for (std::size_t k = 0; k < kept_.size(); k += step) {
    const Eigen::Vector3d p_camera = T_camera_world * kept_[k].p_world;
    if (!sensor_.camera.sees(p_camera)) continue;
    const Eigen::Vector2d pixel = sensor_.camera.project(p_camera);
    const auto u = static_cast<std::size_t>(std::max(0.0, std::round(pixel.x())));
    const auto v = static_cast<std::size_t>(std::max(0.0, std::round(pixel.y())));
    if (u < 1 || v < 1 || u + 1 >= width || v + 1 >= static_cast<std::size_t>(frame.height)) {
      continue;
    }
    const double range = p_camera.norm();
    if (range < sensor_.min_range || range > sensor_.max_range) continue;
    const MeasurementSigmas own = sigmas(range, pose_sigma);
    const double axial = std::hypot(own.axial, static_cast<double>(kept_[k].axial));
    const double lateral = std::hypot(own.lateral, static_cast<double>(kept_[k].lateral));
    compare(frame, u, v, kept_[k], T_camera_world, pose_sigma, fit);
    // If errors exceed a pixel, neighbouring pixels can show the surface.
    const auto reach = static_cast<std::size_t>(
        std::max(1.0, std::ceil(kSigmas * lateral * sensor_.camera.fx / p_camera.z())));
    const float nearest = nearest_round(frame, u, v, reach);
    if (!(nearest > 0)) continue;
    const double beyond = static_cast<double>(nearest) - p_camera.z();
    const double gate =
        kSigmas * std::max(axial, lateral) + 0.5 * range / sensor_.camera.fx + kUndeclared * range;
    if (beyond < -gate) continue;  // occluded
    ++found.others;
    found.seen_past += beyond > gate ? 1 : 0;
  }
  if (!fit.tells()) return;
  found.compared = fit.size();
  found.displacement = fit.displacement();
  found.expected = fit.expected();
}

void FrameAgreement::look_for_copy(const DepthFrame& frame, const Pose& T_world_camera,
                                   FrameContradiction& found) {
  // Images without content, or of one depth, are equal from everywhere.
  const auto first = std::find_if(frame.depth.begin(), frame.depth.end(), is_depth);
  if (std::all_of(first, frame.depth.end(), [&](float z) { return !is_depth(z) || z == *first; })) {
    return;
  }
  Hash64 hash;
  const std::size_t step = frame.depth.size() / kHashed + 1;
  for (std::size_t i = 0; i < frame.depth.size(); i += step) {
    hash.add(std::bit_cast<std::uint32_t>(frame.depth[i]));
  }
  const auto same = std::find_if(images_.begin(), images_.end(),
                                 [&](const Image& image) { return image.hash == hash.value(); });
  if (same == images_.end()) {
    if (images_.size() == kImages) images_.erase(images_.begin());
    images_.push_back({hash.value(), frames_.size(), T_world_camera});
  } else if (has_moved(same->T_world_camera, T_world_camera)) {
    found.same_image_as = same->frame;
  }
}

void FrameAgreement::keep(std::vector<Reading> readings) {
  for (std::size_t k = 0; k < readings.size(); k += keep_every_) kept_.push_back(readings[k]);
  while (kept_.size() > kKept) {
    for (std::size_t k = 0; 2 * k < kept_.size(); ++k) kept_[k] = kept_[2 * k];
    kept_.resize((kept_.size() + 1) / 2);
    keep_every_ *= 2;
  }
}

std::vector<FrameContradiction> FrameAgreement::frames(const BeliefGrid& after) const {
  std::vector<FrameContradiction> all = frames_;
  // Readings in space that was free before, and in space that became free since, are both counted
  // among the kept readings.
  std::vector<std::size_t> kept(all.size()), carved(all.size());
  for (const Reading& reading : kept_) {
    ++kept[reading.frame];
    if (reading.in_free) continue;
    carved[reading.frame] += lies_in_free(after, reading) ? 1 : 0;
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (kept[i] == 0) continue;
    const double share = static_cast<double>(carved[i]) / static_cast<double>(kept[i]);
    const auto more =
        static_cast<std::size_t>(std::lround(share * static_cast<double>(all[i].readings)));
    all[i].in_free = std::min(all[i].readings, all[i].in_free + more);
  }
  return all;
}

}  // namespace viewgain
