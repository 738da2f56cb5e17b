// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/run_folder.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include "folders.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/file_bytes.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

constexpr std::array kFiles{"run.json", kCheckpoint,   "config.toml", "views.txt",  "next.txt",
                            "map.vdb",  "surface.ply", "points.ply",  "report.html"};

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

bool has_mark(const fs::path& file, const char* mark) {
  std::error_code ignored;
  return fs::is_regular_file(file, ignored) && file_bytes(file).find(mark) != std::string::npos;
}

// An earlier run's files, which a new run may replace. One that was killed while its files were
// moved has no run.json.
std::vector<fs::path> files_of_earlier_run(const fs::path& dir) {
  std::vector<fs::path> files = run_files(dir);
  if (files.empty()) return files;
  if (!has_mark(dir / "run.json", "\"map_hash\"") &&
      !has_mark(dir / kCheckpoint, "\"decisions\"")) {
    throw Error(ErrorCode::invalid_argument,
                dir.string() + ": holds " + files.front().string() +
                    " but no run.json of a run that left it; choose another folder");
  }
  return files;
}

}  // namespace

std::vector<fs::path> run_files(const fs::path& dir) {
  std::vector<fs::path> files;
  for (const char* name : kFiles) {
    if (is_there(dir / name)) files.emplace_back(name);
  }
  for (const auto& [folder, endings] :
       {std::pair{"views", std::vector<const char*>{".png", ".amplitude.png"}},
        std::pair{"maps", std::vector<const char*>{".vdb"}}}) {
    for (const fs::path& name : names_in(dir / folder)) {
      if (std::any_of(endings.begin(), endings.end(),
                      [&](const char* ending) { return is_numbered(name.string(), ending); })) {
        files.push_back(folder / name);
      }
    }
  }
  return files;
}

RunFolder::RunFolder(const fs::path& dir, bool resume)
    : dir_(dir),
      earlier_(files_of_earlier_run(dir)),
      staged_(dir, resume ? kCheckpoint : nullptr) {}

fs::path RunFolder::last_checkpoint() const {
  for (const fs::path& path : {file(kCheckpoint), dir_ / kCheckpoint}) {
    if (is_there(path)) return path;
  }
  return {};
}

void RunFolder::write_checkpoint(const std::string& text) {
  write_file_atomically(file(kCheckpoint), text);
}

void RunFolder::commit(bool goes_on) {
  staged_.commit(earlier_);
  std::error_code ignored;
  if (!goes_on) fs::remove(dir_ / kCheckpoint, ignored);
}

fs::path RunFolder::view(std::size_t index, const char* ending) const {
  std::error_code ignored;
  fs::create_directories(file("views"), ignored);  // a failure shows when the picture is written
  return file("views") / numbered(index, ending);
}

fs::path RunFolder::map(std::size_t index) const {
  std::error_code ignored;
  fs::create_directories(file("maps"), ignored);  // a failure shows when the map is written
  return file("maps") / numbered(index, ".vdb");
}

}  // namespace viewgain
