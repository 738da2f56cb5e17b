// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "scorer/realised_area.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <unordered_map>

#include "gain/from_behind.hpp"
#include "gain/frontal_sigmas.hpp"
#include "viewgain/support/shared_rays.hpp"
#include "viewgain/support/state_reader.hpp"
#include "viewgain/support/voxel_walk.hpp"

namespace viewgain::detail {
namespace {

constexpr std::size_t kPixelChunk = 4096;

bool sees_plane(const Sensor& sensor, const Eigen::Vector3d& point, const Eigen::Vector3d& sight,
                double plane) {
  const double range = sight.norm(),
               rise = sight.z() / range;  // its absolute value is cosθ on the plane
  return is_of_plane(point.z() - plane, rise, sensor.sigmas(range, std::abs(rise)));
}

// Known surface that a ray would reach from behind.
class SurfaceBehind {
 public:
  explicit SurfaceBehind(const BeliefGrid& map)
      : map_(map),
        voxel_size_(map.voxel_size()),
        T_grid_world_(map.T_world_grid().inverse()),
        box_(VoxelBox::from_dims(map.min_index(), map.dims())) {}

  /// A point of the world in the map [voxels].
  [[nodiscard]] Eigen::Vector3d place(const Eigen::Vector3d& point) const {
    return T_grid_world_ * point / voxel_size_;
  }
  [[nodiscard]] std::optional<Index3> voxel_at(const Eigen::Vector3d& place) const {
    return box_.voxel_at(place);
  }
  [[nodiscard]] VoxelState state(Index3 voxel) { return map_.state(voxel); }

  /// For a reading's place in the workspace [voxels] and its ray (world): cosine between the ray
  /// and the outward normal of that surface; 0 if there is none.
  double cosine(const Eigen::Vector3d& at, const Eigen::Vector3d& direction) {
    const Eigen::Vector3d along = T_grid_world_.rotation() * direction;
    const Way on = way(at, along);
    if (on.end != VoxelState::occupied) return 0;
    double length = on.length;
    const bool is_occupied = length == 0;  // then the voxels before it count
    if (length < FromBehind::kLeastStretch) length += way(at, -along, is_occupied).length;
    if (length < FromBehind::kLeastStretch) return 0;
    const double cosine = outward(on.voxel).dot(along);
    return cosine > FromBehind::kLeastCosine ? cosine : 0;
  }

 private:
  // A path through unknown voxels.
  struct Way {
    double length = 0;  // [voxels]
    VoxelState end = VoxelState::unknown;
    Index3 voxel;  // the last voxel
  };

  // `beside`: begins where the ray leaves its first voxel.
  [[nodiscard]] Way way(const Eigen::Vector3d& from, const Eigen::Vector3d& along,
                        bool beside = false) {
    const HalfLine line(from, along);
    VoxelWalk walk(line, 0, box_);
    if (beside) walk.leave<1>();
    const double begin = walk.from();
    for (; box_.contains(walk.voxel()); walk.leave<1>()) {
      const VoxelState state = map_.state(walk.voxel());
      if (state != VoxelState::unknown) return {walk.from() - begin, state, walk.voxel()};
    }
    return {walk.from() - begin, VoxelState::unknown, {}};
  }

  // Normal of a cube of 2³ voxels, from unknown towards free voxels around it; zero if unknown.
  const Eigen::Vector3d& outward(Index3 voxel) {
    const Index3 low{voxel.x & -2, voxel.y & -2, voxel.z & -2};
    const auto [entry, is_new] = normals_.try_emplace(low, Eigen::Vector3d::Zero());
    if (!is_new) return entry->second;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int i = 0; i < 216; ++i) {
      const int x = i / 36 - 2, y = i / 6 % 6 - 2, z = i % 6 - 2;
      const Index3 at{low.x + x, low.y + y, low.z + z};
      if (!box_.contains(at)) continue;
      const VoxelState state = map_.state(at);
      if (state == VoxelState::occupied) continue;
      const Eigen::Vector3d side((x + 2) / 2 - 1, (y + 2) / 2 - 1, (z + 2) / 2 - 1);
      sum += state == VoxelState::free ? side : -side;
    }
    if (sum.norm() > 0) entry->second = sum.normalized();
    return entry->second;
  }

  struct Hash {
    std::size_t operator()(Index3 v) const {
      return (static_cast<std::size_t>(static_cast<std::uint32_t>(v.x)) * 73856093U) ^
             (static_cast<std::size_t>(static_cast<std::uint32_t>(v.y)) * 19349663U) ^
             (static_cast<std::size_t>(static_cast<std::uint32_t>(v.z)) * 83492791U);
    }
  };
  StateReader map_;
  double voxel_size_;
  Pose T_grid_world_;
  VoxelBox box_;
  std::unordered_map<Index3, Eigen::Vector3d, Hash> normals_;
};

}  // namespace

RealisedArea::RealisedArea(const Sensor& sensor, double voxel_size,
                           std::optional<double> support_plane)
    : sensor_(sensor),
      support_plane_(support_plane),
      rays_(shared_rays(sensor.camera)),
      solid_angles_(sensor.camera.solid_angles(*rays_)),
      worth_(frontal_sigmas(sensor), sensor.working_distance, voxel_size) {}

double RealisedArea::of(const DepthFrame& frame, const Pose& T_world_camera,
                        const BeliefGrid& before, const HazardProbe* hazard,
                        ThreadPool& pool) const {
  check_frame_size(frame, sensor_.camera);
  std::vector<std::vector<double>> areas((rays_->size() + kPixelChunk - 1) / kPixelChunk);
  pool.for_each_chunk(rays_->size(), kPixelChunk, [&](std::size_t begin, std::size_t end) {
    add_areas(frame, T_world_camera, before, hazard, {begin, end}, areas[begin / kPixelChunk]);
  });
  double area = 0;  // in the order of the pixels
  for (const std::vector<double>& part : areas) {
    for (const double of_pixel : part) area += of_pixel;
  }
  return area;
}

void RealisedArea::add_areas(const DepthFrame& frame, const Pose& T_world_camera,
                             const BeliefGrid& before, const HazardProbe* hazard,
                             const std::array<std::size_t, 2>& pixels,
                             std::vector<double>& areas) const {
  SurfaceBehind behind(before);
  for (std::size_t i = pixels[0]; i < pixels[1]; ++i) {
    const float z = frame.depth[i];
    if (!(z > 0) || !std::isfinite(z) || !(*rays_)[i].allFinite()) continue;
    const Eigen::Vector3d p_camera = static_cast<double>(z) * (*rays_)[i];
    const double range = p_camera.norm();
    if (range < sensor_.min_range || range > sensor_.max_range) continue;
    if (frame.shows_known(i)) continue;
    const Eigen::Vector3d point = T_world_camera * p_camera;
    const Eigen::Vector3d sight = point - T_world_camera.translation();
    if (support_plane_ && sees_plane(sensor_, point, sight, *support_plane_)) continue;
    const Eigen::Vector3d place = behind.place(point);
    const std::optional<Index3> voxel = behind.voxel_at(place);
    if (!voxel) continue;
    const VoxelState state = behind.state(*voxel);
    if (state == VoxelState::free) continue;
    const double across = solid_angles_[i] * range * range * worth_(range);
    if (const double cosine = behind.cosine(place, sight.normalized()); cosine > 0) {
      areas.push_back(across * FromBehind::area_over_across(cosine));
    } else if (state == VoxelState::unknown && (hazard == nullptr || hazard->is_new(*voxel))) {
      areas.push_back(across);
    }
  }
}

}  // namespace viewgain::detail
