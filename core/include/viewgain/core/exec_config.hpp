// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <stop_token>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// What changes only speed, never an answer.
struct VIEWGAIN_EXPORT ExecConfig {
  int num_threads = 0;  ///< 0: all hardware threads; 1: the caller alone; n: caller and n - 1 more
};

/// Watches one long call, or ends it early: two ways to do so with one effect, see the call.
struct VIEWGAIN_EXPORT BatchControl {
  std::stop_token stop{};  ///< for ending it from another thread; looked at between poses
  std::function<void(std::size_t done, std::size_t total)>
      progress{};  ///< from any worker, one at a time
  /// For a caller that is to be asked: between poses, by any worker, one at a time; true ends it.
  std::function<bool()> is_cancelled{};
};

}  // namespace viewgain
