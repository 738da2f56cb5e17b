// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// MCAP (mcap.dev/spec): records of an opcode, a length and contents, in the file and in chunks.
#include <zlib.h>

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "recordings/byte_reader.hpp"
#include "recordings/input_file.hpp"
#include "recordings/messages.hpp"
#include "recordings/unpack.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

constexpr std::string_view kMcapMagic("\x89MCAP0\r\n", 8);
constexpr std::size_t kMcapHead = 9;  // opcode and length

enum class McapRecord : std::uint8_t {
  footer = 2,
  schema = 3,
  channel = 4,
  message = 5,
  chunk = 6,
  data_end = 15
};

class McapReader {
 public:
  McapReader(const std::filesystem::path& path, const MessageVisitor& visit, Warnings& warnings)
      : path_(path), visit_(visit), warnings_(warnings), file_(path) {}

  void read() {
    if (file_.left() < kMcapMagic.size() || file_.read(kMcapMagic.size()) != kMcapMagic) {
      file_.fail_at(0, "the file is not an MCAP file");
    }
    read_summary();
    while (read_record()) {
    }
    warn_of_left_out(path_, without_channel_, "have no channel record (perhaps a chunk is damaged)",
                     warnings_);
  }

 private:
  // Reads schemas and channels, which the summary repeats, because their first records may be in a
  // damaged chunk.
  void read_summary() {
    constexpr std::size_t kFooter = kMcapHead + 20;  // before the magic bytes at the end
    const std::uint64_t begin = file_.offset();
    if (file_.left() < kFooter + kMcapMagic.size()) return;
    try {
      file_.seek(begin + file_.left() - kFooter - kMcapMagic.size());
      ByteReader footer(file_.read(kFooter));
      const McapRecord last{footer.number<std::uint8_t>()};
      (void)footer.number<std::uint64_t>();
      const auto summary = footer.number<std::uint64_t>();
      for (file_.seek(summary); last == McapRecord::footer && summary > begin;) {
        ByteReader head(file_.read(kMcapHead));
        const McapRecord kind{head.number<std::uint8_t>()};
        const auto length = head.number<std::uint64_t>();
        if (kind == McapRecord::footer) break;
        if (kind == McapRecord::schema || kind == McapRecord::channel) {
          take(kind, file_.read(length));
        } else {
          file_.skip(length);
        }
      }
    } catch (const Error&) {  // the summary is damaged; it is rarely needed
    }
    file_.seek(begin);
  }

  // False at the end.
  bool read_record() {
    begin_ = file_.offset();
    std::uint64_t length = 0;
    McapRecord kind{};
    if (file_.left() >= kMcapHead) {
      ByteReader head(file_.read(kMcapHead));
      kind = McapRecord{head.number<std::uint8_t>()};
      length = head.number<std::uint64_t>();
      if (kind == McapRecord::data_end || kind == McapRecord::footer) return false;
    }
    const bool is_cut = file_.offset() == begin_ || length > file_.left();
    if (is_cut) {
      file_.warn_of_cut(begin_, warnings_);
      if (kind != McapRecord::chunk) return false;
      length = file_.left();
    }
    if (kind == McapRecord::chunk) {
      read_chunk(file_.read(length), is_cut);
    } else if (is_taken(kind)) {
      take(kind, file_.read(length));
    } else {
      file_.skip(length);
    }
    return !is_cut;
  }

  static bool is_taken(McapRecord kind) {
    return kind == McapRecord::schema || kind == McapRecord::channel || kind == McapRecord::message;
  }

  void read_chunk(std::string_view bytes, bool is_cut) {
    std::uint32_t checksum = 0;
    constexpr std::size_t kFixed = 32;  // bytes before the name of the compression
    if (is_cut && bytes.size() < kFixed + 16) return;
    const std::string why = file_.checked(begin_, [&] {
      ByteReader chunk(bytes);
      (void)chunk.bytes(16);  // times of its messages
      const auto size = chunk.number<std::uint64_t>();
      checksum = chunk.number<std::uint32_t>();
      const std::string_view packing = chunk.text();
      const auto packed = chunk.number<std::uint64_t>();
      return unpack(packing, chunk.bytes(is_cut ? chunk.left() : packed), size, unpacked_);
    });
    const auto* data = reinterpret_cast<const Bytef*>(unpacked_.data());
    if (why.empty() && checksum != 0 &&
        crc32(0, data, static_cast<uInt>(unpacked_.size())) != checksum) {
      warnings_.add(file_.at(begin_, "a chunk is left out, because its checksum does not match"));
      return;
    }
    if (!why.empty() && !is_cut) {
      warnings_.add(file_.at(begin_, "a damaged chunk is left out: " + why));
      return;
    }
    for (ByteReader records(unpacked_); records.left() >= kMcapHead;) {
      const McapRecord kind{records.number<std::uint8_t>()};
      const auto length = records.number<std::uint64_t>();
      if (length > records.left() && !why.empty()) return;
      take(kind, file_.checked(begin_, [&] { return records.bytes(length); }));
    }
  }

  void take(McapRecord kind, std::string_view bytes) {
    if (!is_taken(kind)) return;
    ByteReader record(bytes);
    const auto id = file_.checked(begin_, [&] { return record.number<std::uint16_t>(); });
    if (kind == McapRecord::schema) {
      schemas_[id] = std::string(file_.checked(begin_, [&] { return record.text(); }));
    } else if (kind == McapRecord::channel) {
      file_.checked(begin_, [&] {
        const auto schema = schemas_.find(record.number<std::uint16_t>());
        Topic topic{std::string(record.text()), "", MessageEncoding::other};
        const std::string_view encoding = record.text();
        if (encoding == "cdr") topic.encoding = MessageEncoding::cdr;
        if (encoding == "ros1") topic.encoding = MessageEncoding::ros1;
        if (schema != schemas_.end()) topic.type = message_type(schema->second);
        topics_.insert_or_assign(id, std::move(topic));
      });
    } else {
      file_.checked(begin_, [&] { return record.bytes(20); });  // sequence number, times of writing
      const auto topic = topics_.find(id);
      if (topic == topics_.end()) {
        ++without_channel_;
        return;
      }
      visit_({topic->second, record.bytes(record.left()), path_, begin_});
    }
  }

  const std::filesystem::path& path_;
  const MessageVisitor& visit_;
  Warnings& warnings_;
  InputFile file_;
  std::uint64_t begin_ = 0;  // of the record
  std::size_t without_channel_ = 0;
  std::string unpacked_;
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, Topic> topics_;
};

}  // namespace

void read_mcap(const std::filesystem::path& file, const MessageVisitor& visit, Warnings& warnings) {
  McapReader(file, visit, warnings).read();
}

}  // namespace viewgain
