// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/atomic_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
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

namespace viewgain {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& target, int error_number) {
  throw Error(ErrorCode::io,
              target.string() + ": cannot write: " + std::generic_category().message(error_number));
}

// Where a name leads.

/// N if `at` is /proc/self/fd/N, perhaps under another name of that folder; else -1.
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
  fs::path path;        ///< no link; need not be there
  int descriptor = -1;  ///< of this process, if the name stands for one (/dev/stdout)
};

Destination follow_links(const fs::path& target) {
  constexpr int kMostLinks = 40;  // as the kernel has it
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

/// Shares the descriptor's place in the file, so that what others wrote there stays.
int duplicate_for_writing(const fs::path& target, int descriptor) {
  const int mode = ::fcntl(descriptor, F_GETFL);
  if (mode < 0 || (mode & O_ACCMODE) == O_RDONLY) fail(target, EBADF);
  const int file = ::fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
  if (file < 0) fail(target, errno);
  return file;
}

// Temporary files: .NAME.tmp-PROCESS-COUNTER.ENDING, locked as long as their writer lives.

std::string temporary_prefix(const fs::path& target) {
  // Appended piece by piece: GCC 12 warns, wrongly, of overlap where a literal is first in a sum.
  std::string name(1, '.');
  name += target.stem().string();
  name += ".tmp-";
  return name;
}

fs::path temporary_name(const fs::path& target) {
  static std::atomic<unsigned> counter{0};
  std::string name = temporary_prefix(target);
  name += std::to_string(::getpid()) + "-" + std::to_string(counter.fetch_add(1));
  name += target.extension().string();
  return target.parent_path() / name;
}

/// The process that a temporary file's name tells; 0 for any other name.
pid_t writer_of(std::string_view name, std::string_view prefix, std::string_view ending) {
  if (name.size() < prefix.size() + ending.size() || !name.starts_with(prefix) ||
      !name.ends_with(ending)) {
    return 0;
  }
  name.remove_prefix(prefix.size());
  name.remove_suffix(ending.size());
  const char* const end = name.data() + name.size();
  pid_t process = 0;
  const auto number = std::from_chars(name.data(), end, process);
  if (number.ec != std::errc{} || process <= 0 || number.ptr == end || *number.ptr != '-') return 0;
  unsigned count = 0;
  const auto rest = std::from_chars(number.ptr + 1, end, count);
  return rest.ec == std::errc{} && rest.ptr == end ? process : 0;
}

/// Removes what writers of this target left behind when they were killed. A process that runs
/// elsewhere, on another machine or in another container, is known by its lock.
void remove_leftovers(const fs::path& target) {
  const std::string prefix = temporary_prefix(target), ending = target.extension().string();
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::error_code code;
  fs::directory_iterator entry(folder, code);
  for (; !code && entry != fs::directory_iterator(); entry.increment(code)) {
    const fs::path& path = entry->path();
    const pid_t writer = writer_of(path.filename().string(), prefix, ending);
    if (writer == 0 || ::kill(writer, 0) == 0 || errno != ESRCH) continue;
    const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (file < 0) continue;
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) ::unlink(path.c_str());
    ::close(file);
  }
}

/// Creates the file, which must not be there yet. Its descriptor, or -1 and errno.
int create_new(const fs::path& path) {
  const int file = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file >= 0) (void)::flock(file, LOCK_EX | LOCK_NB);  // not every file system has locks
  return file;
}

/// The names of temporary files that remove_temporary_files() is to remove; files beyond these are
/// not listed. A handler and a destructor may look for the same name at once: the one that takes it
/// out of the list, in one step, has it to itself.
std::array<std::atomic<char*>, 64> temporaries{};
static_assert(std::atomic<char*>::is_always_lock_free);  // else no handler could use it

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

bool is_synced(int file) {
  // Some file systems have nothing to wait for and say so.
  return ::fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& target) : target_(target) {
  if (target.empty()) throw Error(ErrorCode::io, "cannot write to a file without a name");
  const Destination destination = follow_links(target);
  resolved_ = temporary_ = destination.path;
  if (destination.descriptor >= 0) {
    file_ = duplicate_for_writing(target, destination.descriptor);
    return;
  }
  std::error_code code;
  const fs::file_status status = fs::status(target, code);
  if (fs::is_directory(status)) fail(target, EISDIR);
  // Opened by the first write: to open a pipe is to wait for its reader.
  if (fs::exists(status) && !fs::is_regular_file(status)) return;
  if (!resolved_.has_filename()) fail(target, EISDIR);
  remove_leftovers(resolved_);
  // Listed for as long as the file may be there, and so from before on: a signal may come at any
  // time.
  do {
    temporary_ = temporary_name(resolved_);
    listed_ = list_temporary(temporary_);
    file_ = create_new(temporary_);
    if (file_ >= 0) return;
    const int error = errno;
    unlist_temporary(listed_);
    errno = error;
  } while (errno == EEXIST);  // of a process that had the same number
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

void AtomicFile::commit() {
  if (!is_in_place() && !is_synced(file_)) fail(target_, errno);
  if (file_ >= 0 && ::close(std::exchange(file_, -1)) != 0) fail(target_, errno);
  if (!is_in_place()) {
    std::error_code code;
    fs::rename(temporary_, resolved_, code);
    if (code) fail(target_, code.value());
    // What was there before is whole, too, if this fails.
    sync_folder(resolved_.has_parent_path() ? resolved_.parent_path() : fs::path("."));
  }
  committed_ = true;
}

void remove_temporary_files() noexcept {
  const int error = errno;
  for (std::atomic<char*>& place : temporaries) {
    char* const name = place.exchange(nullptr);
    if (name == nullptr) continue;
    ::unlink(name);
    // Back to where its file frees it, which a handler may not do.
    char* nothing = nullptr;
    place.compare_exchange_strong(nothing, name);
  }
  errno = error;
}

bool is_open_file(const fs::path& path) noexcept {
  try {
    return follow_links(path).descriptor >= 0;
  } catch (const std::exception&) {
    return false;  // of links in a circle
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
