// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace viewgain::app {

/// A folder that one process at a time writes into. The lock ends with the process, however that
/// ends; where the file system has no locks there is none.
class FolderLock {
 public:
  /// Makes the folder where it is missing. Throws Error(io) if that cannot be done, and
  /// Error(invalid_argument) if another process has the lock.
  explicit FolderLock(const std::filesystem::path& folder);
  /// Removes the folder if it was made and nothing is in it.
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::filesystem::path folder_;
  bool is_made_ = false;
  int lock_ = -1;
};

}  // namespace viewgain::app
