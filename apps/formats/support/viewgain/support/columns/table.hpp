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

/// Types of columns, little endian in .npy files.
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

/// Rows one after the other, and values of a row without gaps, as in a .npy file.
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

/// Writes CSV with a line of column names and one line per row, or for the ending .npy a file for
/// np.load(). Atomic. Throws Error(io) that names the file, and Error(invalid_argument) for a name
/// that ends neither in .csv nor in .npy.
VIEWGAIN_EXPORT void write_table(const std::filesystem::path& path, const Table& table);

/// Whether the name ends in .npy, in lower or upper case.
[[nodiscard]] VIEWGAIN_EXPORT bool is_npy(const std::filesystem::path& path);

/// A value of a row.
template <typename Value>
[[nodiscard]] Value value_at(const char* bytes) {
  Value value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

/// Poses of a .npy file: rows with kPoseColumns and optionally kTimeColumn ("<f8" or "<f4"; other
/// columns are ignored), or matrices (n, 4, 4) of either type, in C or Fortran order. Repairs
/// rotations like read_tum() and read_pose_matrix(). Without times the timestamps are 0, 1, 2, ...
/// Throws Error(io), or Error(format) that names the file and, for a pose, the row.
[[nodiscard]] VIEWGAIN_EXPORT PoseList read_npy_poses(const std::filesystem::path& path);

}  // namespace viewgain
