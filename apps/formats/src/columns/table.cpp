// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/columns/table.hpp"

#include "viewgain/formats/file_names.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

const char* npy_type(ColumnType type) {
  switch (type) {
    case ColumnType::row:
      return "<i8";
    case ColumnType::real:
      return "<f8";
    case ColumnType::count:
      return "<u4";
    case ColumnType::status:
      return "|u1";
  }
  return "";
}

std::string npy_text(const Table& table) {
  std::string text = "{'descr': [";
  for (const Column& column : table.columns) {
    text.append("('").append(column.name).append("', '").append(npy_type(column.type));
    text += "'), ";
  }
  text += "], 'fortran_order': False, 'shape': (" + std::to_string(table.size()) + ",), }";
  constexpr std::size_t kFixed = 10, kAligned = 64;  // as numpy has it
  text.append((kAligned - (kFixed + text.size() + 1) % kAligned) % kAligned, ' ').append("\n");
  std::string file("\x93NUMPY\x01\0", 8);
  file += {static_cast<char>(text.size() & 255U), static_cast<char>(text.size() >> 8U)};
  return file + text + table.bytes;
}

std::string csv_text(const Table& table) {
  std::string csv;
  for (const Column& column : table.columns) csv += (csv.empty() ? "" : ",") + column.name;
  csv += '\n';
  const char* at = table.bytes.data();
  for (std::size_t row = 0; row < table.size(); ++row) {
    for (const Column& column : table.columns) {
      if (&column != table.columns.data()) csv += ',';
      if (column.type == ColumnType::row) {
        csv += std::to_string(value_at<std::int64_t>(at));
      } else if (column.type == ColumnType::real) {
        csv += exact_text(value_at<double>(at));
      } else if (column.type == ColumnType::count) {
        csv += std::to_string(value_at<std::uint32_t>(at));
      } else {
        csv += view_status_name(static_cast<ViewGain::Status>(*at));
      }
      at += size_of(column.type);
    }
    csv += '\n';
  }
  return csv;
}

}  // namespace

bool is_npy(const std::filesystem::path& path) { return small_ending(path) == ".npy"; }

void write_table(const std::filesystem::path& path, const Table& table) {
  write_file_atomically(path, is_npy(path) ? npy_text(table) : csv_text(table));
}

}  // namespace viewgain
