// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/progress.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <utility>

#include "program/cli/values.hpp"

namespace viewgain::app {

std::string progress_text(const std::string& label, std::size_t done, std::size_t total,
                          double seconds) {
  const double share = static_cast<double>(done) / static_cast<double>(total);
  std::string text = label + " " + with_commas(done) + " of " + with_commas(total) + ", " +
                     with_unit(std::floor(100 * share)) + " %";
  if (done == 0 || !(seconds > 0)) return text;
  const double rate = static_cast<double>(done) / seconds;
  const double left = std::ceil(static_cast<double>(total - done) / rate);
  return text + ", " + with_unit(rate) + "/s, " + with_commas(static_cast<std::uint64_t>(left)) +
         " s left";
}

Progress::Progress(std::string label, bool quiet)
    : label_(std::move(label)), is_shown_at_all_(!quiet && ::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() { wipe(); }

void Progress::wipe() {
  if (shown_) std::fputs("\r\033[K", stderr);
  shown_ = false;
}

void Progress::update(std::size_t done, std::size_t total) {
  constexpr double kFirst = 1.0, kInterval = 0.1;  // [s]
  if (!is_shown_at_all_ || total == 0) return;
  const double now = watch_.seconds();
  if (now < kFirst || (shown_ && now - last_shown_ < kInterval)) return;
  shown_ = true;
  last_shown_ = now;
  std::fprintf(stderr, "\r%s\033[K", progress_text(label_, done, total, now).c_str());
  std::fflush(stderr);
}

}  // namespace viewgain::app
