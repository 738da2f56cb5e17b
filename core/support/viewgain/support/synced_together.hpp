// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// A folder that is synced as a whole, before it gets its name, instead of file by file: while this
/// object lives, an AtomicFile in the folder, or below, neither syncs nor looks for leftovers.
/// Thread safety: distinct objects may be used from distinct threads. Cost: one system call for a
/// sync, which waits for all that the file system has to write; if that fails, one per file.
class VIEWGAIN_EXPORT SyncedTogether {
 public:
  /// The folder must be there, its path absolute and without links.
  explicit SyncedTogether(const std::filesystem::path& folder);
  ~SyncedTogether();
  SyncedTogether(const SyncedTogether&) = delete;
  SyncedTogether& operator=(const SyncedTogether&) = delete;

  /// Waits until all files in the folder, and their names, are on the disk. Throws Error(io) that
  /// names the file or folder that cannot be written.
  void sync() const;

 private:
  std::filesystem::path folder_;
  int file_ = -1;  // open from the start: a failure that comes before sync() counts, too
};

/// Whether the file lies in the folder of a SyncedTogether.
[[nodiscard]] bool are_synced_together(const std::filesystem::path& file);

}  // namespace viewgain
