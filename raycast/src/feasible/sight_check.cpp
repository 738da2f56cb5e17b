// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "sight_check.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>

#include "trace/scene_tracing.hpp"

namespace viewgain::detail {
namespace {

constexpr int kStride = 8;  // of the pixels that stand for the view
constexpr int kEdge = 4;    // rays a bundle and axis
constexpr std::size_t kAtOnce = TriangleRays::kCount;
static_assert(kEdge * kEdge == kAtOnce);

// How much of a view ends near, as far as it is known.
struct Tally {
  double max_share;
  std::size_t left;  // rays that were not looked at
  std::size_t ends = 0, near = 0;

  // Whether there are too many whatever the others do.
  [[nodiscard]] bool is_too_near() const { return exceeds(ends + left); }
  // Whether there are too many if no other ends in the map. Where not, and no other ends near,
  // there never are.
  [[nodiscard]] bool may_be_too_near() const { return exceeds(ends); }

 private:
  [[nodiscard]] bool exceeds(std::size_t of) const {
    return static_cast<double>(near) > max_share * static_cast<double>(of);
  }
};

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

bool SightCheck::too_near(const Pose& T_grid_camera, const NonFreeVoxels& voxels,
                          const SceneData& scene) const {
  const double voxel_size = scene.snapshot.voxel_size;
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

  // Counts those of at most kAtOnce rays that end from `begin` to `end`; visits the others.
  Tally tally{max_near_share_, rays_.size()};
  const Index3& base = scene.snapshot.min_index;
  const Eigen::Vector3f tip_scene = (tip - Eigen::Vector3d(base.x, base.y, base.z)).cast<float>();
  const auto count = [&](std::span<const std::size_t> rays, double begin, double end,
                         const auto& visit) {
    TriangleRays packet;
    std::uint32_t ended = 0, is_near = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Eigen::Vector3d direction = R_grid_camera * rays_[rays[i]];
      const double t = voxels.first_along(HalfLine(tip, direction), begin, end);
      if (!(t <= end)) {
        visit(rays[i]);
        continue;
      }
      ended |= 1U << i;
      is_near |= (t < near_end ? 1U : 0U) << i;
      packet.ox[i] = tip_scene.x(), packet.oy[i] = tip_scene.y(), packet.oz[i] = tip_scene.z();
      packet.dx[i] = static_cast<float>(direction.x());
      packet.dy[i] = static_cast<float>(direction.y());
      packet.dz[i] = static_cast<float>(direction.z());
      packet.far[i] = static_cast<float>(t);
    }
    tally.left -= static_cast<std::size_t>(std::popcount(ended));
    if (scene.has_obstacles && ended != 0) {
      ended &= ~scene.tracing->obstacles->triangles().block(packet, ended);
    }
    tally.ends += static_cast<std::size_t>(std::popcount(ended));
    tally.near += static_cast<std::size_t>(std::popcount(ended & is_near));
  };
  std::vector<std::size_t> farther;  // rays that do not end near
  for (const Bundle& bundle : bundles_) {
    std::array<std::size_t, kAtOnce> rays{};
    const auto own = std::span(rays).first(bundle.count);
    std::iota(own.begin(), own.end(), bundle.first);
    if (!may_be_near(bundle)) {
      farther.insert(farther.end(), own.begin(), own.end());
      continue;
    }
    count(own, 0, near_end, [&](std::size_t ray) { farther.push_back(ray); });
    if (tally.is_too_near()) return true;
  }
  for (std::size_t first = 0; first < farther.size(); first += kAtOnce) {
    if (!tally.may_be_too_near()) return false;
    const auto some = std::span(farther).subspan(first, std::min(kAtOnce, farther.size() - first));
    count(some, near_end, far_end, [&](std::size_t) { --tally.left; });
    if (tally.is_too_near()) return true;
  }
  return tally.may_be_too_near();
}

}  // namespace viewgain::detail
