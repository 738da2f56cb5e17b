// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::detail {

/// Type of a number in a file.
struct ScalarType {
  enum class Kind : std::uint8_t { floating, signed_integer, unsigned_integer };
  Kind kind = Kind::floating;
  std::size_t size = 4;  ///< 1, 2, 4 or 8 bytes; for floating point 4 or 8

  /// Whether decode() supports this type.
  [[nodiscard]] bool is_known() const {
    if (size == 4 || size == 8) return true;
    return kind != Kind::floating && (size == 1 || size == 2);
  }
};

/// The number in the first `type.size` bytes. 64-bit integers are rounded to double precision.
[[nodiscard]] inline double decode(const char* bytes, ScalarType type, bool big_endian = false) {
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < type.size; ++i) {
    const auto byte = static_cast<unsigned char>(bytes[big_endian ? type.size - 1 - i : i]);
    word |= std::uint64_t{byte} << (8 * i);
  }
  if (type.kind == ScalarType::Kind::floating) {
    return type.size == 8
               ? std::bit_cast<double>(word)
               : static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(word)));
  }
  if (type.kind == ScalarType::Kind::unsigned_integer) return static_cast<double>(word);
  const unsigned unused = 64U - 8U * static_cast<unsigned>(type.size);
  return static_cast<double>(static_cast<std::int64_t>(word << unused) >> unused);
}

struct PlyProperty {
  std::string_view name;
  ScalarType type;
  std::optional<ScalarType> count;  ///< for lists: the type of the number of entries
};

struct PlyElement {
  std::string_view name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  /// Index of the property with this name that is a list or a scalar, as `is_list` says; empty if
  /// there is none.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view property, bool is_list) const {
    const auto found = std::find_if(properties.begin(), properties.end(), [&](const auto& p) {
      return p.name == property && p.count.has_value() == is_list;
    });
    if (found == properties.end()) return std::nullopt;
    return static_cast<std::size_t>(found - properties.begin());
  }
};

/// The numbers of one row of an element.
class PlyRow {
 public:
  void clear() {
    numbers_.clear();
    ends_.assign(1, 0);
  }
  void append(double value) { numbers_.push_back(value); }
  void end_property() { ends_.push_back(numbers_.size()); }

  [[nodiscard]] double scalar(std::size_t property) const { return numbers_[ends_[property]]; }
  [[nodiscard]] std::span<const double> list(std::size_t property) const {
    return std::span(numbers_).subspan(ends_[property], ends_[property + 1] - ends_[property]);
  }

 private:
  std::vector<double> numbers_;
  std::vector<std::size_t> ends_;
};

/// Reads the numbers of an ASCII file one by one. A row is one line or several whole lines.
class PlyAsciiNumbers {
 public:
  explicit PlyAsciiNumbers(LineReader& line) : line_(line) {}

  void begin_row() {
    next_line();
    first_line_ = line_.line();
    numbers_ = 0;
  }
  double next(ScalarType type) {
    if (word_ == line_.words().size()) next_line();
    const double value = line_.number(word_);
    if (type.kind != ScalarType::Kind::floating && value != std::floor(value)) {
      line_.fail(quoted(line_.words()[word_]) + " is not a whole number");
    }
    ++word_;
    ++numbers_;
    return value;
  }
  void require(double count, ScalarType) const {
    // A number has at least one character, and a separator follows all numbers except the last.
    const std::size_t most = line_.words().size() - word_ + line_.rest().size() / 2 + 1;
    if (count > static_cast<double>(most)) line_.fail("a list is longer than the rest of the file");
  }
  void end_row() const {
    if (word_ == line_.words().size()) return;
    const bool is_broken = first_line_ != line_.line();
    throw Error(ErrorCode::format,
                line_.name() + ":" + std::to_string(first_line_) + ": the header declares " +
                    std::to_string(numbers_) + " numbers per element, but " +
                    (is_broken ? "they end within line " + std::to_string(line_.line())
                               : "this line has " + std::to_string(line_.words().size())));
  }
  void end_file() const {
    while (line_.next()) {
      if (!line_.words().empty()) line_.fail("the file continues after its last element");
    }
  }
  [[noreturn]] void fail(const std::string& what) const { line_.fail(what); }

 private:
  void next_line() {
    do {
      if (!line_.next()) line_.fail("the file ends before its last element");
    } while (line_.words().empty());
    word_ = 0;
  }

  LineReader& line_;
  std::size_t word_ = 0, first_line_ = 0, numbers_ = 0;
};

class PlyBinaryNumbers {
 public:
  PlyBinaryNumbers(const LineReader& line, bool big_endian)
      : name_(line.name()), rest_(line.rest()), big_endian_(big_endian) {}

  void begin_row() {}
  double next(ScalarType type) {
    if (type.size > rest_.size()) fail_short();
    const double value = decode(rest_.data(), type, big_endian_);
    rest_.remove_prefix(type.size);
    return value;
  }
  void require(double count, ScalarType type) const {
    if (count * static_cast<double>(type.size) > static_cast<double>(rest_.size())) fail_short();
  }
  void end_row() const {}
  void end_file() const {
    if (rest_.find_first_not_of(" \t\r\n") == std::string_view::npos) return;
    fail("the file has " + std::to_string(rest_.size()) + " bytes after its last element");
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::format, name_ + ": " + what);
  }

 private:
  [[noreturn]] void fail_short() const { fail("the file ends before its last element"); }

  const std::string& name_;
  std::string_view rest_;
  bool big_endian_;
};

