// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "viewgain/support/stopwatch.hpp"

namespace viewgain::app {

/// "frame 30 of 120, 25 %, 12.5/s, 7 s left": how far a call is after so many seconds.
[[nodiscard]] std::string progress_text(const std::string& label, std::size_t done,
                                        std::size_t total, double seconds);

/// One line on stderr that counts up, from the second second on and only where stderr is a
/// terminal and nothing asks for quiet. Wiped when the object goes. Thread safety: one call at a
/// time.
class Progress {
 public:
  Progress(std::string label, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(std::size_t done, std::size_t total);
  /// Makes room for another line on stderr.
  void wipe();

 private:
  std::string label_;
  bool is_shown_at_all_;
  bool shown_ = false;
  double last_shown_ = 0;  ///< [s]
  Stopwatch watch_;
};

}  // namespace viewgain::app
