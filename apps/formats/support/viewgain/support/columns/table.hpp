// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <type_traits>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/core/pose_io.hpp"

namespace viewgain {

static_assert(std::endian::native == std::endian::little,
              "columns are written in native byte order");

/// What a column holds, little endian in .npy files.
enum class ColumnType : std::uint8_t {
  row,     ///< a row's number: int64, "<i8"
  real,    ///< double, "<f8"
  count,   ///< uint32, "<u4"
  status,  ///< a ViewGain::Status: uint8, "|u1"; its name in CSV
};

struct Column {
  std::string name;
  ColumnType type = ColumnType::real;
  bool operator==(const Column&) const = default;
};

/// [bytes]
[[nodiscard]] constexpr std::size_t size_of(ColumnType type) {
  if (type == ColumnType::status) return 1;
  return type == ColumnType::count ? 4 : 8;
}
[[nodiscard]] inline std::size_t row_bytes(const std::vector<Column>& columns) {
  std::size_t bytes = 0;
  for (const Column& column : columns) bytes += size_of(column.type);
  return bytes;
}

/// Rows one after the other, each column's value after the other, nothing between: as in a .npy.
struct Table {
  std::vector<Column> columns;
  std::string bytes{};

  /// Appends the next value of a row; its type must have the size of the column's.
  template <typename Value>
  void add(Value value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    const auto* first = reinterpret_cast<const char*>(&value);
    bytes.append(first, sizeof value);
  }
  [[nodiscard]] std::size_t size() const { return bytes.size() / row_bytes(columns); }
};

/// Writes a file with a line of the columns' names and one a row, or one that np.load() reads, by
/// the ending .npy; it appears whole or not at all. Throws Error(io) that names it, and
/// Error(invalid_argument) for a name that ends neither in .csv nor in .npy.
VIEWGAIN_EXPORT void write_table(const std::filesystem::path& path, const Table& table);

/// Whether a file is one of columns (.npy, capitals too) rather than text.
[[nodiscard]] VIEWGAIN_EXPORT bool is_npy(const std::filesystem::path& path);

/// A value of a row.
template <typename Value>
[[nodiscard]] Value value_at(const char* bytes) {
  Value value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

/// Poses of a .npy file: rows with kPoseColumns and perhaps kTimeColumn ("<f8" or "<f4", others are
/// passed over), or matrices (n, 4, 4) of either, in C's or Fortran's order. Mended as read_tum()
/// and read_pose_matrix() do; without times the timestamps are 0, 1, 2, ... Throws
/// Error(io), or Error(format) that names the file and, of a pose, the row.
[[nodiscard]] VIEWGAIN_EXPORT PoseList read_npy_poses(const std::filesystem::path& path);

}  // namespace viewgain
