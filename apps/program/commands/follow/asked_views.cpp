// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/follow/asked_views.hpp"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <system_error>
#include <utility>

#include "viewgain/support/file_bytes.hpp"

namespace viewgain::app {
namespace {

namespace fs = std::filesystem;

std::set<std::string> images_in(const fs::path& folder) {
  std::set<std::string> names;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    std::string name = entry.path().filename().string();
    if (name.ends_with(".depth.png")) names.insert(std::move(name));
  }
  return names;
}

}  // namespace

std::set<std::string> AskedViews::judged(const std::set<std::string>& identities) const {
  std::set<std::string> names = left_out_;
  for (const std::string& identity : identities) {
    names.insert(identity.substr(identity.find(' ') + 1));
  }
  return names;
}

void AskedViews::recall(const fs::path& next_json, const std::set<std::string>& identities) {
  std::error_code ignored;
  if (!fs::exists(next_json, ignored)) return;
  try {
    const Json next = Json::parse(file_bytes(next_json));
    for (const Json& name : next.at("left_out")) left_out_.insert(name.get<std::string>());
    // Else the map has grown since, or is another one.
    if (next.at("asked").get<bool>() && next.at("frames").get<std::size_t>() == identities.size()) {
      for (const Json& view : next.at("next")) {
        Pose pose;
        for (std::size_t k = 0; k < pose.m.size(); ++k) {
          pose.m[k] = view.at("T_world_camera").at(k / 4).at(k % 4).get<double>();
        }
        asked_.push_back(pose);
      }
    }
  } catch (const std::exception&) {
    asked_.clear();
  }
  known_ = judged(identities);
}

void AskedViews::ask(std::vector<Pose> views, const std::set<std::string>& identities) {
  const std::set<std::string> there = images_in(folder_), done = judged(identities);
  // What came since an earlier asking that nobody has answered may yet be the answer.
  if (asked_.empty()) known_ = there;
  asked_ = std::move(views);
  is_asked_ = std::includes(done.begin(), done.end(), there.begin(), there.end());
}

std::vector<Pose> AskedViews::answered_by(const std::string& name) {
  if (known_.contains(name)) return {};
  return std::exchange(asked_, {});
}

}  // namespace viewgain::app
