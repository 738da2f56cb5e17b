// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "viewgain/core/stopwatch.hpp"

namespace viewgain::app {

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

}  // namespace viewgain::app
