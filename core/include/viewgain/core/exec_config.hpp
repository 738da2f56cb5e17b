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

/// Watches or ends one long call.
struct VIEWGAIN_EXPORT BatchControl {
  std::stop_token stop{};  ///< when a stop is requested the call returns early, see the call
  std::function<void(std::size_t done, std::size_t total)>
      progress{};  ///< from any worker, one at a time
  /// Asked between poses, from any worker, one at a time: true ends the call as a stop would.
  std::function<bool()> is_cancelled{};
};

}  // namespace viewgain
