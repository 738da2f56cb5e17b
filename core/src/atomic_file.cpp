// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>

#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& target, const std::string& what, int error_number) {
  throw Error(ErrorCode::io,
              target.string() + ": " + what + ": " + std::generic_category().message(error_number));
}

fs::path temporary_name(const fs::path& target) {
  static std::atomic<unsigned> counter{0};
  // Appended piece by piece: GCC 12 warns, wrongly, of overlap where a literal is first in a sum.
  std::string name(1, '.');
  name += target.stem().string();
  name += ".tmp-" + std::to_string(::getpid()) + "-" + std::to_string(counter.fetch_add(1));
  name += target.extension().string();
  return target.parent_path() / name;
}

/// Names of temporary files for remove_temporary_files(). Whoever takes a name out of its place
/// owns it, so a signal's handler and another thread's destructor do not meet. A file that finds no
/// place is not listed.
std::array<std::atomic<char*>, 64> listed{};
static_assert(std::atomic<char*>::is_always_lock_free);  // else no handler could use it

/// The name as it was listed, or null.
char* list_temporary(const fs::path& path) {
  char* name = ::strdup(path.c_str());
  if (name == nullptr) return nullptr;
  for (std::atomic<char*>& place : listed) {
    char* nothing = nullptr;
    if (place.compare_exchange_strong(nothing, name)) return name;
  }
  std::free(name);
  return nullptr;
}

void unlist_temporary(char* name) {
  if (name == nullptr) return;
  for (std::atomic<char*>& place : listed) {
    char* expected = name;
    if (place.compare_exchange_strong(expected, nullptr)) {
      std::free(name);
      return;
    }
  }
}

/// Creates the file, which must not be there yet; 0 or errno.
int create_new(const fs::path& path) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) return errno;
  ::close(file);
  return 0;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& target) : target_(target) {
  if (target.empty()) throw Error(ErrorCode::io, "cannot write to a file without a name");
  std::error_code code;
  const fs::file_status status = fs::status(target, code);
  if (fs::is_directory(status)) fail(target, "cannot write", EISDIR);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    resolved_ = temporary_ = target;
    return;
  }
  resolved_ = target;
  if (fs::is_symlink(fs::symlink_status(target, code))) {
    resolved_ = fs::weakly_canonical(target, code);
    if (code) fail(target, "cannot write", code.value());
  }
  if (!resolved_.has_filename()) fail(target, "cannot write", EISDIR);
  int error = EEXIST;  // left behind by a process that had the same number
  while (error == EEXIST) {
    temporary_ = temporary_name(resolved_);
    error = create_new(temporary_);
  }
  if (error != 0) fail(target, "cannot write", error);
  listed_ = list_temporary(temporary_);
}

AtomicFile::~AtomicFile() {
  unlist_temporary(listed_);
  if (committed_ || temporary_ == resolved_) return;
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void AtomicFile::write(std::string_view bytes) {
  const int file = ::open(temporary_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (file < 0) fail(target_, "cannot write", errno);
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      const int error = errno;
      ::close(file);
      fail(target_, "cannot write", error);
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  if (::close(file) != 0) fail(target_, "cannot write", errno);
}

void AtomicFile::commit() {
  if (temporary_ != resolved_) {
    std::error_code code;
    fs::rename(temporary_, resolved_, code);
    if (code) fail(target_, "cannot write", code.value());
  }
  committed_ = true;
}

void remove_temporary_files() noexcept {
  const int error = errno;
  for (std::atomic<char*>& place : listed) {
    char* const name = place.exchange(nullptr);
    if (name == nullptr) continue;
    ::unlink(name);
    // Back to where its file frees it, which a handler may not do.
    char* nothing = nullptr;
    place.compare_exchange_strong(nothing, name);
  }
  errno = error;
}

void write_file_atomically(const fs::path& target, std::string_view contents) {
  AtomicFile file(target);
  file.write(contents);
  file.commit();
}

}  // namespace viewgain
