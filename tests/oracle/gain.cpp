// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "oracle/gain.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

namespace viewgain::oracle {
namespace {

double entropy_of(const Eigen::Matrix3d& information, Criterion criterion) {
  const Eigen::Matrix3d covariance = information.inverse();
  switch (criterion) {
    case Criterion::log_diagonal:
      return 0.5 * covariance.diagonal().array().log().sum();
    case Criterion::log_determinant:
      return 0.5 * std::log(covariance.determinant());
    case Criterion::trace:
      return covariance.trace();
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// Λ_r as the inverse of eq. (1)'s covariance, in the grid's frame.
bool is_rigid(const Pose& pose) {
  if (!std::all_of(pose.m.begin(), pose.m.end(), [](double x) { return std::isfinite(x); })) {
    return false;
  }
  const Eigen::Matrix3d R = pose.rotation();
  const Eigen::Matrix3d off = R.transpose() * R - Eigen::Matrix3d::Identity();
  return off.cwiseAbs().maxCoeff() <= 1e-3 && R.determinant() > 0;
}

VoxelState state_at(const BeliefGrid& grid, const Eigen::Vector3d& p_world) {
  const Eigen::Vector3d p = grid.T_world_grid().rotation().transpose() *
                            (p_world - grid.T_world_grid().translation()) / grid.voxel_size();
  const auto index = [](double x) { return static_cast<std::int32_t>(std::floor(x)); };
  if (p.cwiseAbs().maxCoeff() > 1e9) return VoxelState::unknown;
  return grid.state({index(p.x()), index(p.y()), index(p.z())});
}

/// All that ended in one voxel.
struct Touched {
  Eigen::Matrix3d added = Eigen::Matrix3d::Zero();
  VoxelState state = VoxelState::unknown;
};

using TouchedVoxels = std::map<std::tuple<int, int, int>, Touched>;

std::vector<Ray> rays_of(const BeliefGrid& grid, const Sensor& sensor, const GainConfig& config,
                         const Pose& T_world_camera) {
  return view_rays(grid.T_world_grid(), grid.voxel_size(), sensor.camera, config.pixel_stride,
                   T_world_camera);
}

bool is_gaining(const RayHit& hit) {
  return hit.kind == RayHit::Kind::unknown || hit.kind == RayHit::Kind::occupied;
}

Eigen::Matrix3d prior_of(const BeliefGrid& grid, const GainConfig& config) {
  const double sigma = config.prior_sigma.value_or(grid.prior_sigma());
  return Eigen::Matrix3d::Identity() / (sigma * sigma);
}

}  // namespace

ViewGain gain_of_hits(const BeliefGrid& grid, const Sensor& sensor, const GainConfig& config,
                      const Pose& T_world_camera, std::span<const RayHit> hits) {
  ViewGain result;
  if (!is_rigid(T_world_camera)) return result;
  const std::vector<Ray> rays = rays_of(grid, sensor, config, T_world_camera);
  result.status = ViewGain::Status::ok;
  result.rays = static_cast<std::uint32_t>(rays.size());
  result.gain = result.exploration = result.refinement = result.posterior_entropy = 0;
  if (state_at(grid, T_world_camera.translation()) == VoxelState::occupied) {
    result.status = ViewGain::Status::camera_in_occupied;
    return result;
  }

  TouchedVoxels touched;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const RayHit& hit = hits[i];
    if (!is_gaining(hit)) continue;
    Touched& voxel = touched[{hit.voxel.x, hit.voxel.y, hit.voxel.z}];
    voxel.added += information_of(sensor, rays[i].direction, hit.range);
    voxel.state = hit.kind == RayHit::Kind::occupied ? VoxelState::occupied : VoxelState::unknown;
    ++result.hits;
  }

  for (const auto& [key, voxel] : touched) {
    const Index3 index{std::get<0>(key), std::get<1>(key), std::get<2>(key)};
    const bool occupied = voxel.state == VoxelState::occupied;
    Eigen::Matrix3d held = Eigen::Matrix3d::Zero();
    if (occupied) {
      const std::optional<Belief> belief = grid.belief(index);
      if (belief) {
        // A cell of scale s is 4^s voxels of surface.
        held = belief->information_matrix().matrix() / std::pow(4.0, grid.scale(index));
      }
    }
    const Eigen::Matrix3d before = prior_of(grid, config) + held;
    const double gain =
        weight_of(config, grid.voxel_size(), index) *
        (entropy_of(before, config.criterion) - entropy_of(before + voxel.added, config.criterion));
    (occupied ? result.refinement : result.exploration) += gain;
    ++(occupied ? result.occupied_voxels : result.unknown_voxels);
    result.posterior_entropy += (held + voxel.added).inverse().diagonal().array().log().sum();
  }
  result.gain = result.exploration + result.refinement;
  return result;
}

double largest_one_hit_gain(const BeliefGrid& grid, const Sensor& sensor, const GainConfig& config,
                            const Pose& T_world_camera, std::span<const RayHit> hits) {
  const std::vector<Ray> rays = rays_of(grid, sensor, config, T_world_camera);
  const Eigen::Matrix3d prior = prior_of(grid, config);
  double largest = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!is_gaining(hits[i])) continue;
    const Eigen::Matrix3d added = information_of(sensor, rays[i].direction, hits[i].range);
    largest = std::max(largest, weight_of(config, grid.voxel_size(), hits[i].voxel) *
                                    (entropy_of(prior, config.criterion) -
                                     entropy_of(prior + added, config.criterion)));
  }
  return largest;
}

}  // namespace viewgain::oracle
