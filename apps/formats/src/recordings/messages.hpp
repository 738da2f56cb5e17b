// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace viewgain {

/// How a topic's messages are written.
enum class MessageEncoding : std::uint8_t { ros1, cdr, other };

/// A topic of a recording.
struct Topic {
  std::string name;
  std::string type;  ///< "sensor_msgs/Image", also of ROS 2
  MessageEncoding encoding = MessageEncoding::other;
};

/// A message as the file has it, until the next one is read.
struct Message {
  const Topic& topic;
  std::string_view bytes;
  const std::filesystem::path& file;
  std::uint64_t place = 0;  ///< in the file: a byte, or in a database a row
};

using MessageVisitor = std::function<void(const Message&)>;

/// Warnings for the user, each text once, since recordings are read twice;
/// the first 50.
class Warnings {
 public:
  void add(const std::string& text) {
    constexpr std::size_t kMost = 50;
    const bool is_new = std::find(texts_.begin(), texts_.end(), text) == texts_.end();
    if (is_new && texts_.size() < kMost) texts_.push_back(text);
  }
  [[nodiscard]] const std::vector<std::string>& texts() const noexcept { return texts_; }

 private:
  std::vector<std::string> texts_;
};

/// Warns of messages that cannot be read, if there are any.
inline void warn_of_left_out(const std::filesystem::path& file, std::size_t count,
                             const std::string& which, Warnings& warnings) {
  if (count == 0) return;
  warnings.add(file.string() + ": " + std::to_string(count) + " messages " + which +
               " are left out");
}

/// Visits the messages of one file in its order, in memory that does not grow with the file. A file
/// that is cut is read as far as it goes, with a warning. Throw Error(io), and Error(format) that
/// names the file and the place for one that is damaged otherwise.
void read_mcap(const std::filesystem::path& file, const MessageVisitor& visit, Warnings& warnings);
/// As above: ROS 1.
void read_bag(const std::filesystem::path& file, const MessageVisitor& visit, Warnings& warnings);
/// As above: ROS 2 with SQLite.
void read_db3(const std::filesystem::path& file, const MessageVisitor& visit, Warnings& warnings);

/// "sensor_msgs/Image" of "sensor_msgs/msg/Image".
[[nodiscard]] inline std::string message_type(std::string_view name) {
  std::string type(name);
  const std::size_t found = type.find("/msg/");
  if (found != std::string::npos) type.erase(found, 4);
  return type;
}

}  // namespace viewgain
