// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <stop_token>

#include "program/cli/json.hpp"
#include "program/commands/study/spec.hpp"
#include "program/commands/study/study_run.hpp"

namespace viewgain::app {

/// How far a study is.
struct StudyProgress {
  std::size_t done = 0;           ///< runs that are there, whoever made them
  std::size_t made = 0;           ///< of these by this call
  const StudyRun* run = nullptr;  ///< the one just made; null at the start
  double seconds = 0;             ///< that it took
};

/// The runs of a study in a folder: DIR/runs/HASH/run.json and, where the spec asks for them,
/// candidates.txt; run.json last, so that a run that is there is whole.
class StudyFolder {
 public:
  /// Makes the folders that are missing. Throws Error(io).
  explicit StudyFolder(const std::filesystem::path& dir);

  [[nodiscard]] bool has(const StudyRun& run) const;
  /// run.json. Throws Error(format) that names the file if it is not that of this run.
  [[nodiscard]] Json read(const StudyRun& run) const;
  void write(const StudyRun& run, const StudyResult& result) const;
  [[nodiscard]] std::filesystem::path runs() const { return dir_ / "runs"; }
  [[nodiscard]] std::filesystem::path file(const StudyRun& run, const char* name) const;

 private:
  std::filesystem::path dir_;
};

/// Makes the runs that are not there yet, `jobs` at once, each on `threads` threads, together with
/// whoever else works in the same folder; returns when all are there or a stop is requested.
/// Whether all are there. `on_progress` is called at the start and after each run, by one thread at
/// a time. Throws the first Error of a run, when those under way have ended.
bool make_runs(const StudySpec& spec, const StudyFolder& folder, std::size_t jobs, int threads,
               const std::stop_token& stop,
               const std::function<void(const StudyProgress&)>& on_progress);

}  // namespace viewgain::app
