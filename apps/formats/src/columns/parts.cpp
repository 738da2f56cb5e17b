// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/columns/parts.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>
#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/formats/file_names.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/columns/npy_header.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

// The lines before rows and scored: a format that grows when its reader would err, key and text.
constexpr std::uint64_t kPartFormat = 1;
constexpr std::array<std::pair<const char*, std::string PartHead::*>, 5> kTexts{
    {{"viewgain", &PartHead::version},
     {"map", &PartHead::map},
     {"sensor", &PartHead::sensor},
     {"settings", &PartHead::settings},
     {"isa", &PartHead::isa}}};

std::string poses_text(const PartHead& head) {
  return std::to_string(head.poses) + " " + head.poses_hash;
}

class HeadReader {
 public:
  HeadReader(const std::string& file, std::string_view rest) : file_(file), rest_(rest) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::format, file_ + ": line " + std::to_string(line_) + " of #: " + what);
  }
  // What stands behind "# key ".
  std::string_view value(const std::string& key) {
    ++line_;
    const std::string start = "# " + key + " ";
    const std::size_t end = rest_.find('\n');
    if (end == std::string_view::npos || !rest_.starts_with(start)) {
      fail("expected \"" + start + "...\"");
    }
    const std::string_view found = rest_.substr(start.size(), end - start.size());
    rest_.remove_prefix(end + 1);
    if (found.empty()) fail(key + " is empty");
    return found;
  }
  [[nodiscard]] std::uint64_t count(std::string_view word) const {
    std::uint64_t value = 0;
    const char* const end = word.data() + word.size();
    if (std::from_chars(word.data(), end, value).ptr != end || word.empty()) {
      fail(quoted(word) + " is no count");
    }
    return value;
  }
  // A word and what stands behind its separator.
  [[nodiscard]] std::pair<std::string_view, std::string_view> cut(std::string_view text,
                                                                  char separator) const {
    const std::size_t at = text.find(separator);
    if (at == std::string_view::npos) fail(quoted(text) + " lacks a " + quoted({&separator, 1}));
    return {text.substr(0, at), text.substr(at + 1)};
  }
  [[nodiscard]] bool has(std::string_view start) const { return rest_.starts_with(start); }
  void end() const {
    if (!rest_.empty()) fail("more lines follow");
  }

 private:
  const std::string& file_;
  std::string_view rest_;
  std::size_t line_ = 0;
};

}  // namespace

Column column_of(const std::string& name) {
  constexpr std::array<std::string_view, 4> kCounts{"rays", "hits", "unknown_voxels",
                                                    "occupied_voxels"};
  if (name == "index") return {name, ColumnType::row};
  if (name == "status") return {name, ColumnType::status};
  const bool counts = std::find(kCounts.begin(), kCounts.end(), name) != kCounts.end();
  return {name, counts ? ColumnType::count : ColumnType::real};
}

std::string text_of(const RowRange& rows) {
  return std::to_string(rows.begin) + ":" + std::to_string(rows.end);
}

std::string head_text(const PartHead& head) {
  std::string text = "# format " + std::to_string(kPartFormat) + "\n";
  for (const auto& [key, member] : kTexts) {
    text.append("# ").append(key).append(" ").append(head.*member).append("\n");
  }
  text.append("# poses ").append(poses_text(head)).append("\n# rows ").append(text_of(head.rows));
  text.append(head.is_best ? "\n# best " : "\n# scored ").append(std::to_string(head.scored));
  return text + "\n";
}

PartHead parse_head(const std::string& file, std::string_view text) {
  HeadReader reader(file, text);
  PartHead head;
  if (const std::uint64_t format = reader.count(reader.value("format")); format > kPartFormat) {
    reader.fail("format " + std::to_string(format) + "; this library reads up to format " +
                std::to_string(kPartFormat));
  }
  for (const auto& [key, member] : kTexts) head.*member = reader.value(key);
  const auto [poses, hash] = reader.cut(reader.value("poses"), ' ');
  head.poses = reader.count(poses);
  head.poses_hash = hash;
  const auto [begin, end] = reader.cut(reader.value("rows"), ':');
  head.rows = {reader.count(begin), reader.count(end)};
  if (head.rows.begin > head.rows.end || head.rows.end > head.poses) {
    reader.fail("rows " + text_of(head.rows) + " of " + std::to_string(head.poses));
  }
  head.is_best = reader.has("# best ");
  head.scored = reader.count(reader.value(head.is_best ? "best" : "scored"));
  if (head.scored > head.rows.end - head.rows.begin) reader.fail("more were scored than rows");
  reader.end();
  return head;
}

