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

/// Encoding of a topic's messages.
enum class MessageEncoding : std::uint8_t { ros1, cdr, other };

/// A topic of a recording.
struct Topic {
  std::string name;
  std::string type;  ///< "sensor_msgs/Image", also of ROS 2
  MessageEncoding encoding = MessageEncoding::other;
};

/// A message as in the file, valid until the next one is read.
struct Message {
  const Topic& topic;
  std::string_view bytes;
  const std::filesystem::path& file;
  std::uint64_t place = 0;  ///< byte in the file, or row in a database
};

using MessageVisitor = std::function<void(const Message&)>;

/// Warnings for the user. Each text is kept once, because recordings are read twice; at most 50.
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
  warnings.add(file.string() + ": messages that " + which +
               " are left out: " + std::to_string(count));
}

/// Visits the messages of one file in order, with constant memory. A truncated file is read up to
/// its end, with a warning. Throws Error(io), and Error(format) with file and position for other
/// damage.
void read_mcap(const std::filesystem::path& file, const MessageVisitor& visit, Warnings& warnings);
/// As above, for ROS 1.
void read_bag(const std::filesystem::path& file, const MessageVisitor& visit, Warnings& warnings);
/// As above, for ROS 2 with SQLite.
void read_db3(const std::filesystem::path& file, const MessageVisitor& visit, Warnings& warnings);

/// "sensor_msgs/Image" of "sensor_msgs/msg/Image".
[[nodiscard]] inline std::string message_type(std::string_view name) {
  std::string type(name);
  const std::size_t found = type.find("/msg/");
  if (found != std::string::npos) type.erase(found, 4);
  return type;
}

}  // namespace viewgain
