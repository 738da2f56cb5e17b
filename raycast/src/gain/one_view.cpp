// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "one_view.hpp"

#include <algorithm>
#include <ranges>
#include <thread>

#include "trace/scene_tracing.hpp"

namespace viewgain::detail {
namespace {

constexpr std::size_t kTilesPerGroup = kBatchSize / kTileRays;

}  // namespace

ViewGain evaluate_together(const ViewDriver& driver, const Pose& T_world_camera) {
  ViewGain result;
  const auto frame = driver.open(T_world_camera, result);
  if (!frame) return result;
  const ViewTracer& tracer = driver.tracer();
  EvaluatorCore& core = *driver.core();
  const GainKernels& kernels = gain_kernels(driver.scene().tracing->kernels.isa);
  const TileTable& table = tracer.table();
  const std::size_t group_count = (table.tile_count + kTilesPerGroup - 1) / kTilesPerGroup;

  std::unique_ptr<TileGroups> groups = core.tile_groups.take();
  if (!groups) groups = std::make_unique<TileGroups>(group_count);
  for (auto& is_traced : groups->is_traced) is_traced.store(false, std::memory_order_relaxed);
  groups->next = 0;

  const auto trace = [&](std::size_t group, TileBins& bins) {
    HitList& hits = groups->hits[group];
    hits.count = 0;
    const std::size_t end = std::min((group + 1) * kTilesPerGroup, table.tile_count);
    tracer.trace(*frame, std::views::iota(group * kTilesPerGroup, end), bins,
                 [&](std::size_t, const RayTile& tile) {
                   if (tile.hit != 0) kernels.append(tile, hits);
                 });
    groups->is_traced[group].store(true, std::memory_order_release);
  };
  // Each thread sorts the boxes for itself, which takes less than reading another core's lists.
  // Number 0 adds up, and traces while the next group is not there yet. In the end number 1, if
  // it is there, finishes the occupied voxels while number 0 does the unknown ones. Each waits only
  // for what another is doing already.
  std::atomic<bool> has_failed{false};  // out of memory: nobody waits for what will not come
  std::atomic<GainAccumulator*> closed{nullptr};  // all hits are in
  GainAccumulator::ClassGain refined;
  std::atomic<bool> is_refining{false}, is_refined{false};
  const auto refine = [&](GainAccumulator& accumulator) {
    if (is_refining.exchange(true)) return;
    refined = accumulator.refined();
    is_refined.store(true, std::memory_order_release);
  };
  const auto work = [&](std::size_t number) {
    if (number > 0 && groups->next.load(std::memory_order_relaxed) >= group_count) return;
    ViewDriver::Lease lease(driver);
    TileBins& bins = lease.workspace().bins;
    tracer.prepare(*frame, bins);
    std::size_t group;
    if (number > 0) {
      while ((group = groups->next.fetch_add(1)) < group_count) trace(group, bins);
      if (number > 1) return;
      GainAccumulator* whole;
      while ((whole = closed.load(std::memory_order_acquire)) == nullptr && !has_failed) {
        std::this_thread::yield();
      }
      if (whole != nullptr) refine(*whole);
      return;
    }
    GainAccumulator& accumulator = lease.accumulator();
    accumulator.begin();
    for (std::size_t added = 0; added < group_count && !has_failed;) {
      if (groups->is_traced[added].load(std::memory_order_acquire)) {
        if (groups->hits[added].count > 0) accumulator.add(groups->hits[added]);
        ++added;
      } else if ((group = groups->next.fetch_add(1)) < group_count) {
        trace(group, bins);
      } else {
        std::this_thread::yield();
      }
    }
    if (has_failed) return;
    accumulator.close();
    closed.store(&accumulator, std::memory_order_release);
    const auto explored = accumulator.explored();
    refine(accumulator);
    while (!is_refined.load(std::memory_order_acquire)) std::this_thread::yield();
    accumulator.finish(explored, refined, result);
  };
  core.pool.for_each_chunk(static_cast<std::size_t>(core.pool.num_threads()), 1,
                           [&](std::size_t number, std::size_t) {
                             try {
                               work(number);
                             } catch (...) {
                               has_failed = true;
                               throw;
                             }
                           });
  result.status = ViewStatus::ok;
  core.tile_groups.give_back(std::move(groups));
  return result;
}

}  // namespace viewgain::detail
