// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/support/columns/part_head.hpp"
#include "viewgain/support/columns/table.hpp"

namespace viewgain {

/// Whether a file of gains is one of columns (.npy, capitals too) rather than CSV.
[[nodiscard]] VIEWGAIN_EXPORT bool is_npy(const std::filesystem::path& path);

/// A file of gains, row by row, of any length in 1 MiB of memory. All functions throw Error(io) or
/// Error(format) that names the file, and in CSV the line.
class VIEWGAIN_EXPORT PartReader {
 public:
  /// Reads what the file says of itself.
  explicit PartReader(const std::filesystem::path& path);

  [[nodiscard]] const PartHead& head() const { return head_; }
  [[nodiscard]] const std::vector<Column>& columns() const { return columns_; }

  /// The next row as a Table has it, until the next call; null behind the last. A part's numbers
  /// rise within its rows. What is cut off, or has more rows than it says, throws.
  [[nodiscard]] const char* next();

 private:
  [[noreturn]] void fail(const std::string& what) const;
  void open_npy();
  void open_csv();
  [[nodiscard]] bool fill();  // more bytes into the buffer; false at the end
  [[nodiscard]] bool next_line(std::string_view& line);
  void parse_row(std::string_view line);
  void check_row();

  std::string name_;
  std::ifstream in_;
  bool is_npy_;
  PartHead head_;
  std::vector<Column> columns_;
  std::size_t row_bytes_ = 0;
  std::string buffer_;
  std::size_t at_ = 0;  // in the buffer
  std::size_t line_ = 0;
  std::uint64_t read_ = 0;  // rows
  std::int64_t last_ = -1;  // row's number
  Table row_;
};

}  // namespace viewgain
