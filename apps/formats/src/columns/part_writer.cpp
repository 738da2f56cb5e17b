// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/columns/part_writer.hpp"

#include <cstdint>

#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/columns/npy_header.hpp"
#include "viewgain/support/columns/part_reader.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

constexpr std::size_t kRowsAtOnce = std::size_t{1} << 20U;

}  // namespace

void append_csv(std::string& csv, const std::vector<Column>& columns, std::string_view rows) {
  const char* at = rows.data();
  const char* const end = at + rows.size();
  while (at != end) {
    for (const Column& column : columns) {
      if (&column != columns.data()) csv += ',';
      if (column.type == ColumnType::row) {
        csv += std::to_string(value_at<std::int64_t>(at));
      } else if (column.type == ColumnType::real) {
        csv += exact_text(value_at<double>(at));
      } else if (column.type == ColumnType::count) {
        csv += std::to_string(value_at<std::uint32_t>(at));
      } else {
        csv += view_status_name(static_cast<ViewStatus>(*at));
      }
      at += size_of(column.type);
    }
    csv += '\n';
  }
}

std::string csv_columns(const std::vector<Column>& columns) {
  std::string line;
  for (const Column& column : columns) line += (line.empty() ? "" : ",") + column.name;
  return line + "\n";
}

PartWriter::PartWriter(const std::filesystem::path& path, const std::vector<Column>& columns,
                       const std::optional<PartHead>& head)
    : file_(path), columns_(columns), is_npy_(is_npy(path)) {
  const std::string lines = head ? head_text(*head) : std::string();
  if (is_npy_) {
    buffer_ = npy_header(columns_, head ? head->scored : 0);
    tail_ = lines;
  } else {
    buffer_ = lines + csv_columns(columns_);
  }
}

void PartWriter::add(std::string_view rows) {
  if (is_npy_) {
    buffer_ += rows;
  } else {
    append_csv(buffer_, columns_, rows);
  }
  if (buffer_.size() < kRowsAtOnce) return;
  file_.write(buffer_);
  buffer_.clear();
}

void PartWriter::commit() {
  file_.write(buffer_ + tail_);
  file_.commit();
}

void write_table(const std::filesystem::path& path, const Table& table,
                 const std::optional<PartHead>& head) {
  PartWriter writer(path, table.columns, head);
  writer.add(table.bytes);
  writer.commit();
}

}  // namespace viewgain
