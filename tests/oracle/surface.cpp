// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "oracle/surface.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>
#include <vector>

namespace viewgain::oracle {
namespace {

using Cell = std::tuple<int, int, int>;

Cell cell_of(Index3 v, int shift) { return {v.x >> shift, v.y >> shift, v.z >> shift}; }

/// The solid angle between a pixel's edges, by the derivative of the rays, in steps of a thousandth
/// of a pixel.
double pixel_angle(const PinholeCamera& camera, int u, int v) {
  constexpr double kStep = 1e-3;
  const Eigen::Vector3d p = camera.ray(u, v);
  const Eigen::Vector3d du = (camera.ray(u + kStep, v) - camera.ray(u - kStep, v)) / (2 * kStep);
  const Eigen::Vector3d dv = (camera.ray(u, v + kStep) - camera.ray(u, v - kStep)) / (2 * kStep);
  return std::abs(p.dot(du.cross(dv))) / std::pow(p.norm(), 3);
}

double entropy_with_floor(const Eigen::Matrix3d& information, double floor) {
  return 0.5 * (information.inverse().diagonal().array() + floor).log().sum();
}

/// From unknown to free voxels around the cube of 2³ of a voxel: Σ (free - unknown) δ over the 27
/// cubes at δ in {-1, 0, 1}³; voxels outside the workspace are neither.
Eigen::Vector3d outward(const DenseMap& map, Index3 voxel) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const Index3 low{(voxel.x >> 1) * 2 - 2, (voxel.y >> 1) * 2 - 2, (voxel.z >> 1) * 2 - 2};
  for (int x = 0; x < 6; ++x) {
    for (int y = 0; y < 6; ++y) {
      for (int z = 0; z < 6; ++z) {
        const Index3 v{low.x + x, low.y + y, low.z + z};
        if (!map.inside(v)) continue;
        const VoxelState state = map.state(v);
        if (state == VoxelState::occupied) continue;
        const Eigen::Vector3d at(x / 2 - 1, y / 2 - 1, z / 2 - 1);
        sum += state == VoxelState::free ? at : -at;
      }
    }
  }
  if (sum.norm() == 0) return sum;
  return (sum.normalized().array() * 511).round() / 511;  // as scenes keep them
}

/// An unknown chord in one hazard cell.
struct Run {
  Cell cell;
  double begin, end;    // [voxels]
  double weighted = 0;  // Σ length w_v [voxels]
  Index3 voxel;
};

}  // namespace

Pool pool_of(const BeliefGrid& grid, const DenseMap& map, Index3 voxel) {
  Pool pool;
  const int scale = grid.scale(voxel), edge = 1 << scale;
  const auto low = [&](int i) { return (i >> scale) * edge; };
  bool is_measured = false;
  for (int i = 0; i < 27; ++i) {
    const Index3 cell{low(voxel.x) + (i / 9 - 1) * edge, low(voxel.y) + (i / 3 % 3 - 1) * edge,
                      low(voxel.z) + (i % 3 - 1) * edge};
    bool has_readings = false;
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (int k = 0; k < edge * edge * edge; ++k) {
      const Index3 v{cell.x + k / (edge * edge), cell.y + k / edge % edge, cell.z + k % edge};
      if (!map.inside(v) || map.state(v) != VoxelState::occupied) continue;
      const auto belief = grid.belief(v);
      if (!belief || belief->hits == 0) continue;
      has_readings = true;
      const Eigen::Matrix3d information = belief->information_matrix().matrix();
      const int other = grid.scale(v);
      if (other > scale) {
        sum = information / std::pow(4.0, other);
      } else {
        sum += information / std::pow(8.0, other) / std::pow(4.0, scale);
      }
    }
    pool.information += sum;
    pool.voxels += has_readings ? 1 : 0;
    if (i == 13) is_measured = has_readings;
  }
  if (!is_measured) pool.voxels = 0;
  return pool;
}

double pooled_entropy(const Pool& pool, double prior_sigma, double floor) {
  const double prior = 1 / (prior_sigma * prior_sigma);
  return entropy_with_floor(pool.information + prior * Eigen::Matrix3d::Identity(), floor);
}

