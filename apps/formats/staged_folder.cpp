// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "staged_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "file_names.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::app {
namespace {

namespace fs = std::filesystem;

// As AtomicFile names its temporaries: .STEM.tmp-PROCESS-COUNTER.ENDING
constexpr std::string_view kTemporary = ".tmp-";

std::mutex list_mutex;
std::vector<fs::path> staged;

[[noreturn]] void fail(const fs::path& target, const std::string& what) {
  throw Error(ErrorCode::io, target.string() + ": " + what);
}

// Held as long as the folder is in use, -1 where the file system knows no locks.
int lock_of(const fs::path& path) noexcept {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file >= 0 && ::flock(file, LOCK_EX | LOCK_NB) != 0) {
    ::close(file);
    return -1;
  }
  return file;
}

// The process that a temporary of this target belongs to, by its name.
std::optional<pid_t> owner_of(std::string_view name, const std::string& prefix,
                              const std::string& ending) {
  if (!name.starts_with(prefix) || !name.ends_with(ending)) return std::nullopt;
  name.remove_prefix(prefix.size());
  name.remove_suffix(std::min(name.size(), ending.size()));
  pid_t process = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), process);
  if (error != std::errc{} || process <= 0 || end == name.data() + name.size() || *end != '-') {
    return std::nullopt;
  }
  const bool is_counter =
      std::all_of(end + 1, name.data() + name.size(), [](char c) { return c >= '0' && c <= '9'; });
  return is_counter ? std::optional(process) : std::nullopt;
}

// This process has written nothing yet: where its own number stands, an earlier one had it.
bool has_ended(pid_t process) {
  return process == ::getpid() || (::kill(process, 0) != 0 && errno == ESRCH);
}

void remove_leftovers_in(const fs::path& folder, const std::string& prefix,
                         const std::string& ending) {
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const auto owner = owner_of(entry.path().filename().string(), prefix, ending);
    if (owner && has_ended(*owner) && !entry.is_symlink()) found.push_back(entry.path());
  }
  for (const fs::path& path : found) {
    // The process may be one of another machine or container that sees this folder.
    const int lock = lock_of(path);
    if (lock < 0) continue;
    std::error_code ignored;
    fs::remove_all(path, ignored);
    ::close(lock);
  }
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
  std::string name(1, '.');
  name += target_.filename().string();
  name.append(kTemporary).append(std::to_string(::getpid())).append("-");
  name += std::to_string(counter.fetch_add(1));
  staging_ = (exists ? target_ : target_.parent_path()) / name;
  for (fs::path p = staging_.parent_path(); !fs::exists(p, code) && p.has_relative_path();
       p = p.parent_path()) {
    parents_.push_back(p);
  }
  const std::lock_guard guard(list_mutex);
  if (!fs::create_directories(staging_, code) || code) {
    remove_parents();
    fail(target, "cannot be created" + (code ? ": " + code.message() : ""));
  }
  lock_ = lock_of(staging_);
  staged.push_back(staging_);
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
  release();
  remove_parents();
}

void StagedFolder::remove_parents() noexcept {
  std::error_code ignored;  // one that is not empty stays
  for (const fs::path& parent : parents_) fs::remove(parent, ignored);
}

void StagedFolder::release() noexcept {
  const std::lock_guard guard(list_mutex);
  std::erase(staged, staging_);
  if (lock_ >= 0) ::close(lock_);
  lock_ = -1;
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
  for (const fs::path& folder : staged) {
    std::error_code code;
    // Another thread may be putting a file into it.
    for (int tries = 0; tries < 10 && fs::exists(folder, code); ++tries)
      fs::remove_all(folder, code);
  }
}

void remove_leftovers(const fs::path& target) noexcept try {
  if (is_special_file(target)) return;
  const fs::path resolved =
      fs::weakly_canonical(fs::absolute(target.has_filename() ? target : target.parent_path()));
  const auto prefix = [](const fs::path& stem) {
    std::string text(1, '.');
    return text.append(stem.string()).append(kTemporary);
  };
  if (fs::is_directory(resolved)) {
    remove_leftovers_in(resolved, prefix(resolved.filename()), "");
  }
  if (!fs::is_directory(resolved.parent_path())) return;
  remove_leftovers_in(resolved.parent_path(), prefix(resolved.filename()), "");
  remove_leftovers_in(resolved.parent_path(), prefix(resolved.stem()),
                      resolved.extension().string());
} catch (const std::exception&) {
  // What is left behind does no harm.
}

}  // namespace viewgain::app
