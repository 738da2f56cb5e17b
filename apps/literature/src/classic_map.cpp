// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Map data for classic gains, including the unknown voxels that surfaces hid from earlier views.
#include <cmath>
#include <mutex>
#include <utility>

#include "classic_table.hpp"
#include "gain_sums.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/support/view_rays.hpp"

namespace viewgain {
namespace {

using namespace detail;

// A ray enters at most √3 voxels per voxel edge, and a byte stores the number of steps.
constexpr double kMostDepth = 140;  // [voxels]

void check(const VoxelScene* scene, const BeliefGrid& grid,
           const std::optional<Acquisition>& acquisition) {
  if (scene == nullptr) refuse("the classic gains require a scene");
  const GridSnapshot& snapshot = scene->snapshot();
  if (!(snapshot.min_index == grid.min_index() && snapshot.dims == grid.dims() &&
        snapshot.voxel_size == grid.voxel_size() && snapshot.T_world_grid == grid.T_world_grid())) {
    refuse("the scene was not built from this map: their workspaces differ");
  }
  if (!acquisition) return;
  acquisition->sensor.validate();
  const double depth = acquisition->occlusion_depth;
  if (!std::isfinite(depth) || depth < 0 || depth > kMostDepth * grid.voxel_size()) {
    refuse("the occlusion depth is " + short_text(depth) + " m; it must be in 0.." +
           short_text(kMostDepth * grid.voxel_size()) + " m (at most " + short_text(kMostDepth) +
           " voxels)");
  }
}

// Follows the rays of a map's views. Before the first surface, only obstacles end them.
class OcclusionConsumer final : public RayConsumer {
 public:
  OcclusionConsumer(const ClassicTable& table, double depth)
      : table_(table), depth_(static_cast<float>(depth)), kernels_(classic_kernels(select_isa())) {}

  [[nodiscard]] const OcclusionSteps& all() const { return all_; }

  [[nodiscard]] std::unique_ptr<ViewScratch> make_scratch() const override {
    return std::make_unique<Scratch>();
  }
  void begin(ViewScratch& scratch) const override { static_cast<Scratch&>(scratch).steps = {}; }
  void add(const WalkLimits& limits, const WalkTask& task, ViewScratch& scratch) const override {
    WalkLimits without_plane = limits;
    without_plane.has_plane = false;
    WalkTask own = task;
    kernels_.mark_hidden(table_, without_plane, depth_, own, static_cast<Scratch&>(scratch).steps);
  }
  void finish(std::size_t, const ViewGain&, ViewScratch& scratch) const override {
    const std::lock_guard lock(mutex_);
    all_.merge(static_cast<Scratch&>(scratch).steps);
  }

 private:
  struct Scratch final : ViewScratch {
    OcclusionSteps steps;
  };
  const ClassicTable& table_;
  float depth_;  // [voxels]
  const ClassicKernels& kernels_;
  mutable std::mutex mutex_;
  mutable OcclusionSteps all_;
};

std::uint32_t word_at(const ClassicTable& table, Index3 voxel) {
  const Index3 at = table.in_table(voxel);
  return table.workspace().contains(at) ? table.word(at.x, at.y, at.z) : 0;
}

}  // namespace

std::shared_ptr<const ClassicMap> ClassicMap::build(std::shared_ptr<const VoxelScene> scene,
                                                    const BeliefGrid& grid,
                                                    const std::optional<Acquisition>& acquisition,
                                                    const ExecConfig& exec) {
  check(scene.get(), grid, acquisition);
  auto data = std::make_unique<ClassicMapData>(std::move(scene), grid);
  if (acquisition && grid.views().empty()) data->occlusion = OcclusionKnown::no_views;
  if (acquisition && !grid.views().empty()) {
    data->occlusion = OcclusionKnown::yes;
    data->occlusion_depth = acquisition->occlusion_depth / grid.voxel_size();
    const GainEvaluator rays(data->scene, acquisition->sensor, {.model = GainModel::paper},
                             {exec.num_threads});
    const OcclusionConsumer consumer(data->table, data->occlusion_depth);
    for_each_view_rays(rays, grid.views(), /*from_occupied=*/true, consumer);
    data->table.add(consumer.all());
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
