// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace viewgain::app {

/// Seconds since it was made.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// One line on stderr that counts up, from the second second on and only where stderr is a
/// terminal. Wiped when the object goes. Thread safety: one call at a time.
class Progress {
 public:
  explicit Progress(std::string label);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(std::size_t done, std::size_t total);

 private:
  std::string label_;
  bool on_terminal_;
  bool shown_ = false;
  double last_shown_ = 0;  ///< [s]
  Stopwatch watch_;
};

/// 2,097,152 for 2097152.
[[nodiscard]] std::string with_commas(unsigned long long value);

/// 83.2 M for 83200000; one of k, M, G where it helps.
[[nodiscard]] std::string with_unit(double value);

}  // namespace viewgain::app
