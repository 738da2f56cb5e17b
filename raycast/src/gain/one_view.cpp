// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <memory>
#include <thread>
#include <utility>

#include "gain_evaluator_impl.hpp"
#include "trace/scene_tracing.hpp"
#include "viewgain/support/relax.hpp"

namespace viewgain::detail {
namespace {

// Waits for what another thread is finishing, some tenths of a millisecond. Yields later: where
// other processes wait for the core, the first yield costs a time slice.
template <typename Condition>
void wait_for(const Condition& condition) {
  constexpr int kSpins = 4000;
  for (int i = 0; !condition(); ++i) {
    if (i < kSpins) {
      relax();
    } else {
      std::this_thread::yield();
    }
  }
}

// The jobs of a view: any thread calls trace() for a strip; number 0 calls begin(), add() for the
// strips in order, and close(). Then finish(0) and finish(1) may run at once, and end() is last.

class PaperJob {
 public:
  static constexpr std::size_t kStripsPerThread = 3;

  PaperJob(const ViewDriver& driver, const PoseFrame& frame)
      : tracer_(driver.tracer()),
        frame_(frame),
        kernels_(gain_kernels(driver.scene().tracing->kernels.isa)) {}

  void trace(TileRows rows, Workspace& workspace, ViewStrips::Strip& strip) const {
    strip.list_count = 0;
    tracer_.trace_strip(frame_, rows, workspace.sweep, [&](std::size_t, const RayTile& tile) {
      if (tile.hit == 0) return;
      if (strip.list_count == 0 || strip.lists[strip.list_count - 1].count >= kBatchSize) {
        if (strip.lists.size() == strip.list_count) strip.lists.emplace_back();
        strip.lists[strip.list_count++].count = 0;
      }
      kernels_.append(tile, strip.lists[strip.list_count - 1]);
    });
  }
  void begin(ViewDriver::Lease& lease) {
    accumulator_ = &lease.accumulator();
    accumulator_->begin();
  }
  void add(const ViewStrips::Strip& strip) {
    for (std::size_t i = 0; i < strip.list_count; ++i) accumulator_->add(strip.lists[i]);
  }
  void close() { accumulator_->close(); }
  void finish(std::size_t part) {
    (part == 0 ? explored_ : refined_) =
        part == 0 ? accumulator_->explored() : accumulator_->refined();
  }
  void end(ViewGain& result) const { accumulator_->finish(explored_, refined_, result); }

 private:
  const ViewTracer& tracer_;
  const PoseFrame& frame_;
  const GainKernels& kernels_;
  GainAccumulator* accumulator_ = nullptr;
  GainAccumulator::ClassGain explored_, refined_;
};

class SurfaceJob {
 public:
  static constexpr std::size_t kStripsPerThread = 6;

  SurfaceJob(const ViewDriver& driver, const PoseFrame& frame)
      : surface_(*driver.surface()), frame_(frame) {}

  void trace(TileRows rows, Workspace& workspace, ViewStrips::Strip& strip) const {
    surface_.walk_strip(frame_, rows, workspace.sweep, strip.areas, strip.ends);
  }
  void begin(ViewDriver::Lease& lease) {
    workspace_ = &lease.workspace();
    surface_.begin(*workspace_);
  }
  void add(const ViewStrips::Strip& strip) {
    for (const double area : strip.areas) area_ += area;
    hits_ += static_cast<std::uint32_t>(strip.ends.size());
    surface_.add(strip.ends, *workspace_);
  }
  void close() { surface_.close(*workspace_, 2); }
  void finish(std::size_t part) { surface_.finish(*workspace_, part); }
  void end(ViewGain& result) const {
    surface_.end(*workspace_, 2, surface_.square_metres(area_), hits_, result);
  }

