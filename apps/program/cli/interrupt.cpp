// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/interrupt.hpp"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>
#include <thread>

#include "viewgain/formats/staged_folder.hpp"
#include "viewgain/support/atomic_file.hpp"

namespace viewgain::app {
namespace {

constexpr int kOutOfTime = 1;  // same as out of memory

std::mutex mutex;
std::stop_source* guarded = nullptr;  // of the existing InterruptGuard
bool ended = false;

// Does not state the limit, because the kernel raises it with each signal.
void say_that_time_is_up(const char* what_follows) {
  std::fprintf(stderr, "viewgain: processor time limit reached (ulimit -t)%s\n", what_follows);
}

// Whether the signal only requests a stop. The signal of the CPU time limit repeats each second
// until the call ends.
bool asks_for_a_stop(int signal) {
  const std::lock_guard lock(mutex);
  if (guarded != nullptr && signal != SIGQUIT) {
    const bool is_first = guarded->request_stop();
    if (signal == SIGXCPU && is_first) say_that_time_is_up("; the command stops after this step");
    if (is_first || signal == SIGXCPU) return true;
  }
  ended = true;
  return false;
}

// A thread waits for signals that all threads block. Unlike a signal handler it may take locks.
void watch(const sigset_t& signals) {
  int signal = 0;
  while (::sigwait(&signals, &signal) != 0 || asks_for_a_stop(signal)) {
  }
  remove_unfinished_files();
  if (signal == SIGXCPU) {  // which would also dump core
    say_that_time_is_up("");
    std::_Exit(kOutOfTime);
  }
  std::signal(signal, SIG_DFL);
  ::pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  std::raise(signal);
}

}  // namespace

void clean_up_when_ended() {
  sigset_t signals;
  ::sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU}) {
    struct sigaction action {};
    // Programs in the background and under nohup start with some signals ignored.
    if (::sigaction(signal, nullptr, &action) == 0 && action.sa_handler != SIG_IGN) {
      ::sigaddset(&signals, signal);
    }
  }
  ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread(watch, signals).detach();
}

void remove_unfinished_files() noexcept {
  remove_temporary_files();
  remove_staged_folders();
}

void wait_if_ended() {
  const bool is_ended = [] {
    const std::lock_guard lock(mutex);
    return ended;
  }();
  while (is_ended) ::pause();
}

InterruptGuard::InterruptGuard() {
  const std::lock_guard lock(mutex);
  guarded = &source_;
}

InterruptGuard::~InterruptGuard() {
  const std::lock_guard lock(mutex);
  guarded = nullptr;
}

}  // namespace viewgain::app
