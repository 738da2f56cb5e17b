// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "interrupt.hpp"

#include <chrono>
#include <csignal>

#include "viewgain/core/atomic_file.hpp"

namespace viewgain::app {
namespace {

volatile std::sig_atomic_t pending = 0;

void end(int signal) {
  remove_temporary_files();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void on_signal(int signal) {
  pending = 1;
  std::signal(signal, end);
}

}  // namespace

void clean_up_when_ended() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    // Programs in the background and under nohup are started with some ignored.
    if (std::signal(signal, end) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

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
