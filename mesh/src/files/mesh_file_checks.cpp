// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "mesh_file_checks.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <sstream>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "viewgain/core/error.hpp"

namespace viewgain::detail {
namespace {

[[noreturn]] void fail(const std::string& name, const std::string& what) {
  throw Error(ErrorCode::format, name + ": " + what);
}

bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

// One property of a PLY element. Sizes in bytes; list_size is that of the list's count, 0 for a
// scalar.
struct PlyProperty {
  std::string name;
  std::string type;
  std::size_t size = 0;
  std::size_t list_size = 0;
  bool list_count_signed = false;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

enum class PlyFormat { ascii, little_endian, big_endian };

std::optional<std::size_t> ply_type_size(std::string_view type) {
  static constexpr std::array<std::pair<std::string_view, std::size_t>, 16> kTypes{
      {{"char", 1},
       {"int8", 1},
       {"uchar", 1},
       {"uint8", 1},
       {"short", 2},
       {"int16", 2},
       {"ushort", 2},
       {"uint16", 2},
       {"int", 4},
       {"int32", 4},
       {"uint", 4},
       {"uint32", 4},
       {"float", 4},
       {"float32", 4},
       {"double", 8},
       {"float64", 8}}};
  for (const auto& [name, size] : kTypes) {
    if (name == type) return size;
  }
  return std::nullopt;
}

bool is_floating(std::string_view type) {
  return type.starts_with("float") || type.starts_with("double");
}

bool is_index_type(std::string_view type) {
  return type == "int" || type == "int32" || type == "uint" || type == "uint32";
}

PlyProperty parse_ply_property(std::istringstream& words, const std::string& name) {
  PlyProperty property;
  std::string type;
  words >> type;
  if (type == "list") {
    std::string count_type;
    words >> count_type;
    const auto count_size = ply_type_size(count_type);
    if (!count_size || is_floating(count_type))
      fail(name, "list count of type \"" + count_type + "\"");
    property.list_size = *count_size;
    property.list_count_signed = !count_type.starts_with("u");
    words >> type;
  }
  const auto size = ply_type_size(type);
  if (!size || !(words >> property.name)) fail(name, "property of unknown type \"" + type + "\"");
  property.size = *size;
  property.type = type;
  return property;
}

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::size_t body = 0;  // offset of the first byte behind the header
};

PlyHeader parse_ply_header(const std::string& bytes, const std::string& name) {
  PlyHeader header;
  std::size_t position = 0;
  for (int line_number = 1;; ++line_number) {
    const std::size_t end = bytes.find('\n', position);
    if (end == std::string::npos) fail(name, "PLY header without end_header");
    std::istringstream words(bytes.substr(position, end - position));
    position = end + 1;
    std::string keyword;
    words >> keyword;
    if (line_number == 1) {
      if (keyword != "ply") fail(name, "not a PLY file");
    } else if (line_number == 2) {
      std::string format, version;
      words >> format >> version;
      if (keyword != "format" || version.empty()) fail(name, "PLY header without a format line");
      if (format == "binary_little_endian") {
        header.format = PlyFormat::little_endian;
      } else if (format == "binary_big_endian") {
        header.format = PlyFormat::big_endian;
      } else if (format != "ascii") {
        fail(name, "unknown PLY format \"" + format + "\"");
      }
    } else if (keyword == "element") {
      PlyElement element;
      if (!(words >> element.name >> element.count))
        fail(name, "bad element line in the PLY header");
      header.elements.push_back(std::move(element));
    } else if (keyword == "property") {
      if (header.elements.empty()) fail(name, "PLY property before any element");
      header.elements.back().properties.push_back(parse_ply_property(words, name));
    } else if (keyword == "end_header") {
      header.body = position;
      return header;
    } else if (keyword != "comment" && keyword != "obj_info") {
      fail(name, "unknown line \"" + keyword + "\" in the PLY header");
    }
  }
}

// What CGAL's reader takes for granted of the elements that it uses.
void check_ply_layout(const PlyElement& element, const std::string& name) {
  if (element.count > 0 && element.properties.empty()) {
    fail(name, "PLY element \"" + element.name + "\" without properties");
  }
  if (element.name == "vertex" || element.name == "vertices") {
    for (const char* axis : {"x", "y", "z"}) {
      const auto found = std::find_if(element.properties.begin(), element.properties.end(),
                                      [axis](const PlyProperty& p) { return p.name == axis; });
      if (found == element.properties.end() || found->list_size != 0 || !is_floating(found->type)) {
        fail(name, std::string("PLY vertices need ") + axis + " as float or double");
      }
    }
  } else if (element.name == "face" || element.name == "faces") {
    if (std::none_of(element.properties.begin(), element.properties.end(),
                     [](const PlyProperty& p) {
                       return (p.name == "vertex_indices" || p.name == "vertex_index") &&
                              p.list_size != 0 && is_index_type(p.type);
                     })) {
      fail(name, "PLY faces need a list vertex_indices of int or uint");
    }
  }
}

[[noreturn]] void fail_short(const PlyElement& element, const std::string& name) {
  fail(name, "the header promises " + std::to_string(element.count) + " of \"" + element.name +
                 "\", the file holds fewer");
}

std::uint64_t read_count(const std::string& bytes, std::size_t position,
                         const PlyProperty& property, PlyFormat format, const std::string& name) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < property.list_size; ++i) {
    const std::size_t byte = format == PlyFormat::big_endian ? i : property.list_size - 1 - i;
    value = value << 8U | static_cast<unsigned char>(bytes[position + byte]);
  }
  if (property.list_count_signed && (value >> (8 * property.list_size - 1) & 1U) != 0) {
    fail(name, "negative list count");
  }
  return value;
}

