// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/atomic_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/support/synced_together.hpp"
#include "viewgain/support/temporary_names.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& target, int error_number) {
  std::string why = std::generic_category().message(error_number);
  struct rlimit limit {};
  if (error_number == EFBIG && ::getrlimit(RLIMIT_FSIZE, &limit) == 0 &&
      limit.rlim_cur != RLIM_INFINITY) {
    why += "; this process may write files of at most " + std::to_string(limit.rlim_cur) +
           " bytes (ulimit -f)";
  }
  throw Error(ErrorCode::io, target.string() + ": cannot write: " + why);
}

// Resolving names.

/// N if `at` is /proc/self/fd/N, also under another name of that folder; else -1.
int own_descriptor(const fs::path& at) {
  const std::string name = at.filename().string();
  int number = -1;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc{} || end != name.data() + name.size() || number < 0) return -1;
  std::error_code code;
  const fs::path folder = fs::canonical(at.parent_path(), code);
  return !code && folder == "/proc/" + std::to_string(::getpid()) + "/fd" ? number : -1;
}

struct Destination {
  fs::path path;        ///< not a link; need not exist
  int descriptor = -1;  ///< of this process, if the name refers to one (/dev/stdout)
};

Destination follow_links(const fs::path& target) {
  constexpr int kMostLinks = 40;  // the kernel's limit
  fs::path at = target;
  for (int links = 0; links < kMostLinks; ++links) {
    if (const int descriptor = own_descriptor(at); descriptor >= 0) return {target, descriptor};
    std::error_code code;
    if (!fs::is_symlink(fs::symlink_status(at, code))) return {at, -1};
    const fs::path next = fs::read_symlink(at, code);
    if (code) fail(target, code.value());
    at = at.parent_path() / next;
  }
  fail(target, ELOOP);
}

/// Shares the descriptor's position in the file, so that the output of other writers is not
/// overwritten.
int duplicate_for_writing(const fs::path& target, int descriptor) {
  const int mode = ::fcntl(descriptor, F_GETFL);
  if (mode < 0 || (mode & O_ACCMODE) == O_RDONLY) fail(target, EBADF);
  const int file = ::fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
  if (file < 0) fail(target, errno);
  return file;
}

// Temporary files, locked as long as their writer lives.

/// Removes files that killed writers of this target left. A lock shows that a writer still runs,
/// also on another machine or in another container.
void remove_leftovers(const fs::path& target, const TemporaryNames& names) {
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::error_code code;
  fs::directory_iterator entry(folder, code);
  for (; !code && entry != fs::directory_iterator(); entry.increment(code)) {
    const fs::path& path = entry->path();
    const pid_t writer = names.writer_of(path.filename().string());
    if (writer == 0 || ::kill(writer, 0) == 0 || errno != ESRCH) continue;
    const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (file < 0) continue;
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) ::unlink(path.c_str());
    ::close(file);
  }
}

/// Creates the file, which must not exist yet. Returns its descriptor, or -1 and errno.
int create_new(const fs::path& path, mode_t mode) {
  const int file = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  if (file >= 0) (void)::flock(file, LOCK_EX | LOCK_NB);  // not every file system has locks
  return file;
}

/// Names of temporary files that remove_temporary_files() removes; more files than this are not
/// listed. A signal handler and a destructor may look for the same name at once. The one that
/// removes it from the list, in one atomic step, owns it.
std::array<std::atomic<char*>, 64> temporaries{};
static_assert(std::atomic<char*>::is_always_lock_free);  // required for use in a signal handler

/// The name as it was listed, or null.
char* list_temporary(const fs::path& path) {
  char* name = ::strdup(path.c_str());
  if (name == nullptr) return nullptr;
  for (std::atomic<char*>& place : temporaries) {
    char* nothing = nullptr;
    if (place.compare_exchange_strong(nothing, name)) return name;
  }
  std::free(name);
  return nullptr;
}

void unlist_temporary(char* name) {
  if (name == nullptr) return;
  for (std::atomic<char*>& place : temporaries) {
    char* expected = name;
    if (place.compare_exchange_strong(expected, nullptr)) {
      std::free(name);
      return;
    }
  }
}

// A write also clears the other bits.
constexpr mode_t kPermissionBits = S_IRWXU | S_IRWXG | S_IRWXO;

bool is_synced(int file) {
  // Some file systems do not support syncing and report that.
  return ::fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP;
}

}  // namespace

