// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace viewgain::test {

/// Fields of a ROS message in the order in which they are put, as CDR of either byte order or as
/// ROS 1 has them. Its own code: nothing of the readers is in it.
class MessageFields {
 public:
  enum class Kind : std::uint8_t { little_cdr, big_cdr, little_cdr2, ros1 };

  explicit MessageFields(Kind kind) : kind_(kind) {
    constexpr std::array kCdr{'\1', '\0', '\7'};
    if (kind != Kind::ros1) bytes_ = {'\0', kCdr.at(static_cast<std::size_t>(kind)), '\0', '\0'};
  }

  template <typename Number>
  MessageFields& put(Number value) {
    const std::size_t most = kind_ == Kind::little_cdr2 ? 4 : 8;
    const std::size_t to = std::min(sizeof value, most);
    while (kind_ != Kind::ros1 && (bytes_.size() - 4) % to != 0) bytes_ += '\0';
    auto raw = std::bit_cast<std::array<char, sizeof value>>(value);
    if (kind_ == Kind::big_cdr) std::reverse(raw.begin(), raw.end());
    bytes_.append(raw.data(), raw.size());
    return *this;
  }
  MessageFields& text(std::string_view value) {
    const bool is_cdr = kind_ != Kind::ros1;
    put(static_cast<std::uint32_t>(value.size() + (is_cdr ? 1 : 0)));
    bytes_.append(value);
    if (is_cdr) bytes_ += '\0';
    return *this;
  }
  MessageFields& blob(std::string_view value) {
    put(static_cast<std::uint32_t>(value.size()));
    bytes_.append(value);
    return *this;
  }
  template <typename Values>
  MessageFields& doubles(const Values& values) {
    for (const double value : values) put(value);
    return *this;
  }
  MessageFields& header(double seconds, std::string_view frame) {
    const auto whole = static_cast<std::uint32_t>(seconds);
    if (kind_ == Kind::ros1) put(std::uint32_t{7});
    put(whole).put(static_cast<std::uint32_t>((seconds - whole) * 1e9 + 0.5));
    return text(frame);
  }

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  Kind kind_;
  std::string bytes_;
};

/// An MCAP file.
class McapText {
 public:
  using Kind = MessageFields::Kind;

  explicit McapText(Kind kind = Kind::little_cdr) : kind_(kind) {
    record(1, text("ros2") + text("test"));
  }

  [[nodiscard]] MessageFields fields() const { return MessageFields(kind_); }

  void add(const std::string& topic, const std::string& type, const MessageFields& message,
           const std::string& encoding = {}) {
    if (!channels_.contains(topic)) {
      const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
      channels_[topic] = id;
      const std::size_t begin = records_.size();
      record(3, number(id) + text(type) + text("ros2msg") + number(std::uint32_t{0}));
      const std::string said = kind_ == Kind::ros1 ? "ros1" : "cdr";
      record(4, number(id) + number(id) + text(topic) + text(encoding.empty() ? said : encoding) +
                    number(std::uint32_t{0}));
      summary_ += records_.substr(begin);
    }
    record(5, number(channels_[topic]) + std::string(20, '\0') + message.bytes());
  }

  void transform(const std::string& topic, double time, const std::string& parent,
                 const std::string& child, const std::array<double, 7>& numbers) {
    MessageFields message = fields();
    message.put(std::uint32_t{1}).header(time, parent).text(child).doubles(numbers);
    add(topic, "tf2_msgs/msg/TFMessage", message);
  }

  void image(const std::string& topic, double time, const std::string& frame, std::uint32_t width,
             std::uint32_t height, const std::string& encoding, const std::string& data,
             std::uint32_t step, bool is_big_endian = false) {
    MessageFields message = fields();
    message.header(time, frame).put(height).put(width).text(encoding);
    message.put(static_cast<std::uint8_t>(is_big_endian ? 1 : 0)).put(step).blob(data);
    add(topic, "sensor_msgs/msg/Image", message);
  }

  /// Of the records so far.
  [[nodiscard]] std::size_t size() const { return records_.size(); }

  /// What came behind the first `from` bytes of records becomes a chunk, which declares `missing`
  /// bytes more than it has.
  void put_in_chunk(std::size_t from, std::uint64_t missing) {
    const std::string inner = records_.substr(from);
    const std::uint64_t size = inner.size();
    records_.resize(from);
    record(6, std::string(16, '\0') + number(size + missing) + number(std::uint32_t{0}) + text("") +
                  number(size) + inner);
  }

  [[nodiscard]] std::string bytes(bool is_ended = true, bool has_summary = false) const {
    const std::string magic("\x89MCAP0\r\n", 8);
    McapText end = *this;
    if (is_ended) end.record(15, number(std::uint32_t{0}));
    const std::uint64_t summary = has_summary ? magic.size() + end.records_.size() : 0;
    if (has_summary) end.records_ += summary_;
    if (is_ended) end.record(2, number(summary) + std::string(12, '\0'));
    return magic + end.records_ + (is_ended ? magic : "");
  }

 private:
  template <typename Number>
  static std::string number(Number value) {
    const auto raw = std::bit_cast<std::array<char, sizeof value>>(value);
    return {raw.data(), raw.size()};
  }
  static std::string text(std::string_view value) {
    return number(static_cast<std::uint32_t>(value.size())) + std::string(value);
  }
  void record(char kind, const std::string& contents) {
    records_ += kind + number(static_cast<std::uint64_t>(contents.size())) + contents;
  }

  Kind kind_;
  std::string records_, summary_;
  std::map<std::string, std::uint16_t> channels_;
};

}  // namespace viewgain::test
