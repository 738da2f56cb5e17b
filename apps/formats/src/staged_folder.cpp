// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/staged_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <string>
#include <system_error>
#include <utility>

#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

std::mutex list_mutex;
std::vector<const StagedFolder*> alive;

[[noreturn]] void fail(const fs::path& target, const std::string& what) {
  throw Error(ErrorCode::io, target.string() + ": " + what);
}

std::string hidden_prefix(const fs::path& target) {
  std::string name(1, '.');
  return name.append(target.filename().string()).append(".tmp-");
}

// A folder in use is locked by its process, wherever that runs. -1: that one has the lock, the
// folder is gone, or the file system has no locks.
int lock_of(const fs::path& folder) {
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0 || ::flock(file, LOCK_EX | LOCK_NB) == 0) return file;
  ::close(file);
  return -1;
}

void remove_leftovers(const fs::path& folder, const std::string& prefix) {
  std::vector<fs::path> found;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(prefix) &&
        name.find_first_not_of("0123456789-", prefix.size()) == std::string::npos) {
      found.push_back(entry.path());
    }
  }
  for (const fs::path& path : found) {
    const int lock = lock_of(path);
    if (lock < 0) continue;
    fs::remove_all(path, ignored);
    ::close(lock);
  }
}

// What says that the other files are there comes after them.
bool is_record(const fs::path& file) {
  return file == "run.json" || file == "poses.txt" || file == "simulated.txt" ||
         file == "imported.txt";
}

}  // namespace

StagedFolder::StagedFolder(const fs::path& target) {
  static std::atomic<unsigned> counter{0};
  std::error_code code;
  target_ = target.has_filename() ? target : target.parent_path();  // a slash at the end
  const bool exists = fs::exists(target_, code);
  if (target_.empty() || (exists && !fs::is_directory(target_, code))) {
    fail(target, "not a folder");
  }
  target_ = fs::weakly_canonical(fs::absolute(target_), code);
  if (code) fail(target, "cannot be created: " + code.message());
  const fs::path around = exists ? target_ : target_.parent_path();
  const std::string prefix = hidden_prefix(target_);
  remove_leftovers(target_, prefix);
  remove_leftovers(target_.parent_path(), prefix);

  const std::lock_guard guard(list_mutex);
  for (fs::path p = around; !fs::exists(p, code) && p.has_relative_path(); p = p.parent_path()) {
    parents_.push_back(p);
  }
  do {  // again if somebody took the folder for a leftover before it was locked
    staging_ =
        around / (prefix + std::to_string(::getpid()) + "-" + std::to_string(counter.fetch_add(1)));
    fs::create_directories(staging_, code);
    if (code) {
      remove();
      fail(target, "cannot be created: " + code.message());
    }
    lock_ = lock_of(staging_);
  } while (lock_ < 0 && !fs::exists(staging_, code));
  alive.push_back(this);
}

StagedFolder::~StagedFolder() {
  const std::lock_guard guard(list_mutex);
  std::erase(alive, this);
  remove();
  if (lock_ >= 0) ::close(lock_);
}

void StagedFolder::remove() const noexcept {
  std::error_code ignored;
  // Another thread may be putting a file into it when a signal ends the program.
  for (int tries = 0; tries < 10 && fs::exists(staging_, ignored); ++tries) {
    fs::remove_all(staging_, ignored);
  }
  for (const fs::path& parent : parents_) fs::remove(parent, ignored);  // if empty
}

void StagedFolder::commit(const std::vector<fs::path>& earlier) {
  std::error_code code;
  if (!fs::exists(target_, code)) {
    fs::rename(staging_, target_, code);
    if (!code) return;
    code.clear();  // somebody else has made it meanwhile
  }
  std::vector<fs::path> written;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(staging_, code)) {
    if (!entry.is_directory()) written.push_back(entry.path().lexically_relative(staging_));
  }
  std::sort(written.begin(), written.end(), [](const fs::path& a, const fs::path& b) {
    return std::pair(is_record(a), a) < std::pair(is_record(b), b);
  });
  for (const fs::path& file : written) {
    if (!code) fs::create_directories((target_ / file).parent_path(), code);
    if (!code) fs::rename(staging_ / file, target_ / file, code);
  }
  if (code) fail(target_, "cannot be written: " + code.message());
  for (const fs::path& file : earlier) {
    if (std::find(written.begin(), written.end(), file) != written.end()) continue;
    fs::remove(target_ / file, code);
    if (file.has_parent_path()) fs::remove((target_ / file).parent_path(), code);  // if empty
  }
}

void remove_staged_folders() noexcept {
  const std::lock_guard guard(list_mutex);
  for (const StagedFolder* folder : alive) folder->remove();
}

}  // namespace viewgain
