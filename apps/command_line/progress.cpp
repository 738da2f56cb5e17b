// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "progress.hpp"

#include <unistd.h>

#include <cstdio>
#include <utility>

namespace viewgain::app {

Progress::Progress(std::string label)
    : label_(std::move(label)), on_terminal_(::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void Progress::update(std::size_t done, std::size_t total) {
  constexpr double kFirst = 1.0, kInterval = 0.1;  // [s]
  if (!on_terminal_ || total == 0) return;
  const double now = watch_.seconds();
  if (now < kFirst || (shown_ && now - last_shown_ < kInterval)) return;
  shown_ = true;
  last_shown_ = now;
  const double share = static_cast<double>(done) / static_cast<double>(total);
  std::fprintf(stderr, "\r%s %zu of %zu, %.0f %%, %.0f s\033[K", label_.c_str(), done, total,
               100 * share, now);
  std::fflush(stderr);
}

}  // namespace viewgain::app
