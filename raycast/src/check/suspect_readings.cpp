// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "check/figure.hpp"
#include "check/frame_meetings.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/raycast/suspect_set_up.hpp"
#include "viewgain/support/shared_rays.hpp"

namespace viewgain {
namespace {

using detail::figure;

// Numbers of readings, and of readings that masks removed.
struct Taken {
  std::uint64_t all = 0, taken = 0;

  void add(bool is_taken) {
    ++all;
    taken += is_taken ? 1 : 0;
  }
  [[nodiscard]] double share() const {
    return all == 0 ? 0 : static_cast<double>(taken) / static_cast<double>(all);
  }
};

constexpr const char* kMaskRule =
    ". A pixel is ignored if its mask is nonzero or its confidence is too low. If the object is "
    "white in the masks, invert the masks";

// Whether a position is in the middle one of `parts` equal parts of a side.
bool is_amid(std::size_t at, std::size_t size, std::size_t parts) {
  return 2 * parts * at >= (parts - 1) * size && 2 * parts * at < (parts + 1) * size;
}

bool is_reading(const Sensor& sensor, double z, const Eigen::Vector3d& ray) {
  if (!(z > 0) || !std::isfinite(z) || !ray.allFinite()) return false;
  const double range = z * ray.norm();
  return range >= sensor.min_range && range <= sensor.max_range;
}

}  // namespace

bool mostly_look_away(const GridSnapshot& map, const Sensor& sensor,
                      std::span<const Pose> T_world_camera) {
  constexpr std::size_t kPoses = 100;
  constexpr int kRays = 6;  // along each side of the image, its edges included
  const Eigen::Array3d low =
      map.voxel_size * Eigen::Array3d(map.min_index.x, map.min_index.y, map.min_index.z);
  const Eigen::Array3d high =
      low + map.voxel_size * Eigen::Array3d(map.dims.x, map.dims.y, map.dims.z);
  const Pose T_grid_world = map.T_world_grid.inverse();
  std::vector<Eigen::Vector3d> rays;
  for (int row = 0; row <= kRays; ++row) {
    for (int column = 0; column <= kRays; ++column) {
      const Eigen::Vector3d ray = sensor.camera.ray((sensor.camera.width - 1.0) * column / kRays,
                                                    (sensor.camera.height - 1.0) * row / kRays);
      if (ray.allFinite()) rays.push_back(ray.normalized());
    }
  }
  const auto meets_box = [&](const Eigen::Array3d& eye, const Eigen::Array3d& direction) {
    const Eigen::Array3d a = (low - eye) / direction, b = (high - eye) / direction;
    const double enters = std::max(0.0, a.min(b).maxCoeff());
    return enters <= std::min(sensor.max_range, a.max(b).minCoeff());
  };
  const std::size_t step = (T_world_camera.size() + kPoses - 1) / kPoses;
  std::size_t away = 0, all = 0;
  for (std::size_t i = 0; i < T_world_camera.size(); i += step) {
    if (!rigid_pose(T_world_camera[i])) continue;
    const Eigen::Matrix3d turn = T_grid_world.rotation() * T_world_camera[i].rotation();
    const Eigen::Vector3d eye = T_grid_world * T_world_camera[i].translation();
    ++all;
    away += std::none_of(rays.begin(), rays.end(),
                         [&](const Eigen::Vector3d& ray) { return meets_box(eye, turn * ray); })
                ? 1
                : 0;
  }
  return 2 * away > all;
}

Suspicion suspect_frame(const Sensor& sensor, const DepthFrame& frame, const Pose& T_world_camera,
                        const BeliefGrid& map) {
  constexpr std::size_t kPixels = 1000, kLeast = 20;
  constexpr double kHardlyAny = 0.05, kMost = 0.5;
  check_frame_size(frame, sensor.camera);
  if (!rigid_pose(T_world_camera)) return {};
  const auto width = static_cast<std::size_t>(frame.width);
  const auto height = static_cast<std::size_t>(frame.height);
  // In any unit. A camera that looks past the map can see it at an image edge under another
  // convention, so conventions are judged by the middle of the image.
  std::vector<Eigen::Vector3d> all, middle;
  const std::size_t step = std::max<std::size_t>(1, frame.depth.size() / kPixels) | 1;
  for (std::size_t i = step / 2; i < frame.depth.size(); i += step) {
    const auto z = static_cast<double>(frame.depth[i]);
    if (!(z > 0) || !std::isfinite(z) || frame.shows_known(i)) continue;
    const std::size_t u = i % width, v = i / width;
    const Eigen::Vector3d ray = sensor.camera.ray(static_cast<double>(u), static_cast<double>(v));
    if (!ray.allFinite()) continue;
    all.push_back(z * ray);
    if (is_amid(u, width, 3) && is_amid(v, height, 3)) middle.push_back(z * ray);
  }
  if (middle.size() < kLeast) return {};
  const auto share_inside = [&](const detail::Convention& reading,
                                const std::vector<Eigen::Vector3d>& points) {
    const Pose pose = reading.pose == nullptr ? T_world_camera : reading.pose(T_world_camera);
    const auto inside = std::count_if(points.begin(), points.end(), [&](const Eigen::Vector3d& p) {
      const Eigen::Vector3d scaled = reading.depth_factor * p;
      const double range = scaled.norm();
      return range >= sensor.min_range && range <= sensor.max_range && map.index_of(pose * scaled);
    });
    return static_cast<double>(inside) / static_cast<double>(points.size());
  };
  if (share_inside({}, all) > kHardlyAny) return {};
  const std::vector<detail::Convention> others = detail::other_readings();
  const detail::Convention* best = nullptr;
  double most = kMost;
  for (const detail::Convention& other : others) {
    if (other.pose == nullptr && other.depth_factor == 1) continue;
    const double share = share_inside(other, middle);
    if (share > most) best = &other, most = share;
  }
  if (best == nullptr) return {};
  return {best->kind,
          figure(std::round(100 * share_inside({}, middle))) +
              " % of the points in the middle of the image lie in the workspace. Perhaps " +
              best->what + "; the share would then be " + figure(std::round(100 * most)) + " %"};
}

Suspicion suspect_masks(const Sensor& sensor, std::span<const DepthFrame> unmasked,
                        std::span<const DepthFrame> masked, std::span<const Pose> T_world_camera,
                        const BeliefGrid* map) {
  if (masked.size() != unmasked.size() || T_world_camera.size() != unmasked.size()) {
    refuse("one masked frame and one pose per frame are required");
  }
  constexpr double kNearlyAll = 0.95, kMostOfMiddle = 0.8, kLittleElse = 0.4;
  const auto shared = shared_rays(sensor.camera);
  const std::vector<Eigen::Vector3d>& rays = *shared;
  const auto width = static_cast<std::size_t>(sensor.camera.width);
  const auto height = static_cast<std::size_t>(sensor.camera.height);
  Taken inside, middle_inside, middle, elsewhere;
  for (std::size_t k = 0; k < unmasked.size(); ++k) {
    check_frame_size(unmasked[k], sensor.camera);
    check_frame_size(masked[k], sensor.camera);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto z = static_cast<double>(unmasked[k].depth[i]);
      if (!is_reading(sensor, z, rays[i])) continue;
      const bool is_taken = masked[k].depth[i] == DepthFrame::kInvalid;
      const bool is_middle = is_amid(i % width, width, 5) && is_amid(i / width, height, 5);
      (is_middle ? middle : elsewhere).add(is_taken);
      if (map != nullptr && !map->index_of(T_world_camera[k] * (z * rays[i]))) continue;
      inside.add(is_taken);
      if (is_middle) middle_inside.add(is_taken);
    }
  }
  // Masks that remove all except a small object keep the middle.
  const bool leaves_middle = middle_inside.all > 0 && middle_inside.share() < 0.5;
  if (inside.taken > 0 && inside.share() >= kNearlyAll && !leaves_middle) {
    const char* const where = map == nullptr ? "" : " in the workspace";
    return {"masks", "the masks remove " + figure(std::round(100 * inside.share())) +
                         " % of the depths" + where + kMaskRule};
  }
  if (middle.share() >= kMostOfMiddle && elsewhere.share() <= kLittleElse) {
    return {"masks", "the masks remove " + figure(std::round(100 * middle.share())) +
                         " % of the depths in the middle of the images and " +
                         figure(std::round(100 * elsewhere.share())) + " % elsewhere" + kMaskRule};
  }
  return {};
}

}  // namespace viewgain
