// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <thread>

#include "gain_evaluator_impl.hpp"
#include "trace/scene_tracing.hpp"

namespace viewgain::detail {
namespace {

constexpr std::size_t kStripsPerThread = 3;

}  // namespace

ViewGain evaluate_together(const ViewDriver& driver, const Pose& T_world_camera) {
  ViewGain result;
  const auto frame = driver.open(T_world_camera, result);
  if (!frame) return result;
  const ViewTracer& tracer = driver.tracer();
  EvaluatorCore& core = *driver.core();
  const GainKernels& kernels = gain_kernels(driver.scene().tracing->kernels.isa);
  // Some for each thread, since they take unlike times.
  const std::size_t rows = tracer.table().tile_rows();
  const auto wanted = kStripsPerThread * static_cast<std::size_t>(core.pool.num_threads());
  const std::size_t strip_rows = std::max<std::size_t>(rows / wanted, 1);
  const std::size_t strip_count = (rows + strip_rows - 1) / strip_rows;

  std::unique_ptr<ViewStrips> strips = core.view_strips.take();
  if (!strips) strips = std::make_unique<ViewStrips>(strip_count);
  for (auto& is_traced : strips->is_traced) is_traced.store(false, std::memory_order_relaxed);
  strips->next = 0;

  const auto trace = [&](std::size_t strip, ViewSweep& sweep) {
    ViewStrips::Hits& hits = strips->hits[strip];
    hits.count = 0;
    const TileRows of_strip{strip * strip_rows, std::min((strip + 1) * strip_rows, rows)};
    tracer.trace_strip(*frame, of_strip, sweep, [&](std::size_t, const RayTile& tile) {
      if (tile.hit == 0) return;
      if (hits.count == 0 || hits.lists[hits.count - 1].count >= kBatchSize) {
        if (hits.lists.size() == hits.count) hits.lists.emplace_back();
        hits.lists[hits.count++].count = 0;
      }
      kernels.append(tile, hits.lists[hits.count - 1]);
    });
    strips->is_traced[strip].store(true, std::memory_order_release);
  };
  // Each thread finds the cells for itself, which takes less than reading another core's lists.
  // Number 0 adds up, and traces while the next strip is not there yet. In the end number 1, if
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
    if (number > 0 && strips->next.load(std::memory_order_relaxed) >= strip_count) return;
    ViewDriver::Lease lease(driver);
    ViewSweep& sweep = lease.workspace().sweep;
    tracer.prepare(*frame, sweep);
    std::size_t strip;
    if (number > 0) {
      while ((strip = strips->next.fetch_add(1)) < strip_count) trace(strip, sweep);
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
    for (std::size_t added = 0; added < strip_count && !has_failed;) {
      if (strips->is_traced[added].load(std::memory_order_acquire)) {
        const ViewStrips::Hits& hits = strips->hits[added++];
        for (std::size_t i = 0; i < hits.count; ++i) accumulator.add(hits.lists[i]);
      } else if ((strip = strips->next.fetch_add(1)) < strip_count) {
        trace(strip, sweep);
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
  result.status = ViewGain::Status::ok;
  core.view_strips.give_back(std::move(strips));
  return result;
}

}  // namespace viewgain::detail
