// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <string_view>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// What stands in for a file or a folder while it is written, in the same folder:
/// PREFIX PROCESS-COUNTER ENDING. PREFIX is ".NAME.tmp-". If that makes a name longer than the file
/// system allows, a hash of the target's name takes the place of NAME, and a long ending is left
/// out. A target always has the same prefix and ending. Thread safe.
class VIEWGAIN_EXPORT TemporaryNames {
 public:
  /// For a file: NAME is its name without the ending.
  [[nodiscard]] static TemporaryNames of_file(const std::filesystem::path& target);
  /// For a folder: NAME is its whole name, and there is no ending.
  [[nodiscard]] static TemporaryNames of_folder(const std::filesystem::path& target);

  /// A path beside the target that this process has not named before.
  [[nodiscard]] std::filesystem::path next() const;
  /// The process that has made the file or folder of this name; 0 if the name is not of this form.
  [[nodiscard]] pid_t writer_of(std::string_view name) const;

 private:
  TemporaryNames(const std::filesystem::path& target, std::string stem, std::string ending);

  std::filesystem::path folder_;
  std::string prefix_, ending_;
};

}  // namespace viewgain