void walk_binary_ply(const std::string& bytes, const PlyHeader& header, const std::string& name) {
  std::size_t position = header.body;
  for (const PlyElement& element : header.elements) {
    const bool has_list = std::any_of(element.properties.begin(), element.properties.end(),
                                      [](const PlyProperty& p) { return p.list_size != 0; });
    std::size_t stride = 0;
    for (const PlyProperty& p : element.properties)
      stride += p.list_size != 0 ? p.list_size : p.size;
    if (element.count == 0) continue;
    if (element.count > (bytes.size() - position) / stride) fail_short(element, name);
    if (!has_list) {
      position += element.count * stride;
      continue;
    }
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& p : element.properties) {
        const std::size_t fixed = p.list_size != 0 ? p.list_size : p.size;
        if (fixed > bytes.size() - position) fail_short(element, name);
        if (p.list_size != 0) {
          const std::uint64_t count = read_count(bytes, position, p, header.format, name);
          if (count > (bytes.size() - position - fixed) / p.size) fail_short(element, name);
          position += count * p.size;
        }
        position += fixed;
      }
    }
  }
}

// Blank-separated words of the body of an ASCII file.
class Words {
 public:
  Words(const std::string& bytes, std::size_t position) : bytes_(bytes), position_(position) {}

  std::string_view next() {
    while (position_ < bytes_.size() && is_space(bytes_[position_])) ++position_;
    const std::size_t begin = position_;
    while (position_ < bytes_.size() && !is_space(bytes_[position_])) ++position_;
    return std::string_view(bytes_).substr(begin, position_ - begin);
  }
  [[nodiscard]] std::size_t remaining_bytes() const { return bytes_.size() - position_; }

 private:
  const std::string& bytes_;
  std::size_t position_;
};

template <typename Number>
Number parse_word(std::string_view word, const PlyElement& element, const std::string& name) {
  if (word.empty()) fail_short(element, name);
  if (word.size() > 1 && word.front() == '+') word.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  // A double too small or too large becomes 0 or infinity; a count must never be misread.
  const bool misread =
      std::is_integral_v<Number> ? error != std::errc{} : error == std::errc::invalid_argument;
  if (misread || end != word.data() + word.size()) {
    fail(name, std::string("\"").append(word.substr(0, 40)).append("\" is no ") +
                   (std::is_integral_v<Number> ? "whole number" : "number"));
  }
  return value;
}

