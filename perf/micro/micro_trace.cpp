// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Finding the first voxel that is not free: by sweeping, through the BVH, in leaves
// known beforehand; and going on from there.
#include <benchmark/benchmark.h>

#include <algorithm>

#include "micro_benchmarks.hpp"
#include "micro_scene.hpp"
#include "scene/scene_data.hpp"
#include "trace/ordered_walk.hpp"
#include "trace/scene_tracing.hpp"

namespace viewgain::bench {
namespace {

void count_rays(benchmark::State& state, std::size_t rays) {
  state.counters["rays"] =
      benchmark::Counter(static_cast<double>(rays), benchmark::Counter::kIsRate);
}

// Whole views: swept, as the evaluator does, or all tiles through Embree.
void view_traversal(benchmark::State& state, ExecConfig::Tracer way) {
  const MicroScene& micro = MicroScene::get();
  const detail::ViewTracer tracer = micro.make_tracer(way);
  detail::ViewSweep sweep;
  std::size_t rays = 0, next = 0;
  for (auto _ : state) {
    std::uint32_t hits = 0;
    const detail::PoseFrame& frame = micro.views[next++ % micro.views.size()].frame;
    tracer.prepare(frame, sweep);
    tracer.trace(frame, sweep, [&](std::size_t, const detail::RayTile& tile) { hits += tile.hit; });
    benchmark::DoNotOptimize(hits);
    rays += tracer.table().ray_count();
  }
  count_rays(state, rays);
}

// Only the leaves that a tile's rays end in, only tiles that hit something.
void leaf_dda(benchmark::State& state, Isa isa) {
  const MicroScene& micro = MicroScene::get();
  const detail::TileKernels& kernels = detail::tile_kernels(isa);
  const detail::SceneData& scene = detail::SceneAccess::data(*micro.scene);
  detail::RayTile out;
  std::size_t rays = 0, next = 0;
  for (auto _ : state) {
    const MicroScene::View& view = micro.views[next++ % micro.views.size()];
    for (std::size_t i = 0; i < view.tiles.size(); ++i) {
      kernels.begin(micro.tracer.table(), view.frame, view.numbers[i], out);
      for (const std::uint32_t leaf : view.leaves[i]) {
        kernels.visit(scene, view.frame, leaf, out);
      }
      benchmark::DoNotOptimize(out.hit);
    }
    rays += view.tiles.size() * detail::kTileRays;
  }
  count_rays(state, rays);
}

// Rays that hit a voxel, walked on through unknown voxels from there.
void ordered_walk(benchmark::State& state, Isa isa) {
  const MicroScene& micro = MicroScene::get();
  const detail::WalkKernels& kernels = detail::walk_kernels(isa);
  const detail::SceneData& scene = detail::SceneAccess::data(*micro.scene);
  const detail::BrickTable& bricks = scene.tracing->bricks();
  constexpr detail::PixelWorth kWorth{.cap = 1, .scale = 1, .s0 = 0, .s1 = 0, .s2 = 0, .at = 0};
  detail::WalkTask task;
  detail::WalkedTile out;
  std::size_t rays = 0, next = 0;
  for (auto _ : state) {
    const MicroScene::View& view = micro.views[next++ % micro.views.size()];
    const detail::WalkLimits limits = detail::walk_limits(scene, view.frame);
    for (std::size_t i = 0; i < view.tiles.size(); ++i) {
      detail::set_up(micro.tracer.table(), view.numbers[i], view.frame, view.tiles[i], task);
      kernels.area(bricks, limits, {&task, 1}, kWorth, nullptr, &out);
      benchmark::DoNotOptimize(out.occupied);
    }
    rays += view.tiles.size() * detail::kTileRays;
  }
  count_rays(state, rays);
}

}  // namespace

void register_trace_benchmarks() {
  benchmark::RegisterBenchmark("view_traversal/sweep", view_traversal, ExecConfig::Tracer::sweep);
  benchmark::RegisterBenchmark("view_traversal/embree", view_traversal, ExecConfig::Tracer::embree);
  for (const Isa isa : micro_isas()) {
    const std::string name(isa_name(isa));
    benchmark::RegisterBenchmark(("leaf_dda/" + name).c_str(), leaf_dda, isa);
    benchmark::RegisterBenchmark(("ordered_walk/" + name).c_str(), ordered_walk, isa);
  }
}

}  // namespace viewgain::bench
