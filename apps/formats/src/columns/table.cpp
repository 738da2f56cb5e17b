// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/columns/table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "viewgain/core/error.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/file_names.hpp"
#include "viewgain/support/pose_numbers.hpp"
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
  constexpr std::size_t kFixed = 10, kAligned = 64;  // numpy's format
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

using nlohmann::json;

constexpr std::uint64_t kMostFieldBytes = std::uint64_t{1} << 20U;

// Refuses numbers with a point or an exponent, which get() would cast.
std::uint64_t count_of(const json& number) {
  return number.get_ref<const json::number_unsigned_t&>();
}

class NpyFile {
 public:
  explicit NpyFile(const std::filesystem::path& path)
      : name_(path.string()), bytes_(file_bytes(path)) {
    try {
      read_layout();
    } catch (const json::exception&) {
      fail("the .npy header is not supported");
    }
    if (rows_ == 0) fail("the file contains no pose");
    if (rows_ > (bytes_.size() - begin_) / row_bytes_) {
      fail("the file is truncated: its header declares " + std::to_string(rows_) + " rows");
    }
  }

  [[nodiscard]] std::size_t rows() const { return rows_; }

  [[nodiscard]] Pose pose(std::size_t row, bool& mended) const {
    const auto fail_row = [&](const std::string& what) {
      fail("row " + std::to_string(row) + ": " + what);
    };
    std::vector<double> numbers;
    for (const Place& place : places_) {
      numbers.push_back(number_at(row, place));
      if (!std::isfinite(numbers.back())) fail_row("a number is not finite");
    }
    return pose_of_numbers(numbers, mended, fail_row);
  }

  // The row's number if the file has no times.
  [[nodiscard]] double time(std::size_t row) const {
    const double time = time_ ? number_at(row, *time_) : static_cast<double>(row);
    if (!std::isfinite(time)) {
      fail("row " + std::to_string(row) + ": a number is not finite");
    }
    return time;
  }

 private:
  // Position of a number in each row.
  struct Place {
    std::size_t offset;  // from the row's begin [bytes]
    bool is_single;      // float32, else float64
  };

  [[nodiscard]] double number_at(std::size_t row, const Place& place) const {
    const char* at = &bytes_[begin_ + row * step_ + place.offset];
    return place.is_single ? double{value_at<float>(at)} : value_at<double>(at);
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::format, name_ + ": " + what);
  }

  // The header is a Python dictionary, which is converted to JSON.
  [[nodiscard]] json header() {
    const auto byte = [this](std::size_t i) {
      return std::size_t{static_cast<unsigned char>(bytes_[i])};
    };
    if (bytes_.size() < 12 || !bytes_.starts_with("\x93NUMPY")) fail("the file is not a .npy file");
    const std::size_t first = byte(6) == 1 ? 10 : 12;
    begin_ = first + (byte(8) | byte(9) << 8U);
    if (byte(6) > 1) begin_ += byte(10) << 16U | byte(11) << 24U;
    if (begin_ > bytes_.size()) fail("the file is truncated within its header");
    std::string text;
    for (const char c : std::string_view(bytes_).substr(first, begin_ - first)) {
      if (c == ' ' || c == '\n') continue;
      if ((c == ')' || c == ']' || c == '}') && text.ends_with(',')) text.pop_back();
      text += c == '\'' ? '"' : c == '(' ? '[' : c == ')' ? ']' : c;
      if (text.ends_with(":True")) text.replace(text.size() - 4, 4, "true");
      if (text.ends_with(":False")) text.replace(text.size() - 5, 5, "false");
    }
    return json::parse(text);
  }

  void read_layout() {
    const json said = header();
    const json &type = said.at("descr"), &shape = said.at("shape");
    const bool is_fortran = said.at("fortran_order").get<bool>();
    rows_ = count_of(shape.at(0));
    if (type.is_array() && shape.size() == 1) {
      find_columns(type);
    } else if (is_real(type) && shape.size() == 3 && shape[1] == 4 && shape[2] == 4) {
      find_matrices(type == "<f4", is_fortran);
    } else {
      fail(
          "the array has the shape " + shape.dump() + " and the type " + type.dump() +
          "; expected the fields tx, ty, tz, qx, qy, qz, qw, or (n, 4, 4) matrices, of <f8 or <f4");
    }
  }

  [[nodiscard]] static bool is_real(const json& type) { return type == "<f8" || type == "<f4"; }

  // In Fortran order, the first numbers of all matrices come before all second numbers.
  void find_matrices(bool is_single, bool is_fortran) {
    const std::size_t size = is_single ? sizeof(float) : sizeof(double);
    row_bytes_ = 16 * size;
    if (rows_ > bytes_.size() / row_bytes_) return;  // the file is truncated
    step_ = is_fortran ? size : row_bytes_;
    for (std::size_t i = 0; i < 16; ++i) {
      places_.push_back({is_fortran ? (i / 4 + i % 4 * 4) * rows_ * size : i * size, is_single});
    }
  }

  void find_columns(const json& fields) {
    std::vector<std::string> columns;  // name and type
    std::map<std::string, Place> found;
    for (const json& field : fields) {
      const auto type = field.at(1).get<std::string>();
      columns.push_back(field.at(0).get<std::string>() + " of " + type);
      const Place place{row_bytes_, type == "<f4"};
      if (is_real(type) && field.size() == 2) found[field[0].get<std::string>()] = place;
      std::uint64_t bytes = 0;
      const char* const digits = type.data() + std::min<std::size_t>(2, type.size());
      std::from_chars(digits, type.data() + type.size(), bytes);
      bytes = std::min(bytes, kMostFieldBytes + 1);
      if (type.find('U') == 1) bytes *= 4;  // numpy counts characters
      for (const json& count : field.size() > 2 ? field[2] : json(1U)) {
        bytes *= std::min(count_of(count), kMostFieldBytes);
        if (bytes == 0 || bytes > kMostFieldBytes)
          fail("the field " + columns.back() + " is not supported");
      }
      row_bytes_ += bytes;
    }
    step_ = row_bytes_;
    for (const std::string name : kPoseColumns) {
      const auto column = found.find(name);
      if (column == found.end()) fail("the array has no field " + name + " of <f8 or <f4");
      places_.push_back(column->second);
    }
    if (const auto time = found.find(kTimeColumn); time != found.end()) time_ = time->second;
  }

  std::string name_, bytes_;
  std::size_t begin_ = 0;  // of the first row [bytes]
  std::size_t rows_ = 0, row_bytes_ = 0;
  std::size_t step_ = 0;       // from a row to the next [bytes]
  std::vector<Place> places_;  // of a pose's numbers
  std::optional<Place> time_{};
};

}  // namespace

bool is_npy(const std::filesystem::path& path) { return small_ending(path) == ".npy"; }

void write_table(const std::filesystem::path& path, const Table& table) {
  require_ending(path, "a table", {".csv", ".npy"});
  write_file_atomically(path, is_npy(path) ? npy_text(table) : csv_text(table));
}

PoseList read_npy_poses(const std::filesystem::path& path) {
  const NpyFile file(path);
  PoseList list;
  list.poses.reserve(file.rows());
  for (std::size_t row = 0; row < file.rows(); ++row) {
    bool mended = false;
    list.poses.push_back(file.pose(row, mended));
    list.timestamps.push_back(file.time(row));
    list.orthonormalized += mended ? 1 : 0;
  }
  return list;
}

}  // namespace viewgain
