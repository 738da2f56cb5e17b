// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/staged_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <mutex>
#include <new>
#include <set>
#include <system_error>
#include <utility>

#include "folders.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/synced_together.hpp"
#include "viewgain/support/temporary_names.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

std::mutex list_mutex;
std::vector<const StagedFolder*> alive;

[[noreturn]] void fail(const fs::path& target, const std::string& what) {
  throw Error(ErrorCode::io, target.string() + ": " + what);
}

// A process locks the folder that it uses, also on another machine. -1: another process has the
// lock, the folder is gone, or the file system has no locks.
int lock_of(const fs::path& folder) {
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0 || ::flock(file, LOCK_EX | LOCK_NB) == 0) return file;
  ::close(file);
  return -1;
}

// Hidden folders for this target, each of one process.
std::vector<fs::path> leftovers(const fs::path& folder, const TemporaryNames& names) {
  std::vector<fs::path> found;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    if (names.writer_of(entry.path().filename().string()) != 0) found.push_back(entry.path());
  }
  return found;
}

// Call it before the file replaces another, if that exists.
void take_permissions(const fs::path& file, const fs::path& replaced) {
  struct stat status {};
  if (::stat(replaced.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return;
  const int written = ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
  if (written < 0) return;
  Permissions(status).give(written);
  ::close(written);
}

// When the machine was started, in the clock of file times.
fs::file_time_type time_of_boot() {
  struct timespec since {};
  (void)::clock_gettime(CLOCK_BOOTTIME, &since);
  return fs::file_time_type::clock::now() - std::chrono::seconds(since.tv_sec);
}

// Also removes links, which writers would follow out of the folder. Only the record was synced, so
// files from before the machine was started may be incomplete after a power cut.
void remove_half_written(const fs::path& folder, const char* record) {
  std::vector<fs::path> found;
  std::error_code ignored;
  const fs::file_time_type boot = time_of_boot();
  constexpr auto kSkip = fs::directory_options::skip_permission_denied;
  for (const fs::directory_entry& entry :
       fs::recursive_directory_iterator(folder, kSkip, ignored)) {
    const bool is_hidden = entry.path().filename().string().starts_with(".");
    const bool is_old = entry.is_regular_file(ignored) && entry.path() != folder / record &&
                        entry.last_write_time(ignored) < boot;
    if (is_hidden || is_old || entry.is_symlink(ignored)) found.push_back(entry.path());
  }
  for (const fs::path& path : found) fs::remove(path, ignored);
}

// Files that show that the other files exist are moved last.
bool is_record(const fs::path& file) {
  return file == "run.json" || file == "poses.txt" || file == "simulated.txt" ||
         file == "imported.txt";
}

constexpr std::array kFiles{"run.json",  kCheckpoint, "config.toml", "views.txt",  "next.txt",
                            "next.json", "map.vdb",   "surface.ply", "points.ply", "report.html"};

std::string numbered(std::size_t index, const char* ending) {
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), "%02zu", index);
  return std::string(number.data()) + ending;
}

// NN + ending, as numbered() writes it, so that no other files are touched.
bool is_numbered(const std::string& name, const char* ending) {
  const std::size_t digits = name.find_first_not_of("0123456789");
  return digits != std::string::npos && digits >= 2 && name.substr(digits) == ending;
}

bool has_mark(const fs::path& file, const char* mark) {
  std::error_code ignored;
  return fs::is_regular_file(file, ignored) && file_bytes(file).find(mark) != std::string::npos;
}

// An earlier run's files, which a new run may replace. A run that was killed while its files were
// moved has no run.json.
std::vector<fs::path> files_of_earlier_run(const fs::path& dir) {
  std::vector<fs::path> files = run_files(dir);
  if (is_there(dir / "state.vdb")) {
    refuse(dir.string() + ": the folder belongs to model --watch; choose another folder");
  }
  if (files.empty()) return files;
  if (!has_mark(dir / "run.json", "\"map_hash\"") &&
      !has_mark(dir / kCheckpoint, "\"decisions\"")) {
    refuse(dir.string() + ": the folder has " + files.front().string() +
           " but no run.json, so no run wrote this file; choose another folder");
  }
  return files;
}

}  // namespace

// Resumes at most one hidden folder and removes the others; folders in use stay.
bool StagedFolder::take_leftovers(const fs::path& folder, const TemporaryNames& names,
                                  const char* taken_up) {
  std::error_code ignored;
  for (const fs::path& path : leftovers(folder, names)) {
    const int lock = lock_of(path);
    if (lock < 0) continue;
    if (taken_up != nullptr && lock_ < 0 && fs::exists(path / taken_up, ignored)) {
      staging_ = path;
      lock_ = lock;
      remove_half_written(staging_, taken_up);
      keep();
      continue;
    }
    fs::remove_all(path, ignored);
    ::close(lock);
  }
  return lock_ >= 0;
}

