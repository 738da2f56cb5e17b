// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "classic_walk.hpp"

#include <array>

#include "ordered_ray.hpp"

namespace viewgain::detail {
namespace {

// What a ray has met so far.
struct RaySums {
  double visibility = 1;
  double occlusion_aware = 0, unobserved = 0, entropy = 0, voxels = 0;
  double stretch = 0;         // Σ P H since the ray is among voxels that count as unknown
  std::uint8_t before = 0;    // kind of the voxel before, 0: none
  bool is_on_hidden = false;  // has come to what a measured surface hides
};

void add_end(const ClassicView& view, std::uint8_t kind, double entropy, const RaySums& ray,
             ClassicSums& sums) {
  if ((kind & VoxelValues::kIsOccupied) == 0) return;
  const bool from_unknown = (ray.before & VoxelValues::kIsUnknown) != 0;
  if (from_unknown) {
    ++sums.rear_side;
    sums.rear_side_entropy += ray.stretch;
  }
  if (view.is_shipped) sums.rear_side_entropy += ray.visibility * entropy;
  if (!ray.is_on_hidden && (ray.before & VoxelValues::kIsFree) != 0) ++sums.on_surface;
  if (view.is_shipped) {
    sums.entropy += ray.entropy + entropy;
    sums.voxels += ray.voxels + 1;
  }
}

void add_ray(const ClassicView& view, const ClassicTile& tile, int lane, ClassicSums& sums,
             DistinctVoxels& distinct) {
  const VoxelValues& values = view.values;
  OrderedRay walk(view.table, view.origin, {tile.dx[lane], tile.dy[lane], tile.dz[lane]},
                  view.min_range, tile.far[lane]);
  RaySums ray;
  while (walk.goes_on()) {
    const CubeVisit visit = walk.next([&](std::uint32_t word) {
      return view.is_distinct && (word & ClassicTable::kCode) == OccupancyCodes::kUnknown;
    });
    if (!(visit.begin < visit.end)) continue;
    const std::uint32_t code = visit.word & ClassicTable::kCode;
    const std::uint8_t kind = values.kinds[code];
    const bool ends = OccupancyCodes::is_occupied(static_cast<std::uint8_t>(code));
    const std::uint32_t n = ends ? 1 : visit.voxels;
    const auto count = static_cast<double>(n);
    const double visible = ray.visibility * values.sums[code * VoxelValues::kRow + n];
    ray.occlusion_aware += visible;
    if ((kind & VoxelValues::kIsUnknown) != 0) ray.unobserved += visible;
    if (ends) {
      add_end(view, kind, values.entropy[code], ray, sums);
      if (!view.is_shipped) {
        ray.entropy += values.entropy[code];
        ray.voxels += 1;
      }
      break;
    }
    ray.entropy += count * values.entropy[code];
    ray.voxels += count;
    ray.stretch = (kind & VoxelValues::kIsUnknown) != 0 ? ray.stretch + visible : 0;
    ray.before = kind;
    ray.visibility *= values.powers[code * VoxelValues::kRow + n];
    if (code != OccupancyCodes::kUnknown) continue;
    const std::uint32_t steps = visit.word >> ClassicTable::kStepsShift & ClassicTable::kMostSteps;
    if (steps > 0) {
      ray.is_on_hidden = true;
      sums.proximity += count * (view.most_steps - static_cast<double>(steps));
    }
    sums.volume += static_cast<double>(tile.solid_angle[lane]) / 3 *
                   (visit.end * visit.end * visit.end - visit.begin * visit.begin * visit.begin);
    if (view.is_distinct) distinct.mark(visit.voxel[0], visit.voxel[1], visit.voxel[2], visit.word);
  }
  sums.occlusion_aware += ray.occlusion_aware;
  sums.unobserved += ray.unobserved;
  sums.on_hidden += ray.is_on_hidden ? 1 : 0;
  if (!view.is_shipped) {
    sums.entropy += ray.entropy;
    sums.voxels += ray.voxels;
  }
}

}  // namespace

void add_tile(const ClassicView& view, const ClassicTile& tile, ClassicSums& sums,
              DistinctVoxels& distinct) {
  for (int lane = 0; lane < kTileRays; ++lane) {
    if ((tile.valid >> lane & 1U) != 0) add_ray(view, tile, lane, sums, distinct);
  }
}

}  // namespace viewgain::detail