Permissions::Permissions(const struct stat& status) noexcept
    : mode_(status.st_mode & kPermissionBits), group_(status.st_gid) {}

void Permissions::give(int file) const noexcept {
  struct stat own {};
  if (::fstat(file, &own) != 0) return;
  mode_t mode = mode_;
  // The group is set first, because its permissions apply to this group only. If that is not
  // allowed, the file's group gets the permissions of others.
  if (own.st_gid != group_ && ::fchown(file, static_cast<uid_t>(-1), group_) != 0) {
    mode = (mode & ~mode_t{S_IRWXG}) | (mode & S_IRWXO) << 3U;
  }
  // Some file systems have no modes, and the mode cannot be changed.
  if ((own.st_mode & kPermissionBits) != mode) (void)::fchmod(file, mode);
}

AtomicFile::AtomicFile(const fs::path& target) : target_(target) {
  if (target.empty()) throw Error(ErrorCode::io, "cannot write to a file without a name");
  const Destination destination = follow_links(target);
  resolved_ = temporary_ = destination.path;
  if (destination.descriptor >= 0) {
    file_ = duplicate_for_writing(target, destination.descriptor);
    return;
  }
  struct stat status {};
  const bool is_there = ::stat(target.c_str(), &status) == 0;
  if (!is_there && errno == ENAMETOOLONG) fail(target, errno);
  if (is_there && S_ISDIR(status.st_mode)) fail(target, EISDIR);
  // The first write opens it, because opening a pipe waits for its reader.
  if (is_there && !S_ISREG(status.st_mode)) return;
  if (!resolved_.has_filename()) fail(target, EISDIR);
  if (is_there) replaced_ = Permissions(status);
  syncs_ = !are_synced_together(resolved_);
  const TemporaryNames names = TemporaryNames::of_file(resolved_);
  // In a folder that is synced as a whole, the folder's owner removes leftovers.
  if (syncs_) remove_leftovers(resolved_, names);
  // Listed before the file is created, because a signal may arrive at any time.
  do {
    temporary_ = names.next();
    listed_ = list_temporary(temporary_);
    // A replacement is private until it gets the permissions of the file that it replaces.
    file_ = create_new(temporary_, replaced_ ? 0600 : 0666);
    if (file_ >= 0) return;
    const int error = errno;
    unlist_temporary(listed_);
    errno = error;
  } while (errno == EEXIST);  // left by a process with the same number
  fail(target, errno);
}

AtomicFile::~AtomicFile() {
  if (file_ >= 0) ::close(file_);
  if (!committed_ && !is_in_place()) {
    std::error_code ignored;
    fs::remove(temporary_, ignored);
  }
  unlist_temporary(listed_);
}

void AtomicFile::write(std::string_view bytes) {
  if (file_ < 0) file_ = ::open(temporary_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (file_ < 0) fail(target_, errno);
  while (!bytes.empty()) {
    const ssize_t written = ::write(file_, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      fail(target_, errno);
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void AtomicFile::sync() {
  if (!is_in_place() && !is_synced(file_)) fail(target_, errno);
}

void AtomicFile::commit() {
  if (replaced_) replaced_->give(file_);
  if (syncs_) sync();
  if (file_ >= 0 && ::close(std::exchange(file_, -1)) != 0) fail(target_, errno);
  if (!is_in_place()) {
    std::error_code code;
    fs::rename(temporary_, resolved_, code);
    if (code) fail(target_, code.value());
    // If this fails, the previous file is still complete.
    if (syncs_) sync_folder(resolved_.has_parent_path() ? resolved_.parent_path() : fs::path("."));
  }
  committed_ = true;
}

void remove_temporary_files() noexcept {
  const int error = errno;
  for (std::atomic<char*>& place : temporaries) {
    char* const name = place.exchange(nullptr);
    if (name == nullptr) continue;
    ::unlink(name);
    // Returns it to the list, because a signal handler must not free it.
    char* nothing = nullptr;
    place.compare_exchange_strong(nothing, name);
  }
  errno = error;
}

bool is_open_file(const fs::path& path) noexcept {
  try {
    return follow_links(path).descriptor >= 0;
  } catch (const std::exception&) {
    return false;  // links form a cycle
  }
}

void sync_folder(const fs::path& folder) noexcept {
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return;
  (void)is_synced(file);
  ::close(file);
}

void write_file_atomically(const fs::path& target, std::string_view contents) {
  AtomicFile file(target);
  file.write(contents);
  file.commit();
}

}  // namespace viewgain
