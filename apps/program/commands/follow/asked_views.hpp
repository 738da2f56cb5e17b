// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "program/cli/json.hpp"
#include "viewgain/core/pose.hpp"

namespace viewgain::app {

/// The views that a robot was asked for, and which frames may be its answer: those that were not
/// in the folder when it was asked. Names are those of depth images, identities as frame_identity()
/// has them.
class AskedViews {
 public:
  explicit AskedViews(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// What an earlier call has left in next.json, whose map has these frames. A file of another hand
  /// says nothing.
  void recall(const std::filesystem::path& next_json, const std::set<std::string>& identities);

  /// These are asked for now, best first; the map has these frames.
  void ask(std::vector<Pose> views, const std::set<std::string>& identities);

  /// A frame has come: the views that it may be the answer to, which are asked for no longer; none
  /// for a frame that was there before.
  [[nodiscard]] std::vector<Pose> answered_by(const std::string& name);

  /// The frame is left out; false if that was known.
  bool leave_out(const std::string& name) { return left_out_.insert(name).second; }
  /// The frame is in the map after all.
  void take(const std::string& name) { left_out_.erase(name); }

  /// Keys of next.json: asked (no frame waited then), left_out (names).
  [[nodiscard]] Json json() const {
    return {{"asked", is_asked_},
            {"left_out", std::vector<std::string>(left_out_.begin(), left_out_.end())}};
  }

 private:
  [[nodiscard]] std::set<std::string> judged(const std::set<std::string>& identities) const;

  std::filesystem::path folder_;
  std::vector<Pose> asked_;
  std::set<std::string> known_;     // images that were there
  std::set<std::string> left_out_;  // of bad frames
  bool is_asked_ = false;
};

}  // namespace viewgain::app
