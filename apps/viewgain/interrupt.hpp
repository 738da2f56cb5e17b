// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <thread>

namespace viewgain::app {

/// From now on Ctrl-C (SIGINT), SIGTERM and SIGHUP, where they are not ignored, remove the
/// temporary files of maps and reports being written before they end the program.
void clean_up_when_ended();

/// While it lives, Ctrl-C (SIGINT) and SIGTERM ask for a stop instead of ending the program; a
/// second one ends it. One at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  [[nodiscard]] std::stop_token token() const { return source_.get_token(); }

 private:
  using Handler = void (*)(int);
  std::stop_source source_;
  Handler old_interrupt_, old_terminate_;
  std::jthread watcher_;  // a handler may not take the locks of a stop_source
};

}  // namespace viewgain::app
