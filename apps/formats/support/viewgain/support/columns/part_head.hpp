// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/support/columns/table.hpp"

namespace viewgain {

/// Rows [begin, end).
struct RowRange {
  std::uint64_t begin = 0, end = 0;
  bool operator==(const RowRange&) const = default;
};
[[nodiscard]] VIEWGAIN_EXPORT std::string text_of(const RowRange& rows);  ///< "10:20"

/// What a file of gains says of itself, in lines that begin with #: before a CSV file's columns,
/// behind a .npy file's rows, where numpy does not look. Files of one job agree in all but the
/// last two.
struct PartHead {
  std::string version;       ///< of viewgain
  std::string map;           ///< BeliefGrid::content_hash()
  std::string sensor;        ///< name and hash of all that it says
  std::string settings;      ///< one JSON object on a line
  std::string isa;           ///< that scored
  std::uint64_t poses = 0;   ///< of the job
  std::string poses_hash;    ///< see PoseSource::hash
  RowRange rows;             ///< of the job's that this file is about
  std::uint64_t scored = 0;  ///< rows in the file: those that were not dropped
  bool is_best = false;      ///< the best only, best first: no part
};

/// The lines.
[[nodiscard]] VIEWGAIN_EXPORT std::string head_text(const PartHead& head);

/// Reads them, and nothing else. Throws Error(format) that names the file, its line and what is
/// wrong there.
[[nodiscard]] VIEWGAIN_EXPORT PartHead parse_head(const std::string& file, std::string_view text);

/// Why two files are not of one job: "map 12ab, not 34cd as in a.csv"; empty if they are.
[[nodiscard]] VIEWGAIN_EXPORT std::string difference(const PartHead& head, const PartHead& first,
                                                     const std::string& first_file);

}  // namespace viewgain