/// Reads a PLY file, ASCII or binary of either byte order: its header, then its elements row by
/// row. Allocates memory only for data that the file contains, whatever counts the header states.
/// `bytes` are the contents of the file and must outlive this object. `name` is the file's name in
/// messages. Throws Error(format) that names the file and, in ASCII files, the line.
class PlyFile {
 public:
  PlyFile(std::string_view bytes, std::string name) : line_(std::move(name), bytes) {
    read_header();
  }

  [[nodiscard]] const std::vector<PlyElement>& elements() const { return elements_; }

  /// Throws Error(format), for faults of the header that the caller finds.
  [[noreturn]] void fail(const std::string& what) const { line_.fail(what); }
  /// Number of the last line read, 0 in binary files.
  [[nodiscard]] std::size_t line() const { return format_ == Format::ascii ? line_.line() : 0; }

  /// Calls take(index of the element, PlyRow) for each row of the first `count` elements, in the
  /// order of the file. If these are all elements, throws if the file continues. Call it once.
  template <typename Take>
  void read(std::size_t count, Take&& take) {
    if (format_ == Format::ascii) {
      read_rows(count, PlyAsciiNumbers(line_), take);
    } else {
      read_rows(count, PlyBinaryNumbers(line_, format_ == Format::big_endian), take);
    }
  }

 private:
  enum class Format { none, ascii, little_endian, big_endian };

  void read_header() {
    if (!line_.next() || line_.words().empty() || line_.words()[0] != "ply") {
      fail("the file is not a PLY file; it must begin with \"ply\"");
    }
    for (;;) {
      if (!line_.next()) fail("the header is truncated; it has no line end_header");
      const auto& words = line_.words();
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format") {
        format_ = read_format();
      } else if (words[0] == "element") {
        if (words.size() != 3) fail("an element needs a name and a count");
        elements_.push_back(
            {words[1], line_.count(2, std::numeric_limits<std::uint32_t>::max()), {}});
      } else if (words[0] == "property") {
        if (elements_.empty()) fail("a property precedes the first element");
        std::vector<PlyProperty>& all = elements_.back().properties;
        all.push_back(read_property());
        if (std::any_of(all.begin(), all.end() - 1,
                        [&](const PlyProperty& p) { return p.name == all.back().name; })) {
          fail("the property " + quoted(all.back().name) + " is declared twice");
        }
      } else {
        fail("the header's keyword " + quoted(words[0]) + " is unknown");
      }
    }
    if (format_ == Format::none) fail("the header has no format line");
  }

  [[nodiscard]] Format read_format() const {
    const auto& words = line_.words();
    const std::string_view name = words.size() > 1 ? words[1] : std::string_view();
    if (name == "ascii") return Format::ascii;
    if (name == "binary_little_endian") return Format::little_endian;
    if (name == "binary_big_endian") return Format::big_endian;
    fail("the format " + quoted(name) + " is unknown");
  }

  [[nodiscard]] PlyProperty read_property() const {
    const auto& words = line_.words();
    const bool is_list = words.size() > 1 && words[1] == "list";
    PlyProperty property;
    if (is_list) {
      property.count = type_of(2);
      if (property.count->kind == ScalarType::Kind::floating) {
        fail("a list's count must be a whole number");
      }
    }
    property.type = type_of(is_list ? 3 : 1);
    if (words.size() != (is_list ? 5U : 3U)) fail("a property needs a type and a name");
    property.name = words.back();
    return property;
  }

  [[nodiscard]] ScalarType type_of(std::size_t word) const {
    using Kind = ScalarType::Kind;
    if (word >= line_.words().size()) fail("a property needs a type and a name");
    const std::string_view name = line_.words()[word];
    if (name == "char" || name == "int8") return {Kind::signed_integer, 1};
    if (name == "uchar" || name == "uint8") return {Kind::unsigned_integer, 1};
    if (name == "short" || name == "int16") return {Kind::signed_integer, 2};
    if (name == "ushort" || name == "uint16") return {Kind::unsigned_integer, 2};
    if (name == "int" || name == "int32") return {Kind::signed_integer, 4};
    if (name == "uint" || name == "uint32") return {Kind::unsigned_integer, 4};
    if (name == "float" || name == "float32") return {Kind::floating, 4};
    if (name == "double" || name == "float64") return {Kind::floating, 8};
    fail("the type " + quoted(name) + " is unknown");
  }

  template <typename Numbers, typename Take>
  void read_rows(std::size_t elements, Numbers numbers, Take& take) const {
    PlyRow row;
    for (std::size_t e = 0; e < elements; ++e) {
      const PlyElement& element = elements_[e];
      // Without properties there is nothing to read.
      if (element.properties.empty()) continue;
      for (std::uint64_t i = 0; i < element.count; ++i) {
        row.clear();
        numbers.begin_row();
        for (const PlyProperty& property : element.properties) {
          double count = 1;
          if (property.count) {
            count = numbers.next(*property.count);
            if (!(count >= 0)) numbers.fail("a list has a negative count");
            numbers.require(count, property.type);
          }
          for (double k = 0; k < count; ++k) row.append(numbers.next(property.type));
          row.end_property();
        }
        numbers.end_row();
        take(e, row);
      }
    }
    if (elements == elements_.size()) numbers.end_file();
  }

  LineReader line_;
  Format format_ = Format::none;
  std::vector<PlyElement> elements_;
};

}  // namespace viewgain::detail