 private:
  const SurfaceView& surface_;
  const PoseFrame& frame_;
  Workspace* workspace_ = nullptr;
  double area_ = 0;  // [voxels²]
  std::uint32_t hits_ = 0;
};

// All threads of the pool at one view. Each finds the cells for itself, which takes less than
// reading another core's lists. Number 0 adds up, and traces while the next strip is not there yet.
// In the end number 1, if it is there, takes the second part of what is left to do. Each waits only
// for what another is doing already.
template <typename Job>
class Crew {
 public:
  Crew(const ViewDriver& driver, const PoseFrame& frame)
      : driver_(driver),
        frame_(frame),
        core_(*driver.core()),
        job_(driver, frame),
        rows_(driver.tracer().table().tile_rows()),
        // Some for each thread, since they take unlike times.
        strip_rows_(std::max<std::size_t>(rows_ / (Job::kStripsPerThread * threads()), 1)),
        strip_count_((rows_ + strip_rows_ - 1) / strip_rows_),
        strips_(core_.view_strips.take()) {
    if (!strips_) strips_ = std::make_unique<ViewStrips>(strip_count_);
    for (auto& is_traced : strips_->is_traced) is_traced.store(false, std::memory_order_relaxed);
    strips_->next = 0;
  }

  void run(ViewGain& result) {
    core_.pool.for_each_chunk(threads(), 1, [&](std::size_t number, std::size_t) {
      try {
        work(number, result);
      } catch (...) {
        has_failed_ = true;
        throw;
      }
    });
    core_.view_strips.give_back(std::move(strips_));
  }

 private:
  [[nodiscard]] std::size_t threads() const {
    return static_cast<std::size_t>(core_.pool.num_threads());
  }

  void work(std::size_t number, ViewGain& result) {
    if (number > 0 && strips_->next.load(std::memory_order_relaxed) >= strip_count_) return;
    ViewDriver::Lease lease(driver_);
    driver_.tracer().prepare(frame_, lease.workspace().sweep);
    if (number == 0) {
      lead(lease, result);
    } else {
      help(number, lease.workspace());
    }
  }

  // Traces the next strip; false: none is left.
  bool trace_next(Workspace& workspace) {
    const std::size_t strip = strips_->next.fetch_add(1);
    if (strip >= strip_count_) return false;
    const TileRows of_strip{strip * strip_rows_, std::min((strip + 1) * strip_rows_, rows_)};
    job_.trace(of_strip, workspace, strips_->strips[strip]);
    strips_->is_traced[strip].store(true, std::memory_order_release);
    return true;
  }

  void lead(ViewDriver::Lease& lease, ViewGain& result) {
    job_.begin(lease);
    for (std::size_t added = 0; added < strip_count_ && !has_failed_;) {
      if (strips_->is_traced[added].load(std::memory_order_acquire)) {
        job_.add(strips_->strips[added++]);
      } else if (!trace_next(lease.workspace())) {
        wait_for([&] {
          return strips_->is_traced[added].load(std::memory_order_acquire) || has_failed_;
        });
      }
    }
    if (has_failed_) return;
    job_.close();
    is_closed_.store(true, std::memory_order_release);
    job_.finish(0);
    finish_second();
    wait_for([&] { return is_second_done_.load(std::memory_order_acquire) || has_failed_; });
    if (!has_failed_) job_.end(result);
  }

  void help(std::size_t number, Workspace& workspace) {
    while (trace_next(workspace)) {
    }
    if (number > 1) return;
    wait_for([&] { return is_closed_.load(std::memory_order_acquire) || has_failed_; });
    if (!has_failed_) finish_second();
  }

  void finish_second() {
    if (is_second_taken_.exchange(true)) return;
    job_.finish(1);
    is_second_done_.store(true, std::memory_order_release);
  }

  const ViewDriver& driver_;
  const PoseFrame& frame_;
  EvaluatorCore& core_;
  Job job_;
  std::size_t rows_, strip_rows_, strip_count_;  // rows of tiles; of a strip
  std::unique_ptr<ViewStrips> strips_;
  std::atomic<bool> has_failed_{false};  // out of memory: nobody waits for what will not come
  std::atomic<bool> is_closed_{false}, is_second_taken_{false}, is_second_done_{false};
};

}  // namespace

ViewGain evaluate_together(const ViewDriver& driver, const Pose& T_world_camera) {
  ViewGain result;
  const auto frame = driver.open(T_world_camera, result);
  if (!frame) return result;
  if (driver.surface() != nullptr) {
    Crew<SurfaceJob>(driver, *frame).run(result);
  } else {
    Crew<PaperJob>(driver, *frame).run(result);
  }
  result.status = ViewGain::Status::ok;
  return result;
}

}  // namespace viewgain::detail