std::string difference(const PartHead& head, const PartHead& first, const std::string& first_file) {
  const auto differ = [&](const char* key, const std::string& mine, const std::string& other) {
    return std::string(key) + " " + mine + ", not " + other + " as in " + first_file;
  };
  for (const auto& [key, member] : kTexts) {
    if (head.*member != first.*member) return differ(key, head.*member, first.*member);
  }
  if (poses_text(head) != poses_text(first)) {
    return differ("poses", poses_text(head), poses_text(first));
  }
  return "";
}

namespace {

constexpr std::size_t kBlock = std::size_t{1} << 20U;  // that is read or written at once
constexpr auto kLastStatus = static_cast<std::uint8_t>(ViewGain::Status::camera_in_occupied);
constexpr std::array kTypes{ColumnType::row, ColumnType::real, ColumnType::count,
                            ColumnType::status};

}  // namespace

bool is_npy(const std::filesystem::path& path) { return small_ending(path) == ".npy"; }

void PartReader::fail(const std::string& what) const {
  throw Error(ErrorCode::format,
              name_ + (line_ > 0 ? ":" + std::to_string(line_) : std::string()) + ": " + what);
}

PartReader::PartReader(const std::filesystem::path& path)
    : name_(path.string()), in_(path, std::ios::binary), is_npy_(is_npy(path)) {
  std::error_code failed;
  if (!in_ || !std::filesystem::is_regular_file(path, failed)) {
    throw Error(ErrorCode::io, name_ + ": cannot be read as a file");
  }
  if (is_npy_) {
    open_npy();
  } else {
    open_csv();
  }
  row_bytes_ = row_bytes(columns_);
  if (columns_.size() < 2 || columns_.front() != Column{"index", ColumnType::row} ||
      columns_[1].type != ColumnType::real) {
    fail("the columns are not those of gains: index, gain, ...");
  }
  row_.columns = columns_;
}

bool PartReader::fill() {
  buffer_.erase(0, at_);
  at_ = 0;
  const std::size_t had = buffer_.size();
  buffer_.resize(had + kBlock);
  in_.read(buffer_.data() + had, static_cast<std::streamsize>(kBlock));
  buffer_.resize(had + static_cast<std::size_t>(in_.gcount()));
  if (in_.bad()) throw Error(ErrorCode::io, name_ + ": cannot be read");
  return buffer_.size() > had;
}

void PartReader::open_npy() {
  std::string bytes(12, '\0');
  in_.read(bytes.data(), 12);
  bytes.resize(static_cast<std::size_t>(in_.gcount()));
  const std::size_t length = npy_header_bytes(name_, bytes);
  bytes.resize(length);
  if (length > 12) in_.read(bytes.data() + 12, static_cast<std::streamsize>(length - 12));
  if (!in_) fail("is cut off in its header");
  const NpyHeader header = parse_npy_header(name_, bytes);
  for (const NpyHeader::Field& field : header.fields) {
    const auto* const type = std::find_if(kTypes.begin(), kTypes.end(), [&](ColumnType known) {
      return npy_type(known) == field.type && field.items == 1;
    });
    if (type == kTypes.end())
      fail("column " + quoted(std::string_view(field.name)) + " has type " + field.type);
    columns_.push_back({field.name, *type});
  }
  if (header.shape.size() != 1) fail("is no array of rows");
  const std::uint64_t rows = header.shape[0];
  in_.seekg(0, std::ios::end);
  const auto size = static_cast<std::uint64_t>(in_.tellg());
  const std::uint64_t data_end = header.data_offset + rows * header.row_bytes;
  if (size == data_end) {
    fail("does not say which rows it has (lines of # behind its rows)");
  }
  if (size < data_end) {
    fail("is cut off: " + std::to_string(size) + " bytes, its rows alone need " +
         std::to_string(data_end));
  }
  if (size - data_end > kBlock) fail("more than lines of # stand behind its rows");
  std::string tail(size - data_end, '\0');
  in_.seekg(static_cast<std::streamoff>(data_end));
  in_.read(tail.data(), static_cast<std::streamsize>(tail.size()));
  if (!in_) throw Error(ErrorCode::io, name_ + ": cannot be read");
  head_ = parse_head(name_, tail);
  if (head_.scored != rows) {
    fail("has " + std::to_string(rows) + " rows, but says " + std::to_string(head_.scored));
  }
  in_.seekg(static_cast<std::streamoff>(header.data_offset));
}

