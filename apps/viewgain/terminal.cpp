// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "terminal.hpp"

#include <unistd.h>

#include <array>
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

std::string with_commas(unsigned long long value) {
  const std::string digits = std::to_string(value);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

std::string with_unit(double value) {
  const char* unit = "";
  for (const char* next : {" k", " M", " G"}) {
    if (value < 1000) break;
    value /= 1000;
    unit = next;
  }
  std::array<char, 40> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.3g%s", value, unit);
  return buffer.data();
}

}  // namespace viewgain::app
