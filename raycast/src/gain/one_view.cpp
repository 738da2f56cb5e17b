// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// One view on all threads.
#include <algorithm>
#include <thread>

#include "gain_evaluator_impl.hpp"

namespace viewgain {
namespace {

constexpr std::size_t kTilesPerGroup = detail::kBatchSize / detail::kTileRays;

}  // namespace

ViewGain GainEvaluator::Impl::evaluate_together(const Pose& T_world_camera) const {
  ViewGain result;
  const auto frame = open_view(T_world_camera, result);
  if (!frame) return result;
  const detail::TileTable& table = tracer.table();
  const std::size_t group_count = (table.tile_count + kTilesPerGroup - 1) / kTilesPerGroup;

  std::unique_ptr<TileGroups> groups;
  {
    const std::lock_guard lock(idle_mutex);
    if (!idle_groups.empty()) {
      groups = std::move(idle_groups.back());
      idle_groups.pop_back();
    }
  }
  if (!groups) groups = std::make_unique<TileGroups>(group_count);
  for (auto& is_traced : groups->is_traced) is_traced.store(false, std::memory_order_relaxed);
  groups->next = 0;

  const auto trace = [&](std::size_t group, detail::TileBins& bins) {
    detail::HitList& hits = groups->hits[group];
    hits.count = 0;
    const std::size_t end = std::min((group + 1) * kTilesPerGroup, table.tile_count);
    tracer.trace_some(*frame, group * kTilesPerGroup, end, bins,
                      [&](std::size_t, const detail::RayTile& tile) {
                        if (tile.hit != 0) kernels->append(tile, hits);
                      });
    groups->is_traced[group].store(true, std::memory_order_release);
  };
  // Each thread sorts the boxes for itself, which takes less than reading another core's lists.
  // Number 0 adds up, and traces while the next group is not there yet. In the end number 1, if
  // it is there, finishes the occupied voxels while number 0 does the unknown ones. Each waits only
  // for what another is doing already.
  std::atomic<bool> has_failed{false};  // out of memory: nobody waits for what will not come
  std::atomic<detail::GainAccumulator*> closed{nullptr};  // all hits are in
  detail::GainAccumulator::ClassGain refined;
  std::atomic<bool> is_refining{false}, is_refined{false};
  const auto refine = [&](detail::GainAccumulator& accumulator) {
    if (is_refining.exchange(true)) return;
    refined = accumulator.refined();
    is_refined.store(true, std::memory_order_release);
  };
  const auto work = [&](std::size_t number) {
    if (number > 0 && groups->next.load(std::memory_order_relaxed) >= group_count) return;
    Lease lease(*this);
    auto& [accumulator, bins, view_hits] = lease.get();
    tracer.prepare(*frame, bins);
    std::size_t group;
    if (number > 0) {
      while ((group = groups->next.fetch_add(1)) < group_count) trace(group, bins);
      if (number > 1) return;
      detail::GainAccumulator* whole;
      while ((whole = closed.load(std::memory_order_acquire)) == nullptr && !has_failed) {
        std::this_thread::yield();
      }
      if (whole != nullptr) refine(*whole);
      return;
    }
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
  pool.for_each_chunk(static_cast<std::size_t>(pool.num_threads()), 1,
                      [&](std::size_t number, std::size_t) {
                        try {
                          work(number);
                        } catch (...) {
                          has_failed = true;
                          throw;
                        }
                      });
  result.status = ViewStatus::ok;
  const std::lock_guard lock(idle_mutex);
  idle_groups.push_back(std::move(groups));
  return result;
}

}  // namespace viewgain
