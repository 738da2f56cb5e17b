// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "sight_check.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace viewgain::detail {
namespace {

constexpr int kStride = 8;  // of the pixels that stand for the view
constexpr int kEdge = 4;    // rays a bundle and axis

}  // namespace

SightCheck::SightCheck(const Sensor& sensor, double max_near_share)
    : min_range_(sensor.min_range), max_range_(sensor.max_range), max_near_share_(max_near_share) {
  const PinholeCamera& camera = sensor.camera;
  const std::vector<Eigen::Vector3d> table = camera.ray_table();
  constexpr int kStep = kStride * kEdge;
  for (int v0 = 0; v0 < camera.height; v0 += kStep) {
    for (int u0 = 0; u0 < camera.width; u0 += kStep) {
      const std::size_t first = rays_.size();
      for (int v = v0; v < std::min(v0 + kStep, camera.height); v += kStride) {
        for (int u = u0; u < std::min(u0 + kStep, camera.width); u += kStride) {
          const Eigen::Vector3d ray =
              table[static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.width) +
                    static_cast<std::size_t>(u)]
                  .normalized();
          // A pixel that the distortion model cannot invert has no ray.
          if (ray.allFinite()) rays_.push_back(ray);
        }
      }
      if (rays_.size() > first) {
        bundles_.push_back(bundle_of(rays_, first, rays_.size() - first));
      }
    }
  }
  all_ = bundle_of(rays_, 0, rays_.size());
}

SightCheck::Bundle SightCheck::bundle_of(const std::vector<Eigen::Vector3d>& rays,
                                         std::size_t first, std::size_t count) {
  Bundle bundle{first, count, Eigen::Vector3d::UnitZ()};
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = first; i < first + count; ++i) sum += rays[i];
  if (sum.norm() > 0) bundle.axis = sum.normalized();
  for (std::size_t i = first; i < first + count; ++i) {
    bundle.cosine = std::min(bundle.cosine, bundle.axis.dot(rays[i]));
  }
  bundle.cosine -= 1e-9;  // against rounding
  bundle.sine = std::sqrt(std::max(0.0, 1.0 - bundle.cosine * bundle.cosine));
  return bundle;
}

bool SightCheck::too_near(const Pose& T_world_camera, const Pose& T_grid_camera, double voxel_size,
                          const NonFreeVoxels& voxels, const ObstacleCheck& obstacles) const {
  const Eigen::Matrix3d R_grid_camera = T_grid_camera.rotation();
  const Eigen::Vector3d tip = T_grid_camera.translation() / voxel_size;
  const double near_end = min_range_ / voxel_size, far_end = max_range_ / voxel_size;

  const auto may_be_near = [&](const Bundle& bundle) {
    const Eigen::Vector3d axis = R_grid_camera * bundle.axis;
    // The points of the cone within min_range lie between the tip and the cap at its end.
    const Eigen::Vector3d middle = tip + near_end * axis;
    const double radius = near_end * std::sqrt(std::max(0.0, 2.0 - 2.0 * bundle.cosine));
    Box range;
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      range.min[i] = std::min(tip[k], middle[k] - radius);
      range.max[i] = std::max(tip[k], middle[k] + radius);
    }
    return voxels.may_meet({tip, axis, bundle.sine, bundle.cosine}, range);
  };
  if (!may_be_near(all_)) return false;

  std::size_t ends = 0, near = 0, left = rays_.size();
  const auto too_many = [&](std::size_t of) {
    return static_cast<double>(near) > max_near_share_ * static_cast<double>(of);
  };
  // Where a ray ends, from `begin` on; nothing if it does not end in the map yet.
  const auto end_of = [&](std::size_t ray, double begin, double end) -> std::optional<double> {
    const double t = voxels.first_along(HalfLine(tip, R_grid_camera * rays_[ray]), begin, end);
    return t <= end ? std::optional(t) : std::nullopt;
  };
  const auto count = [&](std::size_t ray, double t) {
    --left;
    if (obstacles.block({T_world_camera.translation(), T_world_camera.rotation() * rays_[ray]},
                        t * voxel_size)) {
      return;
    }
    ++ends;
    near += t < near_end ? 1U : 0U;
  };
  std::vector<std::size_t> farther;  // rays that do not end near
  for (const Bundle& bundle : bundles_) {
    const bool is_near = may_be_near(bundle);
    for (std::size_t ray = bundle.first; ray < bundle.first + bundle.count; ++ray) {
      const std::optional<double> t = is_near ? end_of(ray, 0, near_end) : std::nullopt;
      if (!t) {
        farther.push_back(ray);
        continue;
      }
      count(ray, *t);
      if (too_many(ends + left)) return true;
    }
  }
  for (const std::size_t ray : farther) {
    if (!too_many(ends)) return false;
    if (const std::optional<double> t = end_of(ray, near_end, far_end)) {
      count(ray, *t);
    } else {
      --left;
    }
    if (too_many(ends + left)) return true;
  }
  return too_many(ends);
}

}  // namespace viewgain::detail
