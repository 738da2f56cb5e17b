// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/columns/part_head.hpp"
#include "viewgain/support/columns/table.hpp"

namespace viewgain {

/// Rows as CSV, without a head.
VIEWGAIN_EXPORT void append_csv(std::string& csv, const std::vector<Column>& columns,
                                std::string_view rows);
/// "index,gain,...\n"
[[nodiscard]] VIEWGAIN_EXPORT std::string csv_columns(const std::vector<Column>& columns);

/// Writes a file of gains, CSV or by its ending .npy; it appears whole or not at all. Throws
/// Error(io) that names it.
class VIEWGAIN_EXPORT PartWriter {
 public:
  /// `head.scored` rows will follow. A CSV file without a head holds the columns alone.
  PartWriter(const std::filesystem::path& path, const std::vector<Column>& columns,
             const std::optional<PartHead>& head);

  /// Any number of whole rows, as a Table has them.
  void add(std::string_view rows);
  /// Makes the file appear. To be called once.
  void commit();

 private:
  AtomicFile file_;
  std::vector<Column> columns_;
  std::string tail_;    // of a .npy
  std::string buffer_;  // not written yet
  bool is_npy_;
};

/// All at once. A .npy needs a head.
VIEWGAIN_EXPORT void write_table(const std::filesystem::path& path, const Table& table,
                                 const std::optional<PartHead>& head);

}  // namespace viewgain
