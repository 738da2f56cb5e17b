// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Reusable threads for data-parallel loops. The calling thread works too. While a loop is running,
/// a call from another thread or from inside a loop body runs its whole loop on its calling thread.
/// Nested and concurrent use therefore cannot deadlock.
///
/// Thread safety: members may be called from any thread; destroy the pool only when no call is
/// running. After a fork, the first call in the child starts new threads. A loop of the parent does
/// not continue in the child, and the destructor there does not touch the parent's threads.
class VIEWGAIN_EXPORT ThreadPool {
 public:
  /// `num_threads` includes the calling thread. Throws whatever thread_count() throws.
  explicit ThreadPool(int num_threads = 0);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// Number of threads, including the calling thread.
  [[nodiscard]] int num_threads() const noexcept;

  /// Divides the indices [0, count) into consecutive ranges of at most `chunk` indices, and calls
  /// body(begin, end) for each. An atomic counter assigns the ranges to threads, so the assignment
  /// can differ between calls. The first exception of a body ends the loop early and is rethrown.
  /// Throws Error(invalid_argument) if chunk is 0 and count is not. Allocates nothing.
  template <typename Body>
  void for_each_chunk(std::size_t count, std::size_t chunk, Body&& body) {
    using Plain = std::remove_reference_t<Body>;
    // `body` may be const. The type Plain restores the const.
    void* address = const_cast<void*>(static_cast<const volatile void*>(std::addressof(body)));
    run(count, chunk, Task{address, [](void* b, std::size_t begin, std::size_t end) {
                             (*static_cast<Plain*>(b))(begin, end);
                           }});
  }

 private:
  /// A callable that the caller owns, valid during run().
  struct Task {
    void* body = nullptr;  ///< address of the loop's body
    /// Calls the body for a range of indices.
    void (*call)(void*, std::size_t, std::size_t) = nullptr;
  };
  void run(std::size_t count, std::size_t chunk, Task task);

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