void walk_ascii_ply(const std::string& bytes, const PlyHeader& header, const std::string& name) {
  Words words(bytes, header.body);
  for (const PlyElement& element : header.elements) {
    if (element.count > words.remaining_bytes()) fail_short(element, name);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& p : element.properties) {
        std::uint64_t count = 1;
        if (p.list_size != 0) {
          const auto value = parse_word<std::int64_t>(words.next(), element, name);
          if (value < 0) fail(name, "negative list count");
          count = static_cast<std::uint64_t>(value);
          // CGAL keeps the count in the type that the header names.
          if (count >> (8 * p.list_size - (p.list_count_signed ? 1 : 0)) != 0 ||
              count > words.remaining_bytes()) {
            fail_short(element, name);
          }
        }
        for (std::uint64_t k = 0; k < count; ++k) {
          if (is_floating(p.type)) {
            (void)parse_word<double>(words.next(), element, name);
          } else {
            (void)parse_word<std::int64_t>(words.next(), element, name);
          }
        }
      }
    }
  }
}

}  // namespace

void check_ply(const std::string& bytes, const std::string& name) {
  const PlyHeader header = parse_ply_header(bytes, name);
  for (const PlyElement& element : header.elements) check_ply_layout(element, name);
  if (header.format == PlyFormat::ascii) {
    walk_ascii_ply(bytes, header, name);
  } else {
    walk_binary_ply(bytes, header, name);
  }
}

void check_off(std::string& bytes, const std::string& name) {
  std::size_t position = 0;
  while (position < bytes.size() && (is_space(bytes[position]) || bytes[position] == '#')) {
    if (bytes[position] == '#') position = std::min(bytes.find('\n', position), bytes.size());
    if (position < bytes.size()) ++position;
  }
  std::size_t end = position;
  while (end < bytes.size() && std::isalnum(static_cast<unsigned char>(bytes[end])) != 0) ++end;
  const std::string_view keyword = std::string_view(bytes).substr(position, end - position);
  if (!keyword.ends_with("OFF") && !keyword.ends_with("SKEL")) fail(name, "not an OFF file");
  if (std::string_view(bytes).substr(end, 16).find("BINARY") != std::string_view::npos) return;
  // Behind three coordinates, or the indices of a face, CGAL's reader skips the rest of a line.
  for (const char* flag : {"ST", "C", "N"}) {
    const std::size_t length = std::strlen(flag);
    if (bytes.compare(position, length, flag) != 0) continue;
    std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(position), length, ' ');
    position += length;
  }
}

void check_stl(std::string& bytes, const std::string& name) {
  static constexpr std::size_t kHeader = 80, kBody = 84, kTriangle = 50;
  std::uint64_t promised = 0;
  if (bytes.size() >= kBody) {
    for (std::size_t i = 4; i-- > 0;) {
      promised = promised << 8U | static_cast<unsigned char>(bytes[kHeader + i]);
    }
  }
  const bool complete_binary =
      bytes.size() >= kBody && promised > 0 && kBody + kTriangle * promised <= bytes.size();
  const bool ascii = bytes.starts_with("solid") && bytes.find("facet") != std::string::npos &&
                     bytes.find('\0') == std::string::npos;
  if (ascii) return;
  if (!complete_binary) {
    if (bytes.size() < kBody) fail(name, "too short for an STL file");
    if (promised == 0) fail(name, "the mesh has no faces");
    fail(name, "the header promises " + std::to_string(promised) + " triangles, the file holds " +
                   std::to_string((bytes.size() - kBody) / kTriangle));
  }
  // Some writers begin the free text of a binary header with "solid".
  std::fill_n(bytes.begin(), kHeader, 'x');
}

void check_obj(const std::string& bytes, const std::string& name) {
  std::istringstream lines(bytes);
  std::string line;
  for (std::size_t number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line);
    std::string word;
    if (!(words >> word) || word != "f") continue;
    while (words >> word) {
      if (word == "0" || word.starts_with("0/")) {
        fail(name, "line " + std::to_string(number) + ": index 0 is out of range");
      }
    }
  }
}

}  // namespace viewgain::detail
