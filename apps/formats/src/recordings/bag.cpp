// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// ROS 1 bags, version 2.0 (wiki.ros.org/Bags/Format/2.0). A record has a header of named fields,
// and data; records are in the file and in chunks.
#include <map>
#include <string>
#include <utility>

#include "recordings/byte_reader.hpp"
#include "recordings/input_file.hpp"
#include "recordings/messages.hpp"
#include "recordings/unpack.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

constexpr std::string_view kBagMagic("#ROSBAG V2.0\n");

enum class BagRecord : std::uint8_t { message = 2, head = 3, chunk = 5, connection = 7 };

using BagFields = std::map<std::string_view, std::string_view>;

BagFields bag_fields(std::string_view header) {
  BagFields fields;
  for (ByteReader reader(header); reader.left() > 0;) {
    const std::string_view field = reader.text();
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos) throw Error(ErrorCode::format, "a field without '='");
    fields[field.substr(0, equals)] = field.substr(equals + 1);
  }
  return fields;
}

std::string_view bag_text(const BagFields& fields, std::string_view name) {
  const auto found = fields.find(name);
  if (found == fields.end()) {
    throw Error(ErrorCode::format, "the header of a record has no field " + std::string(name));
  }
  return found->second;
}

template <typename Number>
Number bag_number(const BagFields& fields, std::string_view name) {
  return ByteReader(bag_text(fields, name)).number<Number>();
}

class BagReader {
  template <typename Parse>
  auto checked(Parse parse) const {
    return file_.checked(begin_, parse);
  }

 public:
  BagReader(const std::filesystem::path& path, const MessageVisitor& visit, Warnings& warnings)
      : path_(path), visit_(visit), warnings_(warnings), file_(path) {}

  void read() {
    read_records();
    warn_of_left_out(path_, without_connection_,
                     "have no connection record (perhaps a chunk is damaged)", warnings_);
  }

 private:
  void read_records() {
    if (file_.left() < kBagMagic.size() || file_.read(kBagMagic.size()) != kBagMagic) {
      file_.fail_at(
          0, "the file is not a ROS 1 bag of version 2.0; convert an older bag with `rosbag fix`");
    }
    while (file_.left() > 0) {
      begin_ = file_.offset();
      std::string header;
      std::uint64_t length = 0;
      const bool is_whole = read_length(length) && length <= file_.left();
      if (is_whole) header = file_.read(length);
      if (!is_whole || !read_length(length)) return file_.warn_of_cut(begin_, warnings_);
      const bool is_cut = length > file_.left();
      if (is_cut) file_.warn_of_cut(begin_, warnings_), length = file_.left();
      const BagFields fields = checked([&] { return bag_fields(header); });
      const auto kind = checked([&] { return BagRecord{bag_number<std::uint8_t>(fields, "op")}; });
      if (kind == BagRecord::chunk) {
        read_chunk(fields, file_.read(length), is_cut);
      } else if (is_cut) {
        return;
      } else if (kind == BagRecord::message || kind == BagRecord::connection) {
        take(kind, fields, file_.read(length));
      } else {
        if (kind == BagRecord::head) check_head(fields);
        file_.skip(length);
      }
    }
  }

  bool read_length(std::uint64_t& length) {
    if (file_.left() < sizeof(std::uint32_t)) return false;
    length = ByteReader(file_.read(sizeof(std::uint32_t))).number<std::uint32_t>();
    return true;
  }

  void check_head(const BagFields& fields) {
    const auto encryptor = fields.find("encryptor");
    if (encryptor != fields.end() && !encryptor->second.empty()) {
      file_.fail_at(begin_, "the bag is encrypted; decrypt it with `rosbag decrypt`");
    }
    if (checked([&] { return bag_number<std::uint64_t>(fields, "index_pos"); }) == 0) {
      warnings_.add(path_.string() +
                    ": the bag has no index, because the recording was interrupted; the part "
                    "before the interruption is used");
    }
  }

  void read_chunk(const BagFields& fields, std::string_view packed, bool is_cut) {
    const std::string why = checked([&] {
      return unpack(bag_text(fields, "compression"), packed,
                    bag_number<std::uint32_t>(fields, "size"), unpacked_);
    });
    if (!why.empty() && !is_cut) file_.warn_of_chunk(begin_, why, warnings_);
    for (ByteReader records(unpacked_); records.left() > 0;) {
      std::string_view header, data;
      try {
        header = records.text(), data = records.text();
      } catch (const Error&) {
        if (!why.empty()) return;
        file_.fail_at(begin_, "the chunk is damaged: its last record ends outside the chunk");
      }
      const BagFields inner = checked([&] { return bag_fields(header); });
      take(checked([&] { return BagRecord{bag_number<std::uint8_t>(inner, "op")}; }), inner, data);
    }
  }

  void take(BagRecord kind, const BagFields& fields, std::string_view data) {
    if (kind != BagRecord::message && kind != BagRecord::connection) return;
    const auto id = checked([&] { return bag_number<std::uint32_t>(fields, "conn"); });
    if (kind == BagRecord::connection) {
      checked([&] {
        const BagFields more = bag_fields(data);
        topics_.insert_or_assign(
            id, Topic{std::string(bag_text(fields, "topic")), message_type(bag_text(more, "type")),
                      MessageEncoding::ros1});
      });
      return;
    }
    const auto topic = topics_.find(id);
    if (topic == topics_.end()) {
      ++without_connection_;
      return;
    }
    visit_({topic->second, data, path_, begin_});
  }

  const std::filesystem::path& path_;
  const MessageVisitor& visit_;
  Warnings& warnings_;
  InputFile file_;
  std::uint64_t begin_ = 0;  // of the record
  std::size_t without_connection_ = 0;
  std::string unpacked_;
  std::map<std::uint32_t, Topic> topics_;
};

}  // namespace

void read_bag(const std::filesystem::path& file, const MessageVisitor& visit, Warnings& warnings) {
  BagReader(file, visit, warnings).read();
}

}  // namespace viewgain