StagedFolder::StagedFolder(const fs::path& target, const char* taken_up) {
  std::error_code code;
  target_ = target.has_filename() ? target : target.parent_path();  // for a slash at the end
  const bool exists = fs::exists(target_, code);
  if (target_.empty() || (exists && !fs::is_directory(target_, code))) fail(target, "not a folder");
  target_ = fs::weakly_canonical(fs::absolute(target_), code);
  if (code) fail(target, "cannot be created: " + code.message());
  const fs::path around = exists ? target_ : target_.parent_path();
  const TemporaryNames names = TemporaryNames::of_folder(target_);
  const bool is_inside = take_leftovers(target_, names, taken_up);
  const bool is_taken_up = take_leftovers(target_.parent_path(), names, taken_up) || is_inside;

  const std::lock_guard guard(list_mutex);
  alive.reserve(alive.size() + 1);  // so that listing the folder below cannot fail
  // Files that replace others get their permissions when they are moved. Until then they are
  // private.
  const mode_t mode = exists ? S_IRWXU : S_IRWXU | S_IRWXG | S_IRWXO;
  if (is_taken_up) {
    if (exists) (void)::chmod(staging_.c_str(), mode);
    synced_ = std::make_unique<SyncedTogether>(staging_);
    alive.push_back(this);
    return;
  }
  for (fs::path p = around; !fs::exists(p, code) && p.has_relative_path(); p = p.parent_path()) {
    parents_.push_back(p);
  }
  bool is_new = false;
  do {  // repeats if the name is in use, or another process removed the folder before it was locked
    staging_ = around / names.next().filename();
    fs::create_directories(around, code);
    is_new = !code && ::mkdir(staging_.c_str(), mode) == 0;
    if (!code && !is_new && errno != EEXIST) code.assign(errno, std::generic_category());
    if (code) {
      staging_.clear();  // belongs to another process
      remove();
      fail(target, "cannot be created: " + code.message());
    }
    lock_ = is_new ? lock_of(staging_) : -1;
  } while (!is_new || (lock_ < 0 && !fs::exists(staging_, code)));
  try {
    synced_ = std::make_unique<SyncedTogether>(staging_);
  } catch (const std::bad_alloc&) {
    remove();
    throw;
  }
  alive.push_back(this);
}

StagedFolder::~StagedFolder() {
  const std::lock_guard guard(list_mutex);
  std::erase(alive, this);
  remove();
  if (lock_ >= 0) ::close(lock_);
}

void StagedFolder::remove() const noexcept {
  if (is_kept_) return;
  std::error_code ignored;
  try {
    // When a signal ends the program, other threads may still write files to the folder, as fast as
    // they are removed. Renaming the folder stops them. The loops handle a file that is just being
    // opened, and a thread that creates the folder again.
    for (int tries = 0; tries < 10 && fs::exists(staging_, ignored); ++tries) {
      const fs::path aside =
          staging_.parent_path() / TemporaryNames::of_folder(target_).next().filename();
      fs::rename(staging_, aside, ignored);
      const fs::path& found = ignored ? staging_ : aside;
      for (int again = 0; again < 10 && fs::exists(found, ignored); ++again) {
        fs::remove_all(found, ignored);
      }
    }
  } catch (const std::bad_alloc&) {  // the next writer removes it
  }
  for (const fs::path& parent : parents_) fs::remove(parent, ignored);  // if empty
}

void StagedFolder::commit(const std::vector<fs::path>& earlier) {
  synced_->sync();  // before renaming, so that files are complete after a power cut
  std::error_code code;
  if (!fs::exists(target_, code)) {
    fs::rename(staging_, target_, code);
    if (!code) return sync_folder(target_.parent_path());
    code.clear();  // another process has created it meanwhile
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
    if (!code) take_permissions(staging_ / file, target_ / file);
    if (!code) fs::rename(staging_ / file, target_ / file, code);
  }
  if (code) fail(target_, "cannot be written: " + code.message());
  std::set<fs::path> folders;
  for (const fs::path& file : written) folders.insert((target_ / file).parent_path());
  for (const fs::path& folder : folders) sync_folder(folder);
  is_kept_ = false;
  const std::set<fs::path> kept(written.begin(), written.end());
  for (const fs::path& file : earlier) {
    if (kept.contains(file)) continue;
    fs::remove(target_ / file, code);
    if (file.has_parent_path()) fs::remove((target_ / file).parent_path(), code);  // if empty
  }
}

void remove_staged_folders() noexcept {
  const std::lock_guard guard(list_mutex);
  for (const StagedFolder* folder : alive) folder->remove();
}

std::vector<fs::path> run_files(const fs::path& dir) {
  std::vector<fs::path> files;
  for (const char* name : kFiles) {
    if (is_there(dir / name)) files.emplace_back(name);
  }
  for (const auto& [folder, endings] :
       {std::pair{"views", std::vector<const char*>{".png", ".amplitude.png"}},
        std::pair{"maps", std::vector<const char*>{".vdb", ".txt"}}}) {
    for (const std::string& name : names_in(dir / folder)) {
      if (std::any_of(endings.begin(), endings.end(),
                      [&](const char* ending) { return is_numbered(name, ending); })) {
        files.push_back(fs::path(folder) / name);
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
  AtomicFile checkpoint(file(kCheckpoint));
  checkpoint.write(text);
  checkpoint.sync();  // a run may resume from it although its folder was never synced
  checkpoint.commit();
  sync_folder(staged_.path());
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

fs::path RunFolder::map(std::size_t index, const char* ending) const {
  std::error_code ignored;
  fs::create_directories(file("maps"), ignored);  // a failure shows when the map is written
  return file("maps") / numbered(index, ending);
}

}  // namespace viewgain
