// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>

#include "status.hpp"
#include "viewgain/raycast/view_measure.hpp"

namespace viewgain::c_api {

/// A caller's vg_watch during one call.
class Watcher {
 public:
  Watcher(const vg_watch* watch, std::size_t total) : total_(total) {
    if (watch == nullptr) return;
    watch_ = read_struct(watch, "vg_watch");
    if (watch_->poll == nullptr) refuse("the member poll of vg_watch is null");
  }

  /// Valid during the lifetime of this object.
  [[nodiscard]] BatchControl control() {
    if (!watch_) return {};
    BatchControl control;
    control.progress = [this](std::size_t done, std::size_t) {
      const std::lock_guard lock(mutex_);
      done_ = std::max(done_, done);
    };
    control.is_cancelled = [this] {
      const std::lock_guard lock(mutex_);
      was_stopped_ = was_stopped_ || watch_->poll(done_, total_, watch_->user) != 0;
      return was_stopped_;
    };
    return control;
  }

  /// Call it at the end. Throws Stopped if poll ended the call.
  void finish(bool complete) {
    if (!watch_) return;
    if (!complete && was_stopped_) {
      throw Stopped("stopped by poll after " + std::to_string(done_) + " of " +
                    std::to_string(total_) + " poses");
    }
    watch_->poll(total_, total_, watch_->user);
  }

 private:
  std::optional<vg_watch> watch_;
  std::size_t total_;
  std::size_t done_ = 0;
  bool was_stopped_ = false;
  std::mutex mutex_;
};

}  // namespace viewgain::c_api
