// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/synced_together.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <mutex>
#include <string>
#include <system_error>
#include <vector>

#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

std::mutex synced_mutex;
std::vector<fs::path> synced_folders;  // of existing objects

void sync_one(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  int error = file < 0 || ::fsync(file) != 0 ? errno : 0;
  if (file >= 0) ::close(file);
  // Some file systems do not support syncing and report that.
  if (error == 0 || error == EINVAL || error == ENOTSUP) return;
  throw Error(ErrorCode::io,
              path.string() + ": cannot write: " + std::generic_category().message(error));
}

}  // namespace

SyncedTogether::SyncedTogether(const fs::path& folder) : folder_(folder) {
  {
    const std::lock_guard lock(synced_mutex);
    synced_folders.push_back(folder);
  }
  file_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

SyncedTogether::~SyncedTogether() {
  if (file_ >= 0) ::close(file_);
  const std::lock_guard lock(synced_mutex);
  const auto own = std::find(synced_folders.begin(), synced_folders.end(), folder_);
  if (own != synced_folders.end()) synced_folders.erase(own);
}

void SyncedTogether::sync() const {
  if (file_ >= 0 && ::syncfs(file_) == 0) return;
  // The sync may have failed for an unrelated file on the same disk.
  std::error_code code;
  for (fs::recursive_directory_iterator entry(folder_, code), end; !code && entry != end;
       entry.increment(code)) {
    if (!entry->is_symlink()) sync_one(entry->path());
  }
  if (code) throw Error(ErrorCode::io, folder_.string() + ": cannot read: " + code.message());
  sync_one(folder_);
}

bool are_synced_together(const fs::path& file) {
  const std::lock_guard lock(synced_mutex);
  return std::any_of(synced_folders.begin(), synced_folders.end(), [&](const fs::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first ==
           folder.end();
  });
}

}  // namespace viewgain
