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

/// A folder of results that appears, or begins to change, only when all results are written.
/// Results are first written to a hidden folder: inside the target if that exists, otherwise next
/// to it. commit() then moves them. Other contents of the target remain. The hidden folder is named
/// .NAME.tmp-PROCESS-COUNTER (with a hash for a long NAME). If a killed process leaves a hidden
/// folder, the next writer of the same target removes or resumes it. Thread safety: distinct
/// objects may be used from distinct threads. Cost of commit(): one disk sync, then one rename, or
/// one per file if the target exists.
class VIEWGAIN_EXPORT StagedFolder {
 public:
  /// Creates the hidden folder, and missing parents of the target. If `taken_up` is given, and the
  /// hidden folder of an ended process contains a file of this name, resumes that folder instead
  /// and removes unfinished files in it. Throws Error(io).
  explicit StagedFolder(const std::filesystem::path& target, const char* taken_up = nullptr);
  /// Removes everything that commit() has not moved, and the created parents if they are empty.
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  /// The folder to write to.
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return staging_; }

  /// Syncs the files, then moves the whole folder if there is no target. Otherwise renames each
  /// file over the existing file of the same name, whose mode and group are kept; run.json,
  /// poses.txt, simulated.txt and imported.txt come last. At any time each name has its old or new
  /// contents. Then removes the files of `earlier` (relative to the target) that were not
  /// rewritten, and folders that become empty. Throws Error(io).
  void commit(const std::vector<std::filesystem::path>& earlier);

  /// Keeps the hidden folder for a later resume if commit() is not called. This is the default for
  /// a resumed folder.
  void keep() noexcept { is_kept_ = true; }

 private:
  friend VIEWGAIN_EXPORT void remove_staged_folders() noexcept;
  void remove() const noexcept;
  bool take_leftovers(const std::filesystem::path& folder, const TemporaryNames& names,
                      const char* taken_up);

  std::filesystem::path target_;
  std::filesystem::path staging_;
  std::vector<std::filesystem::path> parents_;  // created for this one, innermost first
  std::unique_ptr<const SyncedTogether> synced_;
  int lock_ = -1;  // lock of the hidden folder, while in use
  std::atomic<bool> is_kept_ = false;
};

/// Removes the hidden folders of all StagedFolder objects of this process that are not kept, and
/// the parents created for them. For a program that a signal ends. Writers fail afterwards. Not for
/// use in a signal handler, because it takes a lock.
VIEWGAIN_EXPORT void remove_staged_folders() noexcept;

/// Files of `dir` with names that `reconstruct` and `model` write, relative to it; empty if the
/// folder does not exist. Cost: O(files).
[[nodiscard]] VIEWGAIN_EXPORT std::vector<std::filesystem::path> run_files(
    const std::filesystem::path& dir);

/// File with the decisions of an unfinished run, for resuming it. It is written before all other
/// files.
inline constexpr const char* kCheckpoint = "checkpoint.json";

/// The folder of `reconstruct` and `model`: run.json, config.toml, views.txt, next.txt, next.json,
/// map.vdb, surface.ply, points.ply, report.html, views/NN.png, views/NN.amplitude.png,
/// maps/NN.vdb, maps/NN.txt. Until commit() it is empty, and an earlier run is unchanged. Thread
/// safety: one call at a time. Names are unchecked. Cost of the constructor: O(files); other calls
/// take constant time.
class VIEWGAIN_EXPORT RunFolder {
 public:
  /// Throws Error(io), and Error(invalid_argument) if the folder holds files of these names but
  /// neither run.json nor checkpoint.json of an earlier run. If `resume` is set, continues the
  /// files of an ended process that wrote a checkpoint.
  explicit RunFolder(const std::filesystem::path& dir, bool resume = false);

  /// The folder to write to.
  [[nodiscard]] std::filesystem::path file(const char* name) const { return staged_.path() / name; }
  /// Path of the file of view `index` with this ending; creates the folder views/.
  [[nodiscard]] std::filesystem::path view(std::size_t index, const char* ending) const;
  /// Path of the map after view `index` or, with the ending .txt, of the candidates for the next
  /// view. Creates the folder maps/.
  [[nodiscard]] std::filesystem::path map(std::size_t index, const char* ending = ".vdb") const;

  /// The checkpoint that existed before this run wrote one, from the resumed folder or the folder
  /// itself; empty if there is none.
  [[nodiscard]] std::filesystem::path last_checkpoint() const;
  /// Replaces the checkpoint. Throws Error(io).
  void write_checkpoint(const std::string& text);
  /// Keeps the files for a resumed run if commit() is not called.
  void keep() noexcept { staged_.keep(); }

  /// Replaces an earlier run with this run. Keeps the checkpoint only if the run `goes_on` later.
  /// Throws Error(io).
  void commit(bool goes_on = false);

 private:
  std::filesystem::path dir_;
  std::vector<std::filesystem::path> earlier_;
  StagedFolder staged_;
};

}  // namespace viewgain
