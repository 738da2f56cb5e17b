// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>

namespace viewgain::app {

/// Who works on which piece of a study, among the threads, processes and machines that share its
/// folder: a claim is a file that only one can create. Its owner touches it every few seconds while
/// it lives. One that was not touched for a minute, or whose process on this machine is gone, may
/// be taken over. Two owners of one piece, which a stalled file system can bring about, do the same
/// work and leave the same results.
///
/// Thread safety: all members from any thread.
class Claims {
 public:
  /// The folder must be there.
  explicit Claims(std::filesystem::path folder);
  /// Gives back what is still claimed.
  ~Claims();
  Claims(const Claims&) = delete;
  Claims& operator=(const Claims&) = delete;

  /// Whether the piece is this object's now. Throws Error(io) if the folder cannot be written.
  [[nodiscard]] bool take(const std::string& piece);
  void give_back(const std::string& piece);
  /// Removes the claim of a piece that is done, where its owner was killed before giving it back.
  void clear_abandoned(const std::string& piece);

 private:
  [[nodiscard]] std::filesystem::path file_of(const std::string& piece) const;
  [[nodiscard]] bool is_abandoned(const std::filesystem::path& file) const;
  [[nodiscard]] bool is_old(const std::filesystem::path& file) const;
  [[nodiscard]] bool remove_abandoned(const std::filesystem::path& claim) const;
  void touch_all();

  std::filesystem::path folder_;
  std::string owner_;  // what a claim holds: machine, its start, process
  std::mutex mutex_;
  std::set<std::string> taken_;
  std::jthread toucher_;
};

}  // namespace viewgain::app
