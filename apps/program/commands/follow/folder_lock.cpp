// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/commands/follow/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "viewgain/core/error.hpp"

namespace viewgain::app {

namespace fs = std::filesystem;

FolderLock::FolderLock(const fs::path& folder) : folder_(folder) {
  std::error_code code;
  is_made_ = fs::create_directories(folder, code);
  if (!code) lock_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0) {
    const std::string why = code ? code.message() : std::generic_category().message(errno);
    throw Error(ErrorCode::io, folder.string() + ": cannot be made or opened: " + why);
  }
  if (::flock(lock_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  ::close(lock_);
  throw Error(ErrorCode::invalid_argument,
              folder.string() + ": another process is writing into it");
}

FolderLock::~FolderLock() {
  std::error_code ignored;
  if (is_made_) fs::remove(folder_, ignored);
  ::close(lock_);
}

}  // namespace viewgain::app
