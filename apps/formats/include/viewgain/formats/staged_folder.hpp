// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// A folder of results that appears, or begins to change, only when all of them are written: they
/// go into a hidden folder, beside the target where that is not there yet, else inside it, and
/// commit() moves them. What else is in the target stays. The hidden folder is called
/// .NAME.tmp-PROCESS-COUNTER; one that a killed process has left is removed by the next writer of
/// the same target, or taken up. Thread safety: distinct objects may be used from distinct threads.
/// Cost of commit(): one rename, or one a file where the target is there.
class VIEWGAIN_EXPORT StagedFolder {
 public:
  /// Creates the hidden folder, and the target's parents where they are missing. Throws Error(io).
  /// With a name `taken_up` that folder of an ended process which has such a file is gone on with,
  /// without what was half-written in it.
  explicit StagedFolder(const std::filesystem::path& target, const char* taken_up = nullptr);
  /// Removes what commit() has not moved, and those parents, unless something else is in them now.
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  /// Where to write.
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return staging_; }

  /// Moves the folder as a whole where there is no target yet. Else moves every file over the one
  /// of its name, so that each name has its old or its new contents at any time, run.json,
  /// poses.txt, simulated.txt and imported.txt last: new ones stand beside new files. Then removes
  /// those of `earlier` (relative to the target, in any order) that were not written anew, and the
  /// folders that this leaves empty. Throws Error(io).
  void commit(const std::vector<std::filesystem::path>& earlier);

  /// From now on the hidden folder stays if commit() does not come, to be taken up. What was taken
  /// up stays, too.
  void keep() noexcept { is_kept_ = true; }

 private:
  friend VIEWGAIN_EXPORT void remove_staged_folders() noexcept;
  void remove() const noexcept;
  bool take_leftovers(const std::filesystem::path& folder, const std::string& prefix,
                      const char* taken_up);

  std::filesystem::path target_;
  std::filesystem::path staging_;
  std::vector<std::filesystem::path> parents_;  // made for this one, the innermost first
  int lock_ = -1;                               // of the hidden folder, while it is in use
  std::atomic<bool> is_kept_ = false;
};

/// Removes the hidden folders that are not kept, and the parents made for them, of all StagedFolder
/// objects of this process, for a program that a signal ends. Not for a signal's handler itself: it
/// takes a lock. The writers fail afterwards.
VIEWGAIN_EXPORT void remove_staged_folders() noexcept;

}  // namespace viewgain
