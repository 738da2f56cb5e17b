// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Reusable threads for data-parallel loops. The caller takes part. If the pool is busy, a call
/// from another thread or from inside a loop body runs its whole loop on the calling thread, so
/// nested and concurrent use cannot deadlock. Thread safety: every member may be called from any
/// thread; the destructor only when no call is running. After a fork, the first call in the child
/// starts new threads. A loop of the parent is not continued there, and the destructor does not
/// touch the parent's threads.
class VIEWGAIN_EXPORT ThreadPool {
 public:
  /// num_threads includes the caller. Throws like thread_count().
  explicit ThreadPool(int num_threads = 0);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// Number of threads, including the caller.
  [[nodiscard]] int num_threads() const noexcept;

  /// Calls body(begin, end) for consecutive ranges of at most `chunk` indices that cover [0, count)
  /// once each; ranges are handed out by an atomic counter, so which thread gets which is not
  /// determined. count 0 does nothing. The first exception of a body ends the loop early and is
  /// rethrown here. Throws Error(invalid_argument) if chunk is 0 and count is not. Allocates
  /// nothing.
  template <typename Body>
  void for_each_chunk(std::size_t count, std::size_t chunk, Body&& body) {
    using Plain = std::remove_reference_t<Body>;
    // The callable may be const; Plain restores the const.
    void* address = const_cast<void*>(static_cast<const volatile void*>(std::addressof(body)));
    run(count, chunk, Task{address, [](void* b, std::size_t begin, std::size_t end) {
                             (*static_cast<Plain*>(b))(begin, end);
                           }});
  }

 private:
  /// A borrowed callable, valid during run().
  struct Task {
    void* body = nullptr;  ///< the loop's body
    /// Calls it on a range of indices.
    void (*call)(void*, std::size_t, std::size_t) = nullptr;
  };
  void run(std::size_t count, std::size_t chunk, Task task);

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
