// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/exec_config.hpp"

#include <algorithm>
#include <thread>

#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {

int thread_count(int num_threads) {
  constexpr int kMaxThreads = 1024;
  if (num_threads < 0 || num_threads > kMaxThreads) {
    refuse("the number of threads must be in 0.." + std::to_string(kMaxThreads) + ", not " +
           std::to_string(num_threads));
  }
  if (num_threads > 0) return num_threads;
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, kMaxThreads);
}

const std::vector<std::string>& tracer_names() {
  static const std::vector<std::string> names{"automatic", "embree", "sweep"};
  return names;
}

ExecConfig::Tracer parse_tracer(std::string_view name) {
  return static_cast<ExecConfig::Tracer>(place_of_name(name, tracer_names(), "tracer"));
}

}  // namespace viewgain
