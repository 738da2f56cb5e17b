// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "mesh_file_checks.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "viewgain/core/error.hpp"
#include "viewgain/support/scalar_type.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::detail {
namespace {

[[noreturn]] void fail(const std::string& name, const std::string& what) {
  throw Error(ErrorCode::format, name + ": " + what);
}

bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

}  // namespace

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
    constexpr ScalarType kCount{ScalarType::Kind::unsigned_integer, 4};
    promised = static_cast<std::uint64_t>(decode(bytes.data() + kHeader, kCount));
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

void check_obj(std::string& bytes, const std::string& name) {
  std::replace(bytes.begin(), bytes.end(), '\t', ' ');
  LineReader lines(name, bytes);
  for (char* begin = bytes.data(); lines.next();
       begin = bytes.data() + bytes.size() - lines.rest().size()) {
    if (lines.words().empty()) continue;
    if (lines.words()[0] == "l") *begin = '#';
    if (lines.words()[0] != "f") continue;
    for (const std::string_view word : lines.words()) {
      if (word == "0" || word.starts_with("0/")) lines.fail("index 0 is out of range");
    }
  }
}

}  // namespace viewgain::detail