SurfaceValue surface_value(const BeliefGrid& grid, const DenseMap& map, const HazardField& hazard,
                           const Sensor& sensor, const GainConfig& config,
                           const Pose& T_world_camera, const Obstacles& obstacles) {
  const double V = grid.voxel_size(), floor = V * V;
  const double sigma_0 = config.prior_sigma.value_or(grid.prior_sigma());
  const Eigen::Matrix3d prior = Eigen::Matrix3d::Identity() / (sigma_0 * sigma_0);
  const double stride = config.pixel_stride;
  const double cap =
      stride * stride * std::numbers::pi * std::pow(hazard.pooling().length, 2) / 2;  // [m²]
  // How much less than at the working distance readings at range t [m] say: they miss by σ_ax.
  const auto misses = [&](double t) { return 1 + sensor.noise_sigmas(t).axial / V; };
  SurfaceValue value;
  std::map<Cell, Eigen::Matrix3d> refined;

  const std::vector<Ray> rays =
      view_rays(grid.T_world_grid(), V, sensor.camera, config.pixel_stride, T_world_camera);
  const int columns = (sensor.camera.width - 1) / config.pixel_stride + 1;
  const double pixels_a_ray = static_cast<double>(sensor.camera.width) * sensor.camera.height /
                              static_cast<double>(rays.size());
  RayLimits limits = limits_of(map, sensor, config);
  int undecided = 0;
  double undecided_area = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Ray& ray = rays[i];
    if (!ray.direction.allFinite()) continue;
    const int u = static_cast<int>(i) % columns * config.pixel_stride;
    const int v = static_cast<int>(i) / columns * config.pixel_stride;
    const double angle = pixels_a_ray * pixel_angle(sensor.camera, u, v);
    const double last = std::min(limits.max_range, obstacle_range(map, obstacles, ray));
    double passed = 1;
    std::optional<Run> run;
    // The stretch of unknown voxels up to here.
    bool in_stretch = false;
    double stretch_begin = 0, stretch_passed = 1, stretch_share = 0;
    double stretch_area = 0, stretch_all = 0;  // of new surface; of all, new or not
    double last_across = 0;
    const auto close = [&] {
      if (!run) return;
      const double h = static_cast<double>(hazard.rate(run->voxel));
      const double length = run->end - run->begin;
      const double depth = h * length * V;
      const double P = passed * -std::expm1(-depth);
      const double t = 0.5 * (run->begin + run->end) * V;
      // ∫ t² dt / L
      const double squared =
          (std::pow(run->end, 3) - std::pow(run->begin, 3)) / (3 * length) * V * V;
      const double across =
          std::min(angle * squared, cap) * misses(sensor.working_distance) / misses(t);
      value.pixel_area = std::max(value.pixel_area, across);
      last_across = across;
      const double area = P * across * run->weighted / length;
      stretch_all += area;
      if (hazard.is_new(run->voxel)) {
        value.area += area;
        stretch_area += area;
      }
      passed *= std::exp(-depth);
      stretch_share += P;
      run.reset();
    };
    walk(map, ray, [&](Index3 voxel, double t_in, double t_out) {
      if (blocks(map, ray, limits, voxel, t_in)) return true;
      if (t_out <= limits.min_range) return false;
      const double begin = std::max(t_in, limits.min_range), end = std::min(t_out, last);
      if (begin >= end) return true;
      switch (map.state(voxel)) {
        case VoxelState::free:
          close();
          in_stretch = false;
          return false;
        case VoxelState::unknown: {
          const Cell cell = cell_of(voxel, hazard.cell_shift());
          if (run && (run->cell != cell || run->end != begin)) close();
          if (!in_stretch) {
            in_stretch = true;
            stretch_begin = begin, stretch_passed = passed;
            stretch_share = stretch_area = stretch_all = 0;
          }
          if (!run) run = Run{cell, begin, end, 0, voxel};
          run->end = end;
          run->weighted += (end - begin) * weight_of(config, V, voxel);
          return end >= last;
        }
        case VoxelState::occupied:
          break;
      }
      close();
      if (in_stretch) {
        const double cosine = outward(map, voxel).dot(ray.direction);
        const double length = begin - stretch_begin;
        const double chance = stretch_passed > 0 ? stretch_share / stretch_passed : 0;
        if (cosine > 0.2 && length >= 2) {
          // Parallel to the known surface, and new.
          if (chance > 0) {
            value.area += stretch_all / (chance * std::max(cosine, 0.35)) - stretch_area;
          }
          passed = 0;
        }
        if ((std::abs(cosine - 0.2) < 3e-3 && length > 1.99) ||
            (std::abs(length - 2) < 1e-3 && cosine > 0.19)) {
          ++undecided;
          undecided_area += last_across / 0.35;
        }
      }
      const Eigen::Matrix3d added = passed * information_of(sensor, ray.direction, begin * V);
      const auto [entry, is_first] =
          refined.try_emplace(cell_of(voxel, 0), Eigen::Matrix3d::Zero());
      entry->second += added;
      const double most = entropy_with_floor(prior, floor) -
                          entropy_with_floor(prior + 9 * added / std::max(passed, 1e-300), floor);
      value.pixel_refinement = std::max(value.pixel_refinement, most);
      return true;
    });
    close();
  }
  value.pixel_area += undecided_area;
  double largest_chance = 0;
  for (const auto& [cell, added] : refined) {
    const auto& [x, y, z] = cell;
    const Pool before = pool_of(grid, map, {x, y, z});
    if (before.voxels == 0) continue;  // what was never measured is not refined
    // The view adds as much as here to nine of the 27 voxels.
    const Pool after{before.information + 9 * added, before.voxels};
    const double chance = std::min(before.voxels / 9.0, 1.0);
    largest_chance = std::max(largest_chance, chance);
    value.refinement_saturated +=
        weight_of(config, V, {x, y, z}) * chance *
        (pooled_entropy(before, sigma_0, floor) - pooled_entropy(after, sigma_0, floor));
  }
  value.pixel_refinement *= (1 + undecided) * largest_chance;
  if (config.model == GainModel::surface) {
    value.gain = value.area;
  } else {
    const Eigen::Matrix3d seen =
        prior + 27 * information_of(sensor, Eigen::Vector3d::UnitZ(), sensor.working_distance);
    const double each = entropy_with_floor(prior, floor) - entropy_with_floor(seen, floor);
    value.gain =
        value.area / (V * V) * each + config.refinement_weight * value.refinement_saturated;
  }
  return value;
}

