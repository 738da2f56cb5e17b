// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/columns/table.hpp"

namespace viewgain {

/// Rows [begin, end).
struct RowRange {
  std::uint64_t begin = 0, end = 0;
  bool operator==(const RowRange&) const = default;
};
[[nodiscard]] VIEWGAIN_EXPORT std::string text_of(const RowRange& rows);  ///< "10:20"

/// A column of gains, whose name says what it holds.
[[nodiscard]] VIEWGAIN_EXPORT Column column_of(const std::string& name);

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

/// What merging came to.
struct Merged {
  PartHead head;  ///< of the result
  Table best;     ///< the best rows, best first
};

/// Puts the parts of a job together in `out`: all rows in order, or, with `top`, the best so many,
/// best first. By the gain that stands first, ties to the lower row, NaN last. Memory for
/// `shown` or `top` rows and a line a part; reads each part once.
///
/// Throws Error(invalid_argument) that names the files if they are not parts of one job (another
/// map, sensor, set of settings, version, ISA, set of poses, other columns), if rows are missing or
/// in two of them; Error(io) and Error(format) as PartReader, also for one that is cut off. The
/// result appears whole or not at all. `progress`: rows done, of all.
[[nodiscard]] VIEWGAIN_EXPORT Merged
merge_parts(const std::vector<std::filesystem::path>& parts, const std::filesystem::path& out,
            std::optional<std::size_t> top, std::size_t shown,
            const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace viewgain
