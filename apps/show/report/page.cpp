// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "show/report/page.hpp"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

#include "viewgain/core/error.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/file_names.hpp"

// What viewer/ was bundled to when the program was built (page_bytes.S); empty without npm.
extern "C" const char viewgain_report_page_begin[], viewgain_report_page_end[];

namespace viewgain::app {
namespace {

constexpr std::string_view kPlace = "__VIEWGAIN_DATA__";

std::string_view built_page() {
  return {viewgain_report_page_begin,
          static_cast<std::size_t>(viewgain_report_page_end - viewgain_report_page_begin)};
}

}  // namespace

void check_report_page(std::string_view flag) {
  if (!built_page().empty()) return;
  refuse(std::string(flag) +
         ": this program was built without the report page, because npm or its registry was not "
         "available; install nodejs and npm, then configure and build again");
}

std::string report_page(const Json& data, std::string_view page) {
  const std::size_t place = page.find(kPlace);
  if (place == std::string_view::npos || page.find(kPlace, place + 1) != std::string_view::npos) {
    throw Error(ErrorCode::format, "the report's page must have " + std::string(kPlace) + " once");
  }
  std::string text(page.substr(0, place));
  // A '<' is text in any JSON string, where it may be written as an escape: so no tag begins.
  for (const char c : dumped(data)) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  text += page.substr(place + kPlace.size());
  return text;
}

std::string report_page(const Json& data) { return report_page(data, built_page()); }

void write_report(const std::filesystem::path& path, const Json& data) {
  require_ending(path, "a report", {".html"});
  write_file_atomically(path, report_page(data));
}

namespace {

static_assert(std::endian::native == std::endian::little);

std::string gzip(std::string_view bytes) {
  constexpr int kGzip = 16;  // what zlib adds to the window's size to ask for gzip's frame
  z_stream stream{};
  if (deflateInit2(&stream, 6, Z_DEFLATED, MAX_WBITS + kGzip, 8, Z_DEFAULT_STRATEGY) != Z_OK) {
    throw Error(ErrorCode::backend, "zlib cannot start");
  }
  std::string packed(deflateBound(&stream, bytes.size()), '\0');
  // zlib does not write to what it reads.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  const int result = deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  if (result != Z_STREAM_END) throw Error(ErrorCode::backend, "zlib cannot pack the report");
  return packed;
}

Json block(const char* type, std::size_t columns, std::size_t count, std::string_view bytes) {
  return {{"type", type},
          {"columns", columns},
          {"rows", columns == 0 ? 0 : count / columns},
          {"data", base64(gzip(bytes))}};
}

// Differences down the columns, zigzag-coded, in planes of equal bytes: what gzip packs well.
template <typename Unsigned>
std::string planes(const std::vector<Unsigned>& values, std::size_t columns) {
  using Signed = std::make_signed_t<Unsigned>;
  constexpr unsigned kBits = 8 * sizeof(Unsigned);
  const std::size_t rows = columns == 0 ? 0 : values.size() / columns;
  std::string bytes(values.size() * sizeof(Unsigned), '\0');
  for (std::size_t c = 0; c < columns; ++c) {
    Unsigned before = 0;
    for (std::size_t r = 0; r < rows; ++r) {
      const Unsigned value = values[r * columns + c];
      const auto step = static_cast<Signed>(static_cast<Unsigned>(value - before));
      before = value;
      const auto sign = static_cast<Unsigned>(step < 0 ? ~Unsigned{0} : Unsigned{0});
      const auto code = static_cast<Unsigned>(static_cast<Unsigned>(step) << 1U) ^ sign;
      for (unsigned b = 0; b < kBits / 8; ++b) {
        bytes[(c * sizeof(Unsigned) + b) * rows + r] = static_cast<char>(code >> (8 * b) & 0xFFU);
      }
    }
  }
  return bytes;
}

struct Range {
  double min = 0, step = 0;
};

// So that `levels` steps reach from the least to the largest finite value.
template <typename Value>
Range range_of(std::size_t count, double levels, const Value& value) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = 0; i < count; ++i) {
    const double v = value(i);
    if (!std::isfinite(v)) continue;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  if (!(low <= high)) return {};
  return {low, (high - low) / levels};
}

template <typename Unsigned>
Unsigned level_of(double value, const Range& range) {
  if (!std::isfinite(value)) return std::numeric_limits<Unsigned>::max();
  return range.step > 0 ? static_cast<Unsigned>(std::lround((value - range.min) / range.step)) : 0;
}

}  // namespace

std::string base64(std::string_view bytes) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t there = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      word = word << 8U | (k < there ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= there ? kDigits[word >> (18 - 6 * k) & 63U] : '=';
    }
  }
  return text;
}

Json float_block(const std::vector<float>& values, std::size_t columns) {
  return block("f32", columns, values.size(),
               {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)});
}

Json index_block(const std::vector<std::uint32_t>& values, std::size_t columns) {
  return block("u32", columns, values.size(), planes(values, columns));
}

Json byte_block(const std::vector<std::uint8_t>& values) {
  return block("u8", 1, values.size(), planes(values, 1));
}

Json point_block(std::span<const Eigen::Vector3d> points) {
  constexpr double kLevels = std::numeric_limits<std::uint16_t>::max() - 1;  // the last one is NaN
  std::vector<std::uint16_t> levels(3 * points.size());
  Json min = Json::array(), step = Json::array();
  for (Eigen::Index c = 0; c < 3; ++c) {
    const Range range =
        range_of(points.size(), kLevels, [&](std::size_t i) { return points[i][c]; });
    for (std::size_t i = 0; i < points.size(); ++i) {
      levels[3 * i + static_cast<std::size_t>(c)] = level_of<std::uint16_t>(points[i][c], range);
    }
    min.push_back(range.min);
    step.push_back(range.step);
  }
  Json json = block("u16", 3, levels.size(), planes(levels, 3));
  json["min"] = std::move(min);
  json["step"] = std::move(step);
  return json;
}

Json shade_block(const std::vector<double>& values) {
  constexpr double kLevels = std::numeric_limits<std::uint8_t>::max() - 1;
  const Range range = range_of(values.size(), kLevels, [&](std::size_t i) { return values[i]; });
  std::vector<std::uint8_t> levels;
  levels.reserve(values.size());
  for (const double value : values) levels.push_back(level_of<std::uint8_t>(value, range));
  Json json = block("u8", 1, levels.size(), planes(levels, 1));
  json["min"] = {range.min};
  json["step"] = {range.step};
  return json;
}

}  // namespace viewgain::app
