// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "viewgain/core/export.hpp"

namespace viewgain {

class SyncedTogether;
class TemporaryNames;

/// A folder of results that appears, or begins to change, only when all of them are written: they
/// go into a hidden folder, beside the target where that is not there yet, else inside it, and
/// commit() moves them. What else is in the target stays. The hidden folder is called
/// .NAME.tmp-PROCESS-COUNTER, with a hash for a NAME that leaves no room; one that a killed process
/// has left is removed by the next writer of the same target, or taken up. Thread safety: distinct
/// objects may be used from distinct threads. Cost of commit(): the disk is waited for once, then
/// one rename, or one per file where the target is there.
class VIEWGAIN_EXPORT StagedFolder {
 public:
  /// Creates the hidden folder, and the target's parents where they are missing. Throws Error(io).
  /// With a name `taken_up` it continues in the hidden folder of an ended process that has a file
  /// of this name, and removes what was half-written there.
  explicit StagedFolder(const std::filesystem::path& target, const char* taken_up = nullptr);
  /// Removes what commit() has not moved, and those parents, unless something else is in them now.
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  /// Where to write.
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return staging_; }

  /// Syncs the files, then moves the folder as a whole where there is no target yet. Else moves
  /// every file over the one of its name, whose mode and group it takes, so that each name has its
  /// old or its new contents at any time, run.json, poses.txt, simulated.txt and imported.txt last:
  /// new ones stand beside new files. Then removes those of `earlier` (relative to the target, in
  /// any order) that were not written anew, and the folders that this leaves empty. Throws
  /// Error(io).
  void commit(const std::vector<std::filesystem::path>& earlier);

  /// From now on the hidden folder stays if commit() does not come, to be taken up. What was taken
  /// up stays, too.
  void keep() noexcept { is_kept_ = true; }

 private:
  friend VIEWGAIN_EXPORT void remove_staged_folders() noexcept;
  void remove() const noexcept;
  bool take_leftovers(const std::filesystem::path& folder, const TemporaryNames& names,
                      const char* taken_up);

  std::filesystem::path target_;
  std::filesystem::path staging_;
  std::vector<std::filesystem::path> parents_;  // made for this one, the innermost first
  std::unique_ptr<const SyncedTogether> synced_;
  int lock_ = -1;  // of the hidden folder, while it is in use
  std::atomic<bool> is_kept_ = false;
};

/// Removes the hidden folders that are not kept, and the parents made for them, of all StagedFolder
/// objects of this process, for a program that a signal ends. Not for a signal's handler itself: it
/// takes a lock. The writers fail afterwards.
VIEWGAIN_EXPORT void remove_staged_folders() noexcept;

/// The files of `dir` whose names `reconstruct` and `model` write, relative to it, in any order;
/// none if there is no such folder. Costs O(files).
[[nodiscard]] VIEWGAIN_EXPORT std::vector<std::filesystem::path> run_files(
    const std::filesystem::path& dir);

/// What a run has decided, until it is done, for one that goes on: the first of its files to be
/// there.
inline constexpr const char* kCheckpoint = "checkpoint.json";

/// The folder that `reconstruct` and `model` leave: run.json, config.toml, views.txt, next.txt,
/// next.json, map.vdb, surface.ply, points.ply, report.html, views/NN.png, views/NN.amplitude.png,
/// maps/NN.vdb, maps/NN.txt. Nothing is in it, and an earlier run is as it was, until commit().
/// Thread safety: one call at a time. Members that throw say so: names are not checked. Cost of the
/// constructor: O(files); calls that name a file take constant time.
class VIEWGAIN_EXPORT RunFolder {
 public:
  /// Throws Error(io), and Error(invalid_argument) if the folder holds files of these names without
  /// an earlier run's run.json or checkpoint.json. With `resume` goes on with what an ended process
  /// left that had a checkpoint.
  explicit RunFolder(const std::filesystem::path& dir, bool resume = false);

  /// Where to write.
  [[nodiscard]] std::filesystem::path file(const char* name) const { return staged_.path() / name; }
  /// A file of view `index`, by its ending; makes the folder views/.
  [[nodiscard]] std::filesystem::path view(std::size_t index, const char* ending) const;
  /// The map after view `index`, or by the ending .txt the candidates for the next one; makes the
  /// folder maps/.
  [[nodiscard]] std::filesystem::path map(std::size_t index, const char* ending = ".vdb") const;

  /// The checkpoint that was there before this run wrote one: what was gone on with has it, or the
  /// folder itself; empty if there is none.
  [[nodiscard]] std::filesystem::path last_checkpoint() const;
  /// Replaces the checkpoint. Throws Error(io).
  void write_checkpoint(const std::string& text);
  /// From now on what is there stays for one that goes on if commit() does not come.
  void keep() noexcept { staged_.keep(); }

  /// Puts the run in the place of an earlier one; its checkpoint stays only where it `goes_on`.
  /// Throws Error(io).
  void commit(bool goes_on = false);

 private:
  std::filesystem::path dir_;
  std::vector<std::filesystem::path> earlier_;
  StagedFolder staged_;
};

}  // namespace viewgain
