// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/hazard_views.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/support/belief_block.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

enum class Cell : std::uint8_t { free, unknown, occupied };

// The hazard's cells and their contents; a cell that is not entirely free is unknown.
class Cells {
 public:
  explicit Cells(const VoxelScene& scene)
      : shift_(scene.hazard().cell_shift()), voxels_(scene.hazard().near_box()) {
    box_ = {at(voxels_.min), at(voxels_.max)};
    states_.assign(box_.volume(), Cell::free);
    const GridSnapshot& snapshot = scene.snapshot();
    for (const GridSnapshot::Leaf& leaf : snapshot.leaves) {
      if (VoxelBox::from_dims(leaf.origin, {8, 8, 8}).intersection(voxels_).volume() == 0) continue;
      for_each_bit(leaf.non_free, [&](unsigned offset) {
        const Index3 voxel = offset_voxel(leaf.origin, offset);
        if (!voxels_.contains(voxel)) return;
        Cell& cell = states_[place(at(voxel))];
        cell = std::max(cell, test_bit(leaf.occupied, offset) ? Cell::occupied : Cell::unknown);
      });
    }
    for (const VoxelBox& tile : snapshot.tiles) {
      const VoxelBox part = tile.intersection(voxels_);
      if (part.volume() == 0) continue;
      const Index3 last = at({part.max.x - 1, part.max.y - 1, part.max.z - 1});
      for (int x = part.min.x >> shift_; x <= last.x; ++x) {
        for (int y = part.min.y >> shift_; y <= last.y; ++y) {
          for (int z = part.min.z >> shift_; z <= last.z; ++z) {
            Cell& cell = states_[place({x, y, z})];
            cell = std::max(cell, Cell::unknown);
          }
        }
      }
    }
  }

  [[nodiscard]] const VoxelBox& box() const { return box_; }
  // Space beyond the box is too far from known surface to matter.
  [[nodiscard]] Cell operator[](Index3 c) const {
    return box_.contains(c) ? states_[place(c)] : Cell::occupied;
  }

 private:
  [[nodiscard]] Index3 at(Index3 voxel) const {
    return {voxel.x >> shift_, voxel.y >> shift_, voxel.z >> shift_};
  }
  [[nodiscard]] std::size_t place(Index3 c) const {
    const auto extent = [](int from, int to) { return static_cast<std::size_t>(to - from); };
    return (extent(box_.min.x, c.x) * extent(box_.min.y, box_.max.y) + extent(box_.min.y, c.y)) *
               extent(box_.min.z, box_.max.z) +
           extent(box_.min.z, c.z);
  }

  int shift_;
  VoxelBox voxels_, box_;
  std::vector<Cell> states_;
};

// Faces in a cube: expected area by direction, and position.
struct Place {
  std::array<double, 6> areas{};                       // -x, +x, -y, +y, -z, +z [m²]
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();  // [m³]

  [[nodiscard]] double area() const {
    double sum = 0;
    for (const double a : areas) sum += a;
    return sum;
  }
  // The better of two opposite sides.
  [[nodiscard]] Eigen::Vector3d outward() const {
    Eigen::Vector3d n;
    for (std::size_t a = 0; a < 3; ++a) {
      const double low = areas[2 * a], high = areas[2 * a + 1];
      n[static_cast<Eigen::Index>(a)] = high >= low ? high : -low;
    }
    return n.normalized();
  }
};

// Places where faces look out of unknown space, largest area first; world frame.
struct Target {
  Eigen::Vector3d at, outward;  // world [m]
  double area;                  // [m²]
};

