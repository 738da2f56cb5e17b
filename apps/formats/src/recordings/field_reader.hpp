// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "recordings/byte_reader.hpp"
#include "recordings/messages.hpp"

namespace viewgain {

/// A ROS message's header: `stamp` [ns], `frame` without a leading slash.
struct RosHeader {
  std::int64_t stamp = 0;
  std::string frame;
};

/// Reads the fields of a message in order, of ROS 1 or of CDR in either byte order. Throws
/// Error(format) if the message ends early.
class FieldReader {
 public:
  FieldReader(std::string_view bytes, MessageEncoding encoding)
      : reader_(bytes), is_cdr_(encoding == MessageEncoding::cdr) {
    if (!is_cdr_) return;
    (void)reader_.number<std::uint8_t>();
    const auto kind = reader_.number<std::uint8_t>();
    (void)reader_.number<std::uint16_t>();
    // CDR, and plain CDR 2, which aligns to at most 4 bytes, each in two byte orders.
    if (kind != 0 && kind != 1 && kind != 6 && kind != 7) {
      throw Error(ErrorCode::format,
                  "the CDR encoding of kind " + std::to_string(kind) + " is not supported");
    }
    is_big_endian_ = kind % 2 == 0;
    most_aligned_ = kind < 2 ? 8 : 4;
    size_ = reader_.left();
  }

  template <typename Number>
  Number number() {
    if (is_cdr_) {
      const std::size_t to = std::min(sizeof(Number), most_aligned_);
      (void)reader_.bytes((to - (size_ - reader_.left()) % to) % to);
    }
    auto value = reader_.number<std::array<char, sizeof(Number)>>();
    if (is_big_endian_) std::reverse(value.begin(), value.end());
    return std::bit_cast<Number>(value);
  }

  template <std::size_t kCount>
  std::array<double, kCount> doubles() {
    std::array<double, kCount> values{};
    for (double& value : values) value = number<double>();
    return values;
  }

  std::vector<double> list_of_doubles() {
    const auto count = number<std::uint32_t>();
    std::vector<double> values;
    for (std::uint32_t i = 0; i < count; ++i) values.push_back(number<double>());
    return values;
  }

  /// A sequence of bytes.
  std::string_view blob() { return reader_.bytes(number<std::uint32_t>()); }

  std::string text() {
    std::string_view bytes = blob();
    if (is_cdr_ && bytes.ends_with('\0')) bytes.remove_suffix(1);
    return std::string(bytes);
  }

  std::string frame() {
    std::string name = text();
    if (name.starts_with('/')) name.erase(0, 1);
    return name;
  }

  RosHeader header() {
    if (!is_cdr_) (void)number<std::uint32_t>();  // a sequence number
    const auto seconds =
        is_cdr_ ? std::int64_t{number<std::int32_t>()} : std::int64_t{number<std::uint32_t>()};
    const std::int64_t stamp = seconds * 1'000'000'000 + number<std::uint32_t>();
    return {stamp, frame()};
  }

 private:
  ByteReader reader_;
  bool is_cdr_;
  bool is_big_endian_ = false;
  std::size_t most_aligned_ = 1;
  std::size_t size_ = 0;  // after CDR's own header, from which fields are aligned
};

}  // namespace viewgain
