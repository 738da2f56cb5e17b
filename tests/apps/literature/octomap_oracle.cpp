// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/literature/octomap_oracle.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "grid/voxels.hpp"
#include "oracle/rays.hpp"

namespace viewgain::test {
namespace {

constexpr int kMiddleKey = 32768;  // of OctoMap's 16 bits

octomap::OcTreeKey key_of(const oracle::DenseMap& map, Index3 voxel) {
  const auto part = [](int v, int base) {
    return static_cast<octomap::key_type>(v - base + kMiddleKey);
  };
  return {part(voxel.x, map.min_index.x), part(voxel.y, map.min_index.y),
          part(voxel.z, map.min_index.z)};
}

double entropy(double p) {
  return p <= 0 || p >= 1 ? 0.0 : -p * std::log(p) - (1 - p) * std::log(1 - p);
}

double area_function(double x, double a) {
  if (x <= a) return -2 / std::pow(a, 3) * std::pow(x, 3) + 3 / std::pow(a, 2) * std::pow(x, 2);
  return -2 / std::pow(a - 1, 3) * std::pow(x, 3) + 3 * (a + 1) / std::pow(a - 1, 3) * x * x -
         6 * a / std::pow(a - 1, 3) * x + (3 * a - 1) / std::pow(a - 1, 3);
}

}  // namespace

OctomapOracle::OctomapOracle(const BeliefGrid& grid, const Surroundings& surroundings,
                             const std::optional<Acquisition>& acquisition)
    : map_(grid), surroundings_(surroundings), tree_(1.0) {
  for_each_voxel(grid, [&](Index3 voxel) {
    if (const auto log_odds = grid.log_odds(voxel)) {
      tree_.setNodeValue(key_of(map_, voxel), *log_odds, true);
    }
  });
  if (acquisition) mark_occlusion(grid.views(), *acquisition);
}

const octomap::OcTreeNode* OctomapOracle::find(Index3 voxel) const {
  return map_.inside(voxel) ? tree_.search(key_of(map_, voxel)) : nullptr;
}

std::vector<OctomapOracle::Visit> OctomapOracle::visits(const oracle::Ray& ray, double near,
                                                        double far, bool ends_in_occupied) const {
  std::vector<Visit> list;
  oracle::walk(map_, ray, [&](Index3 voxel, double t_in, double t_out) {
    if (ends_in_occupied && oracle::blocks(map_, ray, {.min_range = near}, voxel, t_in))
      return true;
    if (t_out <= near) return false;
    if (t_in >= far) return true;
    list.push_back({voxel, std::max(t_in, near), std::min(t_out, far), find(voxel)});
    const auto* node = list.back().node;
    return ends_in_occupied && node != nullptr && node->getLogOdds() > 0;
  });
  return list;
}

void OctomapOracle::mark_occlusion(const std::vector<Pose>& views, const Acquisition& acquisition) {
  const Sensor& sensor = acquisition.sensor;
  const double V = map_.voxel_size;
  occlusion_depth_ = acquisition.occlusion_depth / V;
  for (const Pose& view : views) {
    for (const oracle::Ray& ray : oracle::view_rays(map_.T_world_grid, V, sensor.camera, 1, view)) {
      const double far = std::min(sensor.max_range / V,
                                  oracle::obstacle_range(map_, surroundings_.obstacles, ray));
      const auto seen = visits(ray, sensor.min_range / V, far, true);
      if (seen.empty() || seen.back().node == nullptr || !(seen.back().node->getLogOdds() > 0)) {
        continue;
      }
      const double surface = seen.back().begin;
      int step = 0;
      bool is_behind = false;
      for (const Visit& visit : visits(ray, surface, surface + occlusion_depth_, false)) {
        if (is_behind) ++step;
        is_behind = is_behind || visit.voxel == seen.back().voxel;
        if (step == 0 || visit.node != nullptr) continue;
        int& known = occlusion_.try_emplace({visit.voxel.x, visit.voxel.y, visit.voxel.z}, step)
                         .first->second;
        known = std::min(known, step);
      }
    }
  }
}

int OctomapOracle::occlusion_steps(Index3 voxel) const {
  const auto found = occlusion_.find({voxel.x, voxel.y, voxel.z});
  return found == occlusion_.end() ? 0 : found->second;
}

bool OctomapOracle::is_surface_frontier(Index3 voxel) const {
  if (!map_.inside(voxel) || find(voxel) != nullptr) return false;
  bool near_free = false, near_occupied = false;
  const Index3 first{voxel.x - 1, voxel.y - 1, voxel.z - 1};
  for_each_voxel(VoxelBox::from_dims(first, {3, 3, 3}), [&](Index3 near) {
    const auto* node = find(near);
    if (node != nullptr) (node->getLogOdds() > 0 ? near_occupied : near_free) = true;
  });
  return near_free && near_occupied;
}

std::array<double, 10> OctomapOracle::gains(const Sensor& sensor, const ClassicConfig& config,
                                            const Pose& T_world_camera) const {
  const double V = map_.voxel_size;
  const double near = config.min_range.value_or(sensor.min_range) / V;
  std::array<double, 10> result{};

  const Eigen::Vector3d eye = map_.T_world_grid.inverse() * T_world_camera.translation() / V;
  const Index3 own{static_cast<int>(std::floor(eye.x())), static_cast<int>(std::floor(eye.y())),
                   static_cast<int>(std::floor(eye.z()))};
  const auto* own_node = find(own);
  if (own_node != nullptr && own_node->getLogOdds() > 0) return result;

  std::vector<SeenRay> rays;
  const auto angles = sensor.camera.solid_angles(sensor.camera.ray_table());
  const int columns = (sensor.camera.width - 1) / config.pixel_stride + 1;
  const std::vector<oracle::Ray> image_rays =
      oracle::view_rays(map_.T_world_grid, V, sensor.camera, config.pixel_stride, T_world_camera);
  const double pixels_a_ray =
      static_cast<double>(angles.size()) / static_cast<double>(image_rays.size());
  int number = 0;
  for (const oracle::Ray& ray : image_rays) {
    const int row = number / columns, column = number % columns;
    ++number;
    if (!ray.direction.allFinite()) continue;
    double far = std::min(config.max_range.value_or(sensor.max_range) / V,
                          oracle::obstacle_range(map_, surroundings_.obstacles, ray));
    if (surroundings_.support_plane) {
      const double above = T_world_camera.translation().z() - *surroundings_.support_plane;  // [m]
      const double rate = (map_.T_world_grid.rotation() * ray.direction).z() * V;
      if (above >= 0 && rate < 0) far = std::min(far, -above / rate);
    }
    rays.push_back({visits(ray, near, far, true),
                    angles[static_cast<std::size_t>((row * sensor.camera.width + column) *
                                                    config.pixel_stride)] *
                        pixels_a_ray});
  }

  const auto p_of = [&](const Visit& v) {
    return v.node == nullptr ? config.unknown_prior : v.node->getOccupancy();
  };
  const auto is_unknown = [](const Visit& v) { return v.node == nullptr; };
  const auto is_occupied = [](const Visit& v) {
    return v.node != nullptr && v.node->getLogOdds() > 0;
  };
  const auto at = [&](ClassicGain gain) -> double& {
    return result[static_cast<std::size_t>(gain)];
  };

  // occlusion_aware, unobserved_voxel
  for (const SeenRay& ray : rays) {
    double P = 1;
    for (const Visit& v : ray.visits) {
      at(ClassicGain::occlusion_aware) += P * entropy(p_of(v));
      if (is_unknown(v)) at(ClassicGain::unobserved_voxel) += P * entropy(p_of(v));
      P *= 1 - p_of(v);
    }
  }
  // average_entropy
  double sum = 0, count = 0;
  for (const SeenRay& ray : rays) {
    for (const Visit& v : ray.visits) sum += entropy(p_of(v)), count += 1;
  }
  at(ClassicGain::average_entropy) = count > 0 ? sum / count : 0;
  // rear_side_voxel
  for (const SeenRay& ray : rays) {
    for (std::size_t i = 1; i < ray.visits.size(); ++i) {
      if (is_occupied(ray.visits[i]) && is_unknown(ray.visits[i - 1])) {
        at(ClassicGain::rear_side_voxel) += 1;
      }
    }
  }
  // rear_side_entropy
  for (const SeenRay& ray : rays) {
    if (ray.visits.empty() || !is_occupied(ray.visits.back())) continue;
    double P = 1, stretch = 0;
    for (std::size_t i = 0; i + 1 < ray.visits.size(); ++i) {
      const Visit& v = ray.visits[i];
      stretch = is_unknown(v) ? stretch + P * entropy(p_of(v)) : 0;
      P *= 1 - p_of(v);
    }
    at(ClassicGain::rear_side_entropy) += stretch;
  }
  // proximity_count
  for (const SeenRay& ray : rays) {
    for (const Visit& v : ray.visits) {
      const int steps = v.node == nullptr ? occlusion_steps(v.voxel) : 0;
      if (steps > 0) at(ClassicGain::proximity_count) += 2 * occlusion_depth_ - steps;
    }
  }
  // area_factor
  double on_surface = 0, on_hidden = 0;
  for (const SeenRay& ray : rays) {
    for (std::size_t i = 0; i < ray.visits.size(); ++i) {
      const Visit& v = ray.visits[i];
      if (v.node == nullptr && occlusion_steps(v.voxel) > 0) {
        on_hidden += 1;
        break;
      }
      if (is_occupied(v) && i > 0 && !is_unknown(ray.visits[i - 1])) {
        on_surface += 1;
        break;
      }
    }
  }
  const auto all = static_cast<double>(std::max<std::size_t>(rays.size(), 1));
  at(ClassicGain::area_factor) =
      area_function(on_surface / all, 0.2) + area_function(on_hidden / all, 0.8);
  // unknown_volume
  for (const SeenRay& ray : rays) {
    for (const Visit& v : ray.visits) {
      if (v.node != nullptr) continue;
      at(ClassicGain::unknown_volume) +=
          ray.solid_angle / 3 * (std::pow(v.end * V, 3) - std::pow(v.begin * V, 3));
    }
  }
  // unknown_count, surface_frontier_count
  std::set<std::tuple<int, int, int>> distinct;
  for (const SeenRay& ray : rays) {
    for (const Visit& v : ray.visits) {
      if (v.node == nullptr) distinct.insert({v.voxel.x, v.voxel.y, v.voxel.z});
    }
  }
  at(ClassicGain::unknown_count) = static_cast<double>(distinct.size());
  for (const auto& [x, y, z] : distinct) {
    if (is_surface_frontier({x, y, z})) at(ClassicGain::surface_frontier_count) += 1;
  }
  return result;
}

}  // namespace viewgain::test
