// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/commands/study/claims.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <new>

#include "viewgain/core/error.hpp"

namespace viewgain::app {
namespace {

namespace fs = std::filesystem;

// An owner that gives a piece back removes its file: who had opened it by then has the lock of a
// file that nobody finds.
bool is_there_still(int file, const fs::path& path) {
  struct stat own {
  }, named{};
  return ::fstat(file, &own) == 0 && ::stat(path.c_str(), &named) == 0 &&
         own.st_ino == named.st_ino && own.st_dev == named.st_dev;
}

}  // namespace

Claims::~Claims() {
  try {
    while (!taken_.empty()) give_back(std::string(taken_.begin()->first));
  } catch (const std::bad_alloc&) {  // the next worker takes them over
    for (const auto& [piece, file] : taken_) ::close(file);
  }
}

bool Claims::take(const std::string& piece) {
  const fs::path path = file_of(piece);
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0) {
    throw Error(ErrorCode::io, path.string() + ": cannot be made: " + std::strerror(errno));
  }
  const bool is_locked = ::flock(file, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
  if (!is_locked || !is_there_still(file, path)) {
    ::close(file);
    return false;
  }
  const std::lock_guard lock(mutex_);
  taken_.emplace(piece, file);
  return true;
}

void Claims::clear_abandoned(const std::string& piece) {
  if (fs::exists(file_of(piece)) && take(piece)) give_back(piece);
}

void Claims::give_back(const std::string& piece) {
  const std::lock_guard lock(mutex_);
  const auto found = taken_.find(piece);
  if (found == taken_.end()) return;
  ::unlink(file_of(piece).c_str());
  ::close(found->second);
  taken_.erase(found);
}

}  // namespace viewgain::app