double distance_to_evidence(const BeliefGrid& grid, int shift, Index3 voxel, int pooling) {
  const auto centre = [&](Index3 v) -> Eigen::Vector3d {
    const double edge = 1 << shift;
    return Eigen::Vector3d(std::floor(v.x / edge), std::floor(v.y / edge), std::floor(v.z / edge)) *
           edge;
  };
  std::map<Cell, std::uint64_t> hits;
  const auto for_each_occupied = [&](auto&& visit) {
    grid.for_each_belief([&](Index3 v, const Belief& belief) {
      if (grid.state(v) == VoxelState::occupied) visit(v, belief);
    });
  };
  for_each_occupied([&](Index3 v, const Belief& belief) {
    hits[cell_of(v, std::max(pooling, grid.scale(v)))] += belief.hits;
  });
  double nearest = std::numeric_limits<double>::infinity();
  for_each_occupied([&](Index3 v, const Belief&) {
    if (hits[cell_of(v, std::max(pooling, grid.scale(v)))] < 3) return;
    const int edge = 1 << grid.scale(v);  // of the belief's cell
    for (int i = 0; i < edge * edge * edge; ++i) {
      const Index3 at{v.x + i / (edge * edge), v.y + i / edge % edge, v.z + i % edge};
      nearest = std::min(nearest, (centre(at) - centre(voxel)).norm() * grid.voxel_size());
    }
  });
  return nearest;
}

}  // namespace viewgain::oracle
