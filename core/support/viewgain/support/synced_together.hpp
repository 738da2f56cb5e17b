// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// A folder that is synced as a whole, before it gets its name, instead of file by file. While this
/// object exists, an AtomicFile in the folder, or below, neither syncs nor removes leftovers.
/// Thread safety: distinct objects may be used from distinct threads. Cost of a sync: one system
/// call, which waits for all pending writes of the file system; if that fails, one per file.
class VIEWGAIN_EXPORT SyncedTogether {
 public:
  /// The folder must exist, and its path must be absolute and without links.
  explicit SyncedTogether(const std::filesystem::path& folder);
  ~SyncedTogether();
  SyncedTogether(const SyncedTogether&) = delete;
  SyncedTogether& operator=(const SyncedTogether&) = delete;

  /// Waits until all files in the folder, and their names, are on the disk. Throws Error(io) that
  /// names the file or folder that cannot be written.
  void sync() const;

 private:
  std::filesystem::path folder_;
  int file_ = -1;  // open from the start, so that sync() also reports earlier failures
};

/// Whether the file lies in the folder of a SyncedTogether.
[[nodiscard]] bool are_synced_together(const std::filesystem::path& file);

}  // namespace viewgain
