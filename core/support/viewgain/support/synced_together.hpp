// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// A new folder whose files are synced to the disk all together instead of one by one, before the
/// folder is renamed to its final name. While this object exists, an AtomicFile in the folder or
/// its subfolders neither syncs nor removes leftovers of killed processes. Thread safety: different
/// objects may be used from different threads. Cost of a sync: one system call, which waits for all
/// pending writes of the file system. If this call fails, there is one call per file.
class VIEWGAIN_EXPORT SyncedTogether {
 public:
  /// The folder must exist. Its path must be absolute and have no symbolic links.
  explicit SyncedTogether(const std::filesystem::path& folder);
  ~SyncedTogether();
  SyncedTogether(const SyncedTogether&) = delete;
  SyncedTogether& operator=(const SyncedTogether&) = delete;

  /// Waits until all files in the folder and their names are on the disk. Throws Error(io) that
  /// names the file or folder that cannot be written.
  void sync() const;

 private:
  std::filesystem::path folder_;
  int file_ = -1;  // open from the start, so that sync() also reports earlier failures
};

/// Whether the file lies in the folder of a SyncedTogether object, or below it.
[[nodiscard]] bool are_synced_together(const std::filesystem::path& file);

}  // namespace viewgain
