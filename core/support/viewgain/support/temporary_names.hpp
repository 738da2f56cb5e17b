// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <string_view>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Names for a target (a file or folder) while it is written. Such a name is
/// .NAME.tmp-PROCESS-COUNTER followed by ENDING, and lies in the target's folder. PROCESS is the
/// process id. If the name would be too long for the file system, a hash of the target's name
/// replaces NAME, and a long ENDING is omitted. For one target, NAME and ENDING are always the
/// same. Thread safe.
class VIEWGAIN_EXPORT TemporaryNames {
 public:
  /// For a file. NAME is its name without the ending.
  [[nodiscard]] static TemporaryNames of_file(const std::filesystem::path& target);
  /// For a folder. NAME is its whole name, and ENDING is empty.
  [[nodiscard]] static TemporaryNames of_folder(const std::filesystem::path& target);

  /// A new path in the target's folder that this process has not used before.
  [[nodiscard]] std::filesystem::path next() const;
  /// The id of the process that made this name; 0 if the name does not have this form.
  [[nodiscard]] pid_t writer_of(std::string_view name) const;

 private:
  TemporaryNames(const std::filesystem::path& target, std::string stem, std::string ending);

  std::filesystem::path folder_;
  std::string prefix_, ending_;
};

}  // namespace viewgain
