// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "interrupt.hpp"

#include <chrono>
#include <csignal>

namespace viewgain::app {
namespace {

volatile std::sig_atomic_t pending = 0;

void on_signal(int signal) {
  pending = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

InterruptGuard::InterruptGuard()
    : old_interrupt_((pending = 0, std::signal(SIGINT, on_signal))),
      old_terminate_(std::signal(SIGTERM, on_signal)),
      watcher_([this](const std::stop_token& ended) {
        while (!ended.stop_requested() && pending == 0) {
          std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        if (pending != 0) source_.request_stop();
      }) {}

InterruptGuard::~InterruptGuard() {
  std::signal(SIGINT, old_interrupt_);
  std::signal(SIGTERM, old_terminate_);
}

}  // namespace viewgain::app
