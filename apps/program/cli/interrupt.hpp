// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>

namespace viewgain::app {

/// From now on Ctrl-C (SIGINT), SIGTERM, SIGHUP and SIGQUIT remove unfinished files before they end
/// the program. SIGXCPU does the same, with a message and exit code 1. Signals that were ignored at
/// the start stay ignored. Call it once, before any other thread is started.
void clean_up_when_ended();

/// Removes the unfinished files of all writers of this process, except those kept for a resumed
/// call. Writers fail afterwards. Takes locks.
void remove_unfinished_files() noexcept;

/// Returns at once. If a signal is ending the program, never returns, so that failures for that
/// reason are not reported as errors.
void wait_if_ended();

/// While it exists, the first SIGINT, SIGTERM or SIGHUP, and every SIGXCPU, requests a stop instead
/// of ending the program. Only one may exist at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  [[nodiscard]] std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
};

}  // namespace viewgain::app
