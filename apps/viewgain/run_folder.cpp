// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "run_folder.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <string>
#include <vector>

#include "viewgain/core/error.hpp"

namespace viewgain::app {
namespace {

namespace fs = std::filesystem;

constexpr std::array kFiles{"run.json", "views.txt", "map.vdb", "surface.ply", "points.ply"};

std::string numbered(std::size_t index, const char* ending) {
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), "%02zu", index);
  return std::string(number.data()) + ending;
}

// NN + ending, as numbered() writes it: nobody else's file is touched.
bool is_numbered(const std::string& name, const char* ending) {
  const std::size_t digits = name.find_first_not_of("0123456789");
  return digits != std::string::npos && digits >= 2 && name.substr(digits) == ending;
}

}  // namespace

RunFolder::RunFolder(const fs::path& dir) : dir_(dir) {
  std::error_code code;
  if (dir_.empty() || (fs::exists(dir_, code) && !fs::is_directory(dir_, code))) {
    throw Error(ErrorCode::io, dir_.string() + ": not a folder");
  }
  const fs::path absolute = fs::absolute(dir_, code);
  for (fs::path p = absolute; !fs::exists(p, code) && p.has_relative_path(); p = p.parent_path()) {
    if (p.has_filename()) created_parent_ = p;
  }
  fs::create_directories(dir_, code);
  if (code) {
    if (!created_parent_.empty()) fs::remove_all(created_parent_, code);
    throw Error(ErrorCode::io, dir_.string() + ": cannot be created");
  }
}

void RunFolder::begin() {
  if (begun_) return;
  begun_ = true;
  remove_run_files();
}

RunFolder::~RunFolder() {
  if (kept_) return;
  std::error_code ignored;
  if (!created_parent_.empty()) {
    fs::remove_all(created_parent_, ignored);
  } else if (begun_) {
    remove_run_files();
  }
}

fs::path RunFolder::view(std::size_t index, const char* ending) const {
  std::error_code ignored;
  fs::create_directories(dir_ / "views", ignored);  // a failure shows when the picture is written
  return dir_ / "views" / numbered(index, ending);
}

fs::path RunFolder::map(std::size_t index) const {
  std::error_code ignored;
  fs::create_directories(dir_ / "maps", ignored);  // a failure shows when the map is written
  return dir_ / "maps" / numbered(index, ".vdb");
}

void RunFolder::remove_run_files() const {
  std::error_code ignored;
  for (const char* name : kFiles) fs::remove(dir_ / name, ignored);
  for (const auto& [folder, endings] :
       {std::pair{"views", std::vector<const char*>{".png", ".amplitude.png"}},
        std::pair{"maps", std::vector<const char*>{".vdb"}}}) {
    std::vector<fs::path> old;
    for (const auto& entry : fs::directory_iterator(dir_ / folder, ignored)) {
      const std::string name = entry.path().filename().string();
      if (std::any_of(endings.begin(), endings.end(),
                      [&](const char* ending) { return is_numbered(name, ending); })) {
        old.push_back(entry.path());
      }
    }
    for (const fs::path& path : old) fs::remove(path, ignored);
    fs::remove(dir_ / folder, ignored);  // only if nothing else is in it
  }
}

}  // namespace viewgain::app
