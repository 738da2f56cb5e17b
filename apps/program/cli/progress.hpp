// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "viewgain/support/stopwatch.hpp"

namespace viewgain::app {

/// "frame 30 of 120, 25 %, 12.5/s, 7 s left": progress of a call after this many seconds.
[[nodiscard]] std::string progress_text(const std::string& label, std::size_t done,
                                        std::size_t total, double seconds);

/// A progress line on stderr, shown after the first second, only on a terminal and without --quiet.
/// The destructor wipes it. Thread safety: one call at a time.
class Progress {
 public:
  Progress(std::string label, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(std::size_t done, std::size_t total);
  /// Clears the line, so that another can be printed.
  void wipe();

 private:
  std::string label_;
  bool is_shown_at_all_;
  bool shown_ = false;
  double last_shown_ = 0;  ///< [s]
  Stopwatch watch_;
};

}  // namespace viewgain::app
