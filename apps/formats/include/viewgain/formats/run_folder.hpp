// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/formats/staged_folder.hpp"

namespace viewgain {

/// The files of `dir` whose names `reconstruct` writes, relative to it, in any order; none if there
/// is no such folder. Costs O(files).
[[nodiscard]] VIEWGAIN_EXPORT std::vector<std::filesystem::path> run_files(
    const std::filesystem::path& dir);

/// What a run has decided, until it is done, for one that goes on: the first of its files to be
/// there.
inline constexpr const char* kCheckpoint = "checkpoint.json";

/// The folder that `reconstruct` leaves: run.json, config.toml, views.txt, next.txt, map.vdb,
/// surface.ply, points.ply, report.html, views/NN.png, views/NN.amplitude.png, maps/NN.vdb. Nothing
/// is in it, and an earlier run is as it was, until commit(). Thread safety: one call at a time.
/// Members that throw say so: names are not checked. Cost of the constructor: O(files); calls that
/// name a file take constant time.
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
  /// The map after view `index`; makes the folder maps/.
  [[nodiscard]] std::filesystem::path map(std::size_t index) const;

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
