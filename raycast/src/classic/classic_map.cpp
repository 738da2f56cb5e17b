// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What classic gains read of a map, and which unknown voxels earlier views have left behind
// surfaces.
#include <algorithm>
#include <cmath>
#include <mutex>
#include <string>
#include <utility>

#include "classic_map_data.hpp"
#include "classic_rays.hpp"
#include "ordered_ray.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/thread_pool.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

using namespace detail;

// A ray enters at most √3 voxels a voxel's length, and steps are kept in a byte.
constexpr double kMostDepth = 140;  // [voxels]
constexpr std::size_t kStrips = 8;  // of a view, that threads take

[[noreturn]] void reject(const std::string& what) {
  throw Error(ErrorCode::invalid_argument, what);
}

void check(const VoxelScene* scene, const BeliefGrid& grid,
           const std::optional<Acquisition>& acquisition) {
  if (scene == nullptr) reject("the classic gains have no scene");
  const GridSnapshot& snapshot = scene->snapshot();
  if (!(snapshot.min_index == grid.min_index() && snapshot.dims == grid.dims() &&
        snapshot.voxel_size == grid.voxel_size() && snapshot.T_world_grid == grid.T_world_grid())) {
    reject("the scene is not of this map: their workspaces differ");
  }
  if (!acquisition) return;
  acquisition->sensor.validate();
  const double depth = acquisition->occlusion_depth;
  if (!std::isfinite(depth) || depth < 0 || depth > kMostDepth * grid.voxel_size()) {
    reject("the occlusion depth is " + short_text(depth) + " m; it must be in 0.." +
           short_text(kMostDepth * grid.voxel_size()) + " m, " + short_text(kMostDepth) +
           " voxels of this map");
  }
}

// Follows the rays of the views that made a map.
class OcclusionTracer {
 public:
  OcclusionTracer(const VoxelScene& scene, const ClassicTable& table,
                  const Acquisition& acquisition)
      : scene_(scene),
        table_(table),
        rays_(acquisition.sensor.camera, 1),
        min_range_(acquisition.sensor.min_range / scene.snapshot().voxel_size),
        max_range_(acquisition.sensor.max_range / scene.snapshot().voxel_size),
        depth_(acquisition.occlusion_depth / scene.snapshot().voxel_size) {}

  OcclusionSteps run(std::span<const Pose> views, ThreadPool& pool) const {
    OcclusionSteps all;
    std::mutex mutex;
    pool.for_each_chunk(views.size() * kStrips, 1, [&](std::size_t i, std::size_t) {
      const auto frame = classic_frame(scene_, table_, views[i / kStrips]);
      if (!frame || frame->sees_nothing) return;
      OcclusionSteps steps;
      const std::size_t tiles = rays_.tiles().tile_count, strip = i % kStrips;
      ClassicTile tile;
      for (std::size_t t = tiles * strip / kStrips; t < tiles * (strip + 1) / kStrips; ++t) {
        rays_.place(scene_, table_, *frame, t, max_range_, tile);
        for (int lane = 0; lane < kTileRays; ++lane) {
          if ((tile.valid >> lane & 1U) == 0) continue;
          follow(frame->origin, {tile.dx[lane], tile.dy[lane], tile.dz[lane]}, tile.far[lane],
                 steps);
        }
      }
      const std::lock_guard lock(mutex);
      all.merge(steps);
    });
    return all;
  }

 private:
  void follow(const std::array<double, 3>& origin, const std::array<double, 3>& direction,
              double far, OcclusionSteps& steps) const {
    OrderedRay ray(table_, origin, direction, min_range_, far);
    while (ray.goes_on()) {
      const CubeVisit visit = ray.next(ClassicTable::is_occupied);
      if (visit.begin < visit.end && ClassicTable::is_occupied(visit.word)) {
        return mark_behind(origin, direction, visit, steps);
      }
    }
  }

  void mark_behind(const std::array<double, 3>& origin, const std::array<double, 3>& direction,
                   const CubeVisit& surface, OcclusionSteps& steps) const {
    OrderedRay ray(table_, origin, direction, surface.begin, surface.begin + depth_);
    std::uint32_t count = 0;
    bool is_behind = false;
    while (ray.goes_on()) {
      const CubeVisit visit = ray.next([](std::uint32_t) { return true; });
      if (!(visit.begin < visit.end)) continue;
      if (is_behind) ++count;
      if (visit.voxel == surface.voxel) is_behind = true;
      if (count == 0 || !ClassicTable::is_unknown(visit.word)) continue;
      steps.mark(visit.voxel[0], visit.voxel[1], visit.voxel[2], static_cast<std::uint8_t>(count));
    }
  }

  const VoxelScene& scene_;
  const ClassicTable& table_;
  ClassicRays rays_;
  double min_range_, max_range_, depth_;  // [voxels]
};

std::uint32_t word_at(const ClassicTable& table, Index3 voxel) {
  const std::array<std::int32_t, 3> at{voxel.x - table.base.x, voxel.y - table.base.y,
                                       voxel.z - table.base.z};
  for (std::size_t a = 0; a < 3; ++a) {
    if (at[a] < table.offset[a] || at[a] >= table.offset[a] + table.size[a]) return 0;
  }
  return table.word(at[0], at[1], at[2]);
}

}  // namespace

std::shared_ptr<const ClassicMap> ClassicMap::build(std::shared_ptr<const VoxelScene> scene,
                                                    const BeliefGrid& grid,
                                                    const std::optional<Acquisition>& acquisition,
                                                    const ExecConfig& exec) {
  const int threads = thread_count(exec.num_threads);
  check(scene.get(), grid, acquisition);
  auto data = std::make_unique<ClassicMapData>(std::move(scene), OccupancyCodes(grid));
  if (acquisition && grid.views().empty()) data->occlusion = OcclusionKnown::no_views;
  if (acquisition && !grid.views().empty()) {
    data->occlusion = OcclusionKnown::yes;
    data->occlusion_depth = acquisition->occlusion_depth / grid.voxel_size();
    ThreadPool pool(threads);
    data->table.add(
        OcclusionTracer(*data->scene, data->table, *acquisition).run(grid.views(), pool));
  }
  return std::shared_ptr<const ClassicMap>(new ClassicMap(std::move(data)));
}

ClassicMap::ClassicMap(std::unique_ptr<const ClassicMapData> data) : data_(std::move(data)) {}
ClassicMap::~ClassicMap() = default;

const VoxelScene& ClassicMap::scene() const noexcept { return *data_->scene; }
int ClassicMap::occlusion_steps(Index3 voxel) const {
  return static_cast<int>(ClassicTable::steps(word_at(data_->table, voxel)));
}
bool ClassicMap::is_surface_frontier(Index3 voxel) const {
  return ClassicTable::is_frontier(word_at(data_->table, voxel));
}
std::uint64_t ClassicMap::bytes() const noexcept { return data_->table.bytes(); }

}  // namespace viewgain
