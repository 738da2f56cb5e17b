// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/thread_pool.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "viewgain/core/error.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/support/relax.hpp"

namespace viewgain {
namespace {

/// Number of looks at the flag before sleeping: some microseconds, less than the cost of a wake-up.
constexpr int kSpins = 200;

template <typename Condition>
bool spin_until(const Condition& condition) {
  for (int i = 0; i < kSpins; ++i) {
    if (condition()) return true;
    relax();
  }
  return condition();
}

}  // namespace

struct ThreadPool::Impl {
  struct Crew;

  int num_threads = 1;
  std::atomic<Crew*> crew;

  explicit Impl(int n);
  ~Impl();

  /// The threads of this process. After a fork, the first call creates them.
  Crew& here();
};

/// The threads of one process. A fork copies the object but not the threads, and the locks may be
/// in any state. A child therefore leaves the copied object unused and makes its own.
///
/// A run invites workers by `slots`. A worker that takes a slot works, and then increments
/// `finished`. When no range is left, the caller withdraws the remaining slots and waits for the
/// workers. The job's fields therefore change only while no worker holds a slot.
struct ThreadPool::Impl::Crew {
  const pid_t process = getpid();
  const Crew* const abandoned;  // of the parent process; never used or freed

  std::atomic<bool> busy{false};

  std::mutex mutex;  // for sleeping only
  std::condition_variable wake;
  std::condition_variable done;
  std::atomic<bool> stopping{false};

  std::atomic<int> slots{0};     // workers still invited
  std::atomic<int> finished{0};  // workers that took a slot and have finished

  Task task;
  std::size_t count = 0;
  std::size_t chunk = 0;
  std::size_t chunks = 0;
  std::atomic<std::size_t> next_chunk{0};
  std::atomic<bool> failed{false};
  std::exception_ptr error;

  std::vector<std::thread> workers;

  Crew(int num_threads, const Crew* before) : abandoned(before) {
    workers.reserve(static_cast<std::size_t>(num_threads - 1));
    try {
      for (int i = 1; i < num_threads; ++i) workers.emplace_back([this] { worker_loop(); });
    } catch (const std::system_error& e) {
      end();
      throw Error(ErrorCode::capacity,
                  "cannot start " + std::to_string(num_threads) + " threads: " + e.what());
    } catch (...) {  // no memory for a thread's state; running threads must end before the object
      end();
      throw;
    }
  }

  ~Crew() { end(); }

  void end() {
    {
      const std::lock_guard lock(mutex);
      stopping.store(true);
    }
    wake.notify_all();
    for (std::thread& worker : workers) worker.join();
  }

  bool take_slot() {
    int open = slots.load(std::memory_order_relaxed);
    while (open > 0) {
      if (slots.compare_exchange_weak(open, open - 1, std::memory_order_acquire,
                                      std::memory_order_relaxed)) {
        return true;
      }
    }
    return false;
  }

  void work() {
    for (;;) {
      const std::size_t i = next_chunk.fetch_add(1, std::memory_order_relaxed);
      if (i >= chunks) return;
      const std::size_t begin = i * chunk;
      try {
        task.call(task.body, begin, begin + std::min(chunk, count - begin));
      } catch (...) {
        if (!failed.exchange(true)) error = std::current_exception();
        next_chunk.store(chunks, std::memory_order_relaxed);
        return;
      }
    }
  }

  void worker_loop() {
    for (;;) {
      bool have_slot = false;
      spin_until(
          [&] { return stopping.load(std::memory_order_relaxed) || (have_slot = take_slot()); });
      while (!have_slot) {
        std::unique_lock lock(mutex);
        wake.wait(lock,
                  [&] { return stopping.load() || slots.load(std::memory_order_relaxed) > 0; });
        if (stopping.load()) return;
        lock.unlock();
        have_slot = take_slot();
      }
      work();
      finished.fetch_add(1, std::memory_order_release);
      {
        const std::lock_guard lock(mutex);
      }  // the caller now sleeps, or will check before sleeping
      done.notify_one();
    }
  }

  void run_parallel(std::size_t n, std::size_t size, std::size_t ranges, Task job) {
    const int helpers = static_cast<int>(std::min<std::size_t>(workers.size(), ranges - 1));
    task = job;
    count = n;
    chunk = size;
    chunks = ranges;
    next_chunk.store(0, std::memory_order_relaxed);
    failed.store(false, std::memory_order_relaxed);
    finished.store(0, std::memory_order_relaxed);
    {
      const std::lock_guard lock(mutex);
      slots.store(helpers, std::memory_order_release);
    }
    for (int i = 0; i < helpers; ++i) wake.notify_one();

    work();

    const int taken = helpers - slots.exchange(0, std::memory_order_relaxed);
    const auto all_finished = [&] { return finished.load(std::memory_order_acquire) == taken; };
    if (!spin_until(all_finished)) {
      std::unique_lock lock(mutex);
      done.wait(lock, all_finished);
    }
    const std::exception_ptr first = std::exchange(error, nullptr);
    busy.store(false, std::memory_order_release);
    if (first) std::rethrow_exception(first);
  }
};

ThreadPool::Impl::Impl(int n) : num_threads(n), crew(new Crew(n, nullptr)) {}

ThreadPool::Impl::~Impl() {
  Crew* own = crew.load();
  if (own->process == getpid()) delete own;  // threads of another process cannot be joined
}

ThreadPool::Impl::Crew& ThreadPool::Impl::here() {
  Crew* own = crew.load(std::memory_order_acquire);
  if (own->process == getpid()) return *own;
  auto made = std::make_unique<Crew>(num_threads, own);
  if (crew.compare_exchange_strong(own, made.get(), std::memory_order_acq_rel)) {
    return *made.release();
  }
  return *own;  // another thread of the child has created it
}

ThreadPool::ThreadPool(int num_threads)
    : impl_(std::make_unique<Impl>(thread_count(num_threads))) {}

ThreadPool::~ThreadPool() = default;

int ThreadPool::num_threads() const noexcept { return impl_->num_threads; }

void ThreadPool::run(std::size_t count, std::size_t chunk, Task task) {
  if (count == 0) return;
  if (chunk == 0) refuse("the chunk of a loop must be at least 1, not 0");
  const std::size_t chunks = (count - 1) / chunk + 1;
  if (impl_->num_threads > 1 && chunks > 1) {
    Impl::Crew& crew = impl_->here();
    if (!crew.busy.exchange(true, std::memory_order_acquire)) {
      crew.run_parallel(count, chunk, chunks, task);
      return;
    }
  }
  for (std::size_t begin = 0; begin < count;) {
    const std::size_t end = begin + std::min(chunk, count - begin);
    task.call(task.body, begin, end);
    begin = end;
  }
}

}  // namespace viewgain
