// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/support/columns/table.hpp"

namespace viewgain {

/// The header of numpy's format .npy, 1.0 to 3.0.
struct NpyHeader {
  struct Field {
    std::string name;    ///< empty for padding and for the only field of a plain array
    std::string type;    ///< "<f8"
    std::size_t items;   ///< values of it in a row
    std::size_t offset;  ///< in a row [bytes]
  };
  std::vector<Field> fields;  ///< of a structured type, or one without a name
  std::vector<std::uint64_t> shape;
  bool is_fortran = false;
  std::size_t row_bytes = 0;    ///< of one element of the array
  std::size_t data_offset = 0;  ///< where the first begins in the file
};

/// How many bytes from the front hold the header; at most 1 MiB, what is longer is refused. `head`:
/// the first 12 bytes. Throws Error(format) that names the file if it is no .npy.
[[nodiscard]] VIEWGAIN_EXPORT std::size_t npy_header_bytes(const std::string& file,
                                                           std::string_view head);

/// Reads it. Throws Error(format) that names the file.
[[nodiscard]] VIEWGAIN_EXPORT NpyHeader parse_npy_header(const std::string& file,
                                                         std::string_view bytes);

/// The header of a one-dimensional array of these columns.
[[nodiscard]] VIEWGAIN_EXPORT std::string npy_header(const std::vector<Column>& columns,
                                                     std::uint64_t rows);

}  // namespace viewgain
