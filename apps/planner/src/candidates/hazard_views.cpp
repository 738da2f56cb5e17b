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

#include "viewgain/core/error.hpp"
#include "viewgain/support/belief_block.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

enum class Cell : std::uint8_t { free, unknown, occupied };

// The hazard's cells and what is in them; a cell that is not all free is unknown.
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
  // What is beyond the box is too far from known surface to be asked.
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

// Of the faces in a cube: area to be expected by the direction to which they look, and where.
struct Place {
  std::array<double, 6> areas{};                       // -x, +x, -y, +y, -z, +z [m²]
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();  // [m³]

  [[nodiscard]] double area() const {
    double sum = 0;
    for (const double a : areas) sum += a;
    return sum;
  }
  // Of two sides that look away from one another the better.
  [[nodiscard]] Eigen::Vector3d outward() const {
    Eigen::Vector3d n;
    for (std::size_t a = 0; a < 3; ++a) {
      const double low = areas[2 * a], high = areas[2 * a + 1];
      n[static_cast<Eigen::Index>(a)] = high >= low ? high : -low;
    }
    return n.normalized();
  }
};

}  // namespace

std::vector<Pose> hazard_views(const VoxelScene& scene, double distance, double spacing,
                               std::size_t most) {
  for (const double length : {distance, spacing}) {
    if (length > 0 && std::isfinite(length)) continue;
    refuse("views by the hazard: a length must not be " + short_text(length) + " m");
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

  constexpr double kTilt = 30 * std::numbers::pi / 180;
  const Pose& T_world_grid = scene.snapshot().T_world_grid;
  std::vector<Pose> views;
  for (const Place& place : best) {
    const Eigen::Vector3d target = T_world_grid * Eigen::Vector3d(place.weighted / place.area());
    const Eigen::Vector3d n = T_world_grid.rotation() * place.outward();
    const Eigen::Vector3d beside = n.unitOrthogonal(), above = n.cross(beside);
    const std::array<Eigen::Vector3d, 5> tilts{Eigen::Vector3d::Zero(), beside, -beside, above,
                                               -above};
    for (const Eigen::Vector3d& tilt : tilts) {
      if (views.size() == most) return views;
      const Eigen::Vector3d away =
          tilt.isZero(0) ? n : Eigen::Vector3d(std::cos(kTilt) * n + std::sin(kTilt) * tilt);
      views.push_back(look_at(target + distance * away, target));
    }
  }
  return views;
}

}  // namespace viewgain
