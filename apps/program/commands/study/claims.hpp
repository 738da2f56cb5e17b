// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <utility>

namespace viewgain::app {

/// Who works on which piece of a study, among the threads, processes and machines that share its
/// folder: a claim is the lock of a file, which ends with its owner, however that ends. Two owners
/// of one piece, as on a file system without locks, do the same work and leave the same results.
///
/// Thread safety: all members from any thread.
class Claims {
 public:
  /// The folder must be there.
  explicit Claims(std::filesystem::path folder) : folder_(std::move(folder)) {}
  /// Gives back what is still claimed.
  ~Claims();
  Claims(const Claims&) = delete;
  Claims& operator=(const Claims&) = delete;

  /// Whether the piece is this object's now. Throws Error(io) if the folder cannot be written.
  [[nodiscard]] bool take(const std::string& piece);
  void give_back(const std::string& piece);
  /// Removes the file of a piece that is done, where its owner was killed before giving it back.
  void clear_abandoned(const std::string& piece);

 private:
  [[nodiscard]] std::filesystem::path file_of(const std::string& piece) const {
    return folder_ / (piece + ".claim");
  }

  std::filesystem::path folder_;
  std::mutex mutex_;
  std::map<std::string, int> taken_;  // open files
};

}  // namespace viewgain::app