void PartReader::open_csv() {
  std::string text;
  std::string_view line;
  while (true) {
    if (!next_line(line)) fail("has no line of columns; is it cut off?");
    if (!line.starts_with('#')) break;
    text.append(line).append("\n");
    if (text.size() > kBlock) fail("too many lines of #");
  }
  if (text.empty()) fail("does not say which rows it has (lines of #)");
  const std::string names(line);
  for (std::size_t begin = 0; begin <= names.size();) {
    const std::size_t end = std::min(names.find(',', begin), names.size());
    const std::string name = names.substr(begin, end - begin);
    columns_.push_back(column_of(name));
    begin = end + 1;
  }
  head_ = parse_head(name_, text);
}

bool PartReader::next_line(std::string_view& line) {
  std::size_t looked = at_;
  std::size_t end = std::string::npos;
  while ((end = buffer_.find('\n', looked)) == std::string::npos) {
    looked = buffer_.size() - at_;  // fill() moves the rest to the front
    if (looked > kBlock) fail("a line is too long");
    if (fill()) continue;
    if (at_ < buffer_.size()) fail("is cut off within its last line");
    return false;
  }
  line = std::string_view(buffer_).substr(at_, end - at_);
  at_ = end + 1;
  ++line_;
  return true;
}

void PartReader::parse_row(std::string_view line) {
  row_.bytes.clear();
  const char* at = line.data();
  const char* const end = at + line.size();
  const auto take = [&](auto value, const Column& column) {
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc()) fail(column.name + " is no number");
    at = next;
    row_.add(value);
  };
  for (const Column& column : columns_) {
    if (&column != columns_.data() && (at == end || *at++ != ',')) fail("has too few columns");
    if (column.type == ColumnType::row) {
      take(std::int64_t{}, column);
    } else if (column.type == ColumnType::real) {
      take(double{}, column);
    } else if (column.type == ColumnType::count) {
      take(std::uint32_t{}, column);
    } else {
      const std::string_view word(at, static_cast<std::size_t>(std::find(at, end, ',') - at));
      std::uint8_t code = 0;
      while (word != view_status_name(static_cast<ViewGain::Status>(code))) {
        if (code++ == kLastStatus) {
          fail("there is no status " + quoted(word));
        }
      }
      row_.add(code);
      at += word.size();
    }
  }
  if (at != end) fail("has too many columns");
}

void PartReader::check_row() {
  const auto number = value_at<std::int64_t>(row_.bytes.data());
  for (std::size_t offset = 0; const Column& column : columns_) {
    const auto code = static_cast<std::uint8_t>(row_.bytes[offset]);
    if (column.type == ColumnType::status && code > kLastStatus) {
      fail("row " + std::to_string(number) + " has no known status: " + std::to_string(code));
    }
    offset += size_of(column.type);
  }
  const bool is_inside = number >= 0 && static_cast<std::uint64_t>(number) >= head_.rows.begin &&
                         static_cast<std::uint64_t>(number) < head_.rows.end;
  if (!is_inside || (!head_.is_best && number <= last_)) {
    fail("row " + std::to_string(number) +
         (is_inside ? " follows " + std::to_string(last_)
                    : " is not among its rows " + text_of(head_.rows)));
  }
  last_ = number;
}

const char* PartReader::next() {
  if (is_npy_) {
    if (read_ == head_.scored) return nullptr;
    while (buffer_.size() - at_ < row_bytes_) {
      if (!fill()) fail("is cut off");
    }
    row_.bytes.assign(buffer_, at_, row_bytes_);
    at_ += row_bytes_;
  } else {
    std::string_view line;
    if (!next_line(line)) {
      if (read_ == head_.scored) return nullptr;
      fail("is cut off: " + std::to_string(read_) + " rows of " + std::to_string(head_.scored));
    }
    if (read_ == head_.scored) fail("has more rows than the " + std::to_string(read_) + " it says");
    parse_row(line);
  }
  check_row();
  ++read_;
  return row_.bytes.data();
}

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
        csv += view_status_name(static_cast<ViewGain::Status>(*at));
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
  if (buffer_.size() < kBlock) return;
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
