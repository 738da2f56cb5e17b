// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>

namespace viewgain::app {

/// From now on Ctrl-C (SIGINT), SIGTERM, SIGHUP and SIGQUIT remove what is half-written before they
/// end the program, and so does SIGXCPU, which ends it with a message and exit code 1. Signals that
/// were ignored when it was started stay so. To be called once, before any other thread is started.
void clean_up_when_ended();

/// Removes what all writers of this process have half-written and is not kept for a call that goes
/// on; they fail afterwards. Takes locks.
void remove_unfinished_files() noexcept;

/// Returns at once, unless a signal is ending the program: then not at all, so that what fails for
/// that reason is not reported as an error.
void wait_if_ended();

/// While it lives, the first of SIGINT, SIGTERM and SIGHUP asks for a stop instead of ending the
/// program, and every SIGXCPU does. One at a time.
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
