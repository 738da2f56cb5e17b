// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <mutex>
#include <shared_mutex>
#include <utility>

#include "gil.hpp"
#include "viewgain/grid/belief_grid.hpp"

namespace viewgain::python {

/// Python's BeliefGrid. Long calls release the GIL, so another Python thread can use the same grid
/// meanwhile. A lock here allows many readers or one writer.
class SharedGrid {
 public:
  explicit SharedGrid(BeliefGrid grid) : grid_(std::move(grid)) {}

  /// Calls f(const BeliefGrid&) or f(BeliefGrid&) without the GIL; f must not touch Python. Call
  /// with the GIL.
  template <typename F>
  auto read(const F& f) const {
    const WithoutGil without_gil;  // before the lock, to avoid a deadlock
    const std::shared_lock lock(mutex_);
    return f(grid_);
  }
  template <typename F>
  auto write(const F& f) {
    const WithoutGil without_gil;
    const std::unique_lock lock(mutex_);
    return f(grid_);
  }

  /// For data that never change: layout and prior.
  [[nodiscard]] const BeliefGrid& layout() const noexcept { return grid_; }

 private:
  BeliefGrid grid_;
  mutable std::shared_mutex mutex_;
};

}  // namespace viewgain::python
