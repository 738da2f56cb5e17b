// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "stopwatch.hpp"
#include "viewgain/core/exec_config.hpp"

namespace viewgain::app {

/// Wall time by stage [s]: acquire, integrate, snapshot, surface, candidates, score, quality,
/// pictures.
using StageSeconds = std::map<std::string, double>;

/// How the parts of the loop run, and where they note how long their stages take. Never changes a
/// result.
struct LoopExec {
  ExecConfig threads{};
  StageSeconds* seconds = nullptr;  ///< added to; null: nobody wants to know

  /// Adds the time until it goes to a stage.
  class Measuring {
   public:
    Measuring(StageSeconds* seconds, const char* stage) : seconds_(seconds), stage_(stage) {}
    ~Measuring() {
      if (seconds_ != nullptr) (*seconds_)[stage_] += watch_.seconds();
    }
    Measuring(const Measuring&) = delete;
    Measuring& operator=(const Measuring&) = delete;

   private:
    StageSeconds* seconds_;
    const char* stage_;
    Stopwatch watch_;
  };

  [[nodiscard]] Measuring measure(const char* stage) const { return {seconds, stage}; }
};

}  // namespace viewgain::app
