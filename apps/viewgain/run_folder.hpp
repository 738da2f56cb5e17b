// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace viewgain::app {

/// The folder that `reconstruct` leaves: run.json, views.txt, map.vdb, surface.ply, points.ply,
/// views/NN.png, views/NN.amplitude.png, maps/NN.vdb.
class RunFolder {
 public:
  /// Creates the folder, or takes an existing one as it is. Throws Error(io).
  explicit RunFolder(const std::filesystem::path& dir);
  /// Unless keep() was called, removes what this run has made.
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  /// Removes an earlier run's files, once this run is known to have something to say. Does nothing
  /// the second time.
  void begin();

  [[nodiscard]] std::filesystem::path file(const char* name) const { return dir_ / name; }
  [[nodiscard]] std::filesystem::path view(std::size_t index, const char* ending) const;
  [[nodiscard]] std::filesystem::path map(std::size_t index) const;
  void keep() noexcept { kept_ = true; }

 private:
  void remove_run_files() const;

  std::filesystem::path dir_;
  std::filesystem::path created_parent_;  // topmost folder made for this; empty: none
  bool begun_ = false;
  bool kept_ = false;
};

}  // namespace viewgain::app
