// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "cloud_formats.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/file_text.hpp"
#include "viewgain/core/scalar_type.hpp"

namespace viewgain::detail {
namespace {

struct Property {
  std::string_view name;
  ScalarType type;
  std::optional<ScalarType> count;  ///< of a list
};

struct Element {
  std::string_view name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

enum class Format { none, ascii, little_endian, big_endian };

struct Header {
  Format format = Format::none;
  std::vector<Element> elements;  ///< up to the vertices, which are the last of them
  std::array<std::size_t, 3> xyz{};
};

ScalarType type_of(const LineReader& line, std::size_t word) {
  using Kind = ScalarType::Kind;
  if (word >= line.words().size()) line.fail("a property needs a type and a name");
  const std::string_view name = line.words()[word];
  if (name == "char" || name == "int8") return {Kind::signed_integer, 1};
  if (name == "uchar" || name == "uint8") return {Kind::unsigned_integer, 1};
  if (name == "short" || name == "int16") return {Kind::signed_integer, 2};
  if (name == "ushort" || name == "uint16") return {Kind::unsigned_integer, 2};
  if (name == "int" || name == "int32") return {Kind::signed_integer, 4};
  if (name == "uint" || name == "uint32") return {Kind::unsigned_integer, 4};
  if (name == "float" || name == "float32") return {Kind::floating, 4};
  if (name == "double" || name == "float64") return {Kind::floating, 8};
  line.fail("the type " + quoted(name) + " is unknown");
}

Property read_property(const LineReader& line) {
  const bool is_list = line.words().size() > 1 && line.words()[1] == "list";
  Property property;
  if (is_list) {
    property.count = type_of(line, 2);
    if (property.count->kind == ScalarType::Kind::floating) {
      line.fail("a list's count must be a whole number");
    }
  }
  property.type = type_of(line, is_list ? 3 : 1);
  if (line.words().size() != (is_list ? 5U : 3U)) line.fail("a property needs a type and a name");
  property.name = line.words().back();
  return property;
}

Format read_format(const LineReader& line) {
  const std::string_view name = line.words().size() > 1 ? line.words()[1] : std::string_view();
  if (name == "ascii") return Format::ascii;
  if (name == "binary_little_endian") return Format::little_endian;
  if (name == "binary_big_endian") return Format::big_endian;
  line.fail("the format " + quoted(name) + " is unknown");
}

Header read_header(LineReader& line) {
  if (!line.next() || line.words().empty() || line.words()[0] != "ply") {
    line.fail("is no PLY file: it does not begin with \"ply\"");
  }
  Header header;
  for (;;) {
    if (!line.next()) line.fail("the header is cut: it has no line end_header");
    const auto& words = line.words();
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format") {
      header.format = read_format(line);
    } else if (words[0] == "element") {
      if (words.size() != 3) line.fail("an element needs a name and a count");
      header.elements.push_back(
          {words[1], line.count(2, std::numeric_limits<std::uint32_t>::max()), {}});
    } else if (words[0] == "property") {
      if (header.elements.empty()) line.fail("a property stands before the first element");
      header.elements.back().properties.push_back(read_property(line));
    } else {
      line.fail("the header's word " + quoted(words[0]) + " is unknown");
    }
  }
  if (header.format == Format::none) line.fail("the header has no line format");
  const auto vertices = std::find_if(header.elements.begin(), header.elements.end(),
                                     [](const Element& e) { return e.name == "vertex"; });
  if (vertices == header.elements.end()) line.fail("there is no element \"vertex\"");
  constexpr std::array<std::string_view, 3> kNames{"x", "y", "z"};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto& properties = vertices->properties;
    const auto found = std::find_if(properties.begin(), properties.end(),
                                    [&](const Property& p) { return p.name == kNames[a]; });
    if (found == properties.end() || found->count) {
      line.fail("the vertices have no property " + quoted(kNames[a]));
    }
    header.xyz[a] = static_cast<std::size_t>(found - properties.begin());
  }
  header.elements.erase(vertices + 1, header.elements.end());
  return header;
}

/// Gives the numbers of an ASCII file one by one; each element stands on a line of its own.
class AsciiNumbers {
 public:
  explicit AsciiNumbers(LineReader& line) : line_(line) {}

  void begin_element() {
    do {
      if (!line_.next()) line_.fail("the file ends before its last element");
    } while (line_.words().empty());
    word_ = 0;
  }
  double next(ScalarType) { return line_.number(word_++); }
  void skip(double count, ScalarType) {
    // Looked at by next() or end_element(), both of which know how many words there are.
    word_ = count <= static_cast<double>(line_.words().size())
                ? word_ + static_cast<std::size_t>(count)
                : line_.words().size() + 1;
  }
  void end_element() {
    if (word_ != line_.words().size()) {
      line_.fail("the header says " + std::to_string(word_) + " numbers, here are " +
                 std::to_string(line_.words().size()));
    }
  }
  [[noreturn]] void fail(const std::string& what) const { line_.fail(what); }

 private:
  LineReader& line_;
  std::size_t word_ = 0;
};

class BinaryNumbers {
 public:
  BinaryNumbers(const LineReader& line, bool big_endian)
      : name_(line.name()), rest_(line.rest()), big_endian_(big_endian) {}

  void begin_element() {}
  double next(ScalarType type) {
    require(static_cast<double>(type.size));
    const double value = decode(rest_.data(), type, big_endian_);
    rest_.remove_prefix(type.size);
    return value;
  }
  void skip(double count, ScalarType type) {
    const double bytes = count * static_cast<double>(type.size);
    require(bytes);
    rest_.remove_prefix(static_cast<std::size_t>(bytes));
  }
  void end_element() {}
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::format, name_ + ": " + what);
  }

 private:
  void require(double bytes) const {
    if (bytes > static_cast<double>(rest_.size())) fail("the file ends before its last element");
  }

  const std::string& name_;
  std::string_view rest_;
  bool big_endian_;
};

template <typename Numbers>
void read_elements(const Header& header, Numbers numbers,
                   std::vector<std::array<double, 3>>& points) {
  for (const Element& element : header.elements) {
    const bool is_vertex = &element == &header.elements.back();
    // Without properties the count would be all that is checked.
    if (element.properties.empty()) continue;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      numbers.begin_element();
      std::array<double, 3> point{};
      for (std::size_t k = 0; k < element.properties.size(); ++k) {
        const Property& property = element.properties[k];
        if (property.count) {
          const double count = numbers.next(*property.count);
          if (!(count >= 0)) numbers.fail("a list has a negative count");
          numbers.skip(count, property.type);
          continue;
        }
        const double value = numbers.next(property.type);
        for (std::size_t a = 0; a < 3; ++a) {
          if (is_vertex && k == header.xyz[a]) point[a] = value;
        }
      }
      numbers.end_element();
      if (is_vertex) points.push_back(point);
    }
  }
}

}  // namespace

PointCloud parse_ply(std::string_view bytes, const std::string& name) {
  LineReader line(name, bytes);
  const Header header = read_header(line);
  PointCloud cloud;
  if (header.format == Format::ascii) {
    read_elements(header, AsciiNumbers(line), cloud.points);
  } else {
    read_elements(header, BinaryNumbers(line, header.format == Format::big_endian), cloud.points);
  }
  return cloud;
}

}  // namespace viewgain::detail