std::vector<Target> targets_in(const VoxelScene& scene, double distance, double spacing) {
  for (const double length : {distance, spacing}) {
    if (length > 0 && std::isfinite(length)) continue;
    refuse("hazard views: distance and spacing must be positive and finite, not " +
           short_text(length) + " m");
  }
  const HazardField& hazard = scene.hazard();
  const double edge = hazard.voxel_size() * (1 << hazard.cell_shift());
  const Cells cells(scene);
  const VoxelBox& box = cells.box();
  std::map<std::array<int, 3>, Place> places;
  for (int x = box.min.x; x < box.max.x; ++x) {
    for (int y = box.min.y; y < box.max.y; ++y) {
      for (int z = box.min.z; z < box.max.z; ++z) {
        if (cells[{x, y, z}] != Cell::unknown) continue;
        for (std::size_t side = 0; side < 6; ++side) {
          std::array<int, 3> to{};
          to[side / 2] = side % 2 == 0 ? -1 : 1;
          if (cells[{x + to[0], y + to[1], z + to[2]}] != Cell::free) continue;
          double depth = 0;
          for (Index3 c{x, y, z}; cells[c] == Cell::unknown;
               c = {c.x - to[0], c.y - to[1], c.z - to[2]}) {
            const Index3 voxel{c.x << hazard.cell_shift(), c.y << hazard.cell_shift(),
                               c.z << hazard.cell_shift()};
            if (!hazard.is_new(voxel)) break;
            depth += edge * static_cast<double>(hazard.rate(voxel));
          }
          if (depth == 0) continue;
          const Eigen::Vector3d p = edge * Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5);
          const Eigen::Vector3i cube = (p / spacing).array().floor().cast<int>();
          Place& place = places[{cube.x(), cube.y(), cube.z()}];
          const double area = edge * edge * -std::expm1(-depth);
          place.areas[side] += area;
          place.weighted += area * p;
        }
      }
    }
  }
  std::vector<Place> best;
  for (const auto& [cube, place] : places) best.push_back(place);
  std::stable_sort(best.begin(), best.end(),
                   [](const Place& a, const Place& b) { return a.area() > b.area(); });

  const Pose& T_world_grid = scene.snapshot().T_world_grid;
  std::vector<Target> targets;
  for (const Place& place : best) {
    targets.push_back({T_world_grid * Eigen::Vector3d(place.weighted / place.area()),
                       T_world_grid.rotation() * place.outward(), place.area()});
  }
  return targets;
}

// Direction at an angle [rad] to n, rotated about it by `turn` [rad].
Eigen::Vector3d tilted(const Eigen::Vector3d& n, double tilt, double turn) {
  const Eigen::Vector3d beside = n.unitOrthogonal();
  return std::cos(tilt) * n +
         std::sin(tilt) * (std::cos(turn) * beside + std::sin(turn) * n.cross(beside));
}

double fraction(double x) { return x - std::floor(x); }

}  // namespace

std::vector<Pose> hazard_views(const VoxelScene& scene, double distance, double spacing,
                               std::size_t most) {
  constexpr double kTilt = 30 * std::numbers::pi / 180, kQuarter = std::numbers::pi / 2;
  std::vector<Pose> views;
  for (const Target& target : targets_in(scene, distance, spacing)) {
    for (const auto& [tilt, turn] :
         {std::pair(0.0, 0.0), std::pair(kTilt, 0.0), std::pair(kTilt, 2 * kQuarter),
          std::pair(kTilt, kQuarter), std::pair(kTilt, 3 * kQuarter)}) {
      if (views.size() == most) return views;
      views.push_back(
          look_at(target.at + distance * tilted(target.outward, tilt, turn), target.at));
    }
  }
  return views;
}

std::vector<Pose> reachable_hazard_views(const VoxelScene& scene, const ReachRegion& reach,
                                         double distance, double spacing, std::size_t count) {
  constexpr std::array<double, 3> kDistances{1, 1.6, 2.5}, kToMiddle{0, 0.5, 1};
  constexpr std::size_t kTries = 16;  // attempts per view
  const double least_cosine = std::cos(75 * std::numbers::pi / 180);
  const std::vector<Target> targets = targets_in(scene, distance, spacing);
  std::vector<double> sums;
  double sum = 0;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Target& target : targets) {
    sums.push_back(sum += target.area);
    middle += target.area * target.at;
  }
  if (targets.empty()) return {};
  middle /= sum;
  std::vector<Pose> views;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t attempt = 0; attempt < kTries; ++attempt) {
      // Sequences whose consecutive members are spread evenly.
      const auto n = static_cast<double>(i + attempt * count + 1);
      const double place = sum * fraction(n * 0.6180339887498949);
      const std::size_t k = static_cast<std::size_t>(
          std::lower_bound(sums.begin(), sums.end() - 1, place) - sums.begin());
      const double cosine = 1 - (1 - least_cosine) * fraction(n * 0.7548776662466927);
      const Eigen::Vector3d away = tilted(targets[k].outward, std::acos(cosine),
                                          2 * std::numbers::pi * fraction(n * 0.5698402909980532));
      const double far = kDistances[i % kDistances.size()] * distance;
      const Pose view = look_at(targets[k].at + far * away,
                                targets[k].at + kToMiddle[i / 3 % 3] * (middle - targets[k].at));
      if (!reach.contains(view)) continue;
      views.push_back(view);
      break;
    }
  }
  return views;
}

}  // namespace viewgain
