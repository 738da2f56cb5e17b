// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/columns/npy_header.hpp"

#include <cctype>
#include <charconv>

#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::size_t kMostHeader = std::size_t{1} << 20U;  // [bytes]
constexpr std::size_t kMostRowBytes = std::size_t{1} << 20U;
constexpr std::uint64_t kMostRows = std::uint64_t{1} << 40U;  // their bytes do not overflow

// A Python literal of the few kinds that a header has: {'descr': ..., 'fortran_order': False,
// 'shape': (3,), }.
class HeaderText {
 public:
  HeaderText(const std::string& file, std::string_view text) : file_(file), rest_(text) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::format, file_ + ": .npy header: " + what);
  }
  bool takes(char c) {
    blanks();
    if (rest_.empty() || rest_.front() != c) return false;
    rest_.remove_prefix(1);
    return true;
  }
  void expect(char c) {
    if (!takes(c)) fail(std::string("expected ") + c);
  }
  [[nodiscard]] bool is_next(char c) {
    blanks();
    return !rest_.empty() && rest_.front() == c;
  }
  std::string text() {
    const char quote = is_next('"') ? '"' : '\'';
    expect(quote);
    const std::size_t end = rest_.find(quote);
    if (end == std::string_view::npos) fail("a text does not end");
    std::string found(rest_.substr(0, end));
    if (found.find('\\') != std::string::npos) fail("a name has a backslash");
    rest_.remove_prefix(end + 1);
    return found;
  }
  bool truth() {
    blanks();
    for (const bool value : {true, false}) {
      const std::string_view word = value ? "True" : "False";
      if (!rest_.starts_with(word)) continue;
      rest_.remove_prefix(word.size());
      return value;
    }
    fail("expected True or False");
  }
  std::vector<std::uint64_t> counts() {
    expect('(');
    std::vector<std::uint64_t> found;
    while (!takes(')')) {
      blanks();
      std::uint64_t value = 0;
      const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
      if (error != std::errc() || value > kMostRows) fail("expected a count");
      rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
      found.push_back(value);
      if (!takes(',') && !is_next(')')) fail("expected , or )");
    }
    return found;
  }

 private:
  void blanks() {
    while (!rest_.empty() && std::isspace(static_cast<unsigned char>(rest_.front())) != 0) {
      rest_.remove_prefix(1);
    }
  }
  const std::string& file_;
  std::string_view rest_;
};

std::size_t bytes_of(const HeaderText& text, const std::string& type) {
  std::size_t bytes = 0;
  const char* const end = type.data() + type.size();
  const bool is_big = type.starts_with('>');
  if (type.size() < 3 || is_big || std::from_chars(type.data() + 2, end, bytes).ptr != end ||
      bytes == 0 || bytes > 1U << 16U) {
    text.fail("the type " + type + " is not read here");
  }
  constexpr std::size_t kCharacter = 4;  // numpy counts a text's characters, UCS4
  return type[1] == 'U' ? kCharacter * bytes : bytes;
}

void add_field(HeaderText& text, NpyHeader& header, std::string name, std::string type,
               const std::vector<std::uint64_t>& shape) {
  std::size_t items = 1;
  for (const std::uint64_t n : shape) {
    items *= n;
    if (n > 4096 || items > 4096) text.fail("the field " + name + " is too large");
  }
  const std::size_t bytes = bytes_of(text, type) * items;
  header.fields.push_back({std::move(name), std::move(type), items, header.row_bytes});
  header.row_bytes += bytes;
  if (header.row_bytes > kMostRowBytes) text.fail("the rows are too long");
}

void read_type(HeaderText& text, NpyHeader& header) {
  if (!text.takes('[')) {
    add_field(text, header, "", text.text(), {});
    return;
  }
  while (!text.takes(']')) {
    text.expect('(');
    std::string name = text.text();
    text.expect(',');
    if (text.is_next('[')) text.fail("a field of fields is not read here");
    std::string type = text.text();
    std::vector<std::uint64_t> shape;
    if (text.takes(',') && !text.is_next(')')) shape = text.counts();
    text.expect(')');
    add_field(text, header, std::move(name), std::move(type), shape);
    if (!text.takes(',') && !text.is_next(']')) text.fail("expected , or ]");
  }
}

std::size_t byte_at(std::string_view bytes, std::size_t i) {
  return static_cast<unsigned char>(bytes[i]);
}

}  // namespace

std::size_t npy_header_bytes(const std::string& file, std::string_view head) {
  if (head.size() < 12 || !head.starts_with(kMagic)) {
    throw Error(ErrorCode::format, file + ": is no .npy file");
  }
  const std::size_t version = byte_at(head, 6);
  const std::size_t fixed = version == 1 ? 10 : 12;
  std::size_t length = byte_at(head, 8) | byte_at(head, 9) << 8U;
  if (version > 1) length |= byte_at(head, 10) << 16U | byte_at(head, 11) << 24U;
  if (version < 1 || version > 3 || length > kMostHeader) {
    throw Error(ErrorCode::format, file + ": .npy header: version or length is not read here");
  }
  return fixed + length;
}

NpyHeader parse_npy_header(const std::string& file, std::string_view bytes) {
  const std::size_t end = npy_header_bytes(file, bytes);
  if (bytes.size() < end) throw Error(ErrorCode::format, file + ": is cut off in its header");
  const std::size_t fixed = byte_at(bytes, 6) == 1 ? 10 : 12;
  HeaderText text(file, bytes.substr(fixed, end - fixed));
  NpyHeader header;
  header.data_offset = end;
  unsigned seen = 0;
  text.expect('{');
  while (!text.takes('}')) {
    const std::string key = text.text();
    text.expect(':');
    if (key == "descr") {
      read_type(text, header);
      seen |= 1U;
    } else if (key == "fortran_order") {
      header.is_fortran = text.truth();
      seen |= 2U;
    } else if (key == "shape") {
      header.shape = text.counts();
      seen |= 4U;
    } else {
      text.fail("the key " + key + " is not known");
    }
    if (!text.takes(',') && !text.is_next('}')) text.fail("expected , or }");
  }
  if (seen != 7U || header.row_bytes == 0) text.fail("descr, fortran_order or shape is missing");
  return header;
}

std::string npy_header(const std::vector<Column>& columns, std::uint64_t rows) {
  std::string text = "{'descr': [";
  for (const Column& column : columns) {
    text.append(&column == columns.data() ? "('" : ", ('").append(column.name).append("', '");
    text.append(npy_type(column.type)).append("')");
  }
  text.append("], 'fortran_order': False, 'shape': (").append(std::to_string(rows)).append(",), }");
  constexpr std::size_t kFixed = 10, kAligned = 64;  // as numpy has it
  text.append((kAligned - (kFixed + text.size() + 1) % kAligned) % kAligned, ' ').append("\n");
  std::string header(kMagic);
  header.append(
      {'\x01', '\0', static_cast<char>(text.size() & 255U), static_cast<char>(text.size() >> 8U)});
  return header + text;
}

}  // namespace viewgain
