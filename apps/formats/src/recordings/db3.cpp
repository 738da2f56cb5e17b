// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// rosbag2's files of SQLite: the tables `topics` and `messages`.
#include <sqlite3.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <system_error>

#include "recordings/input_file.hpp"
#include "recordings/messages.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

class Db3Reader {
 public:
  Db3Reader(const std::filesystem::path& path, const MessageVisitor& visit, Warnings& warnings)
      : path_(path), visit_(visit), warnings_(warnings) {
    // No value is larger than the file, but pages that refer to each other could form one.
    const std::uint64_t most = std::min(kMostRecordBytes, InputFile(path).left() + 4096);
    sqlite3* opened = nullptr;
    // Immutable mode writes no files next to the database and waits for no lock.
    const int code = sqlite3_open_v2(uri(path).c_str(), &opened,
                                     SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
    db_.reset(opened);
    if (code != SQLITE_OK) fail(ErrorCode::io, "the file cannot be opened");
    // The file is untrusted: no functions in its schema, no huge values.
    sqlite3_limit(opened, SQLITE_LIMIT_LENGTH, static_cast<int>(most));
    sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_db_config(opened, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
    sqlite3_db_config(opened, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
    // Needed to read a truncated file at all. Nothing can be written.
    sqlite3_exec(opened, "PRAGMA writable_schema = ON; PRAGMA cell_size_check = ON", nullptr,
                 nullptr, nullptr);
  }

  void read() {
    read_topics();
    warn_of_journal();
    const Statement rows = prepared("SELECT rowid, topic_id, data FROM messages ORDER BY rowid");
    last_row_ = INT64_MIN;
    std::size_t without_topic = 0;
    while (next(rows.get())) {
      const auto topic = topics_.find(sqlite3_column_int64(rows.get(), 1));
      if (topic == topics_.end()) {
        ++without_topic;
        continue;
      }
      const auto* bytes = static_cast<const char*>(sqlite3_column_blob(rows.get(), 2));
      const auto size = static_cast<std::size_t>(sqlite3_column_bytes(rows.get(), 2));
      visit_({topic->second, bytes == nullptr ? std::string_view() : std::string_view(bytes, size),
              path_, static_cast<std::uint64_t>(sqlite3_column_int64(rows.get(), 0))});
    }
    warn_of_left_out(path_, without_topic, "belong to topics that the file does not list",
                     warnings_);
  }

 private:
  using Statement = std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)>;

  static std::string uri(const std::filesystem::path& path) {
    std::string text = "file:", name = std::filesystem::absolute(path).string();
    while (name.starts_with("//")) name.erase(0, 1);  // else a host follows
    for (const char c : name) {
      constexpr std::string_view kDigits = "0123456789ABCDEF";
      if (c == '?' || c == '#' || c == '%') {
        text += {'%', kDigits[static_cast<unsigned char>(c) / 16],
                 kDigits[static_cast<unsigned char>(c) % 16]};
      } else {
        text += c;
      }
    }
    return text + "?immutable=1";
  }

  [[noreturn]] void fail(ErrorCode code, const std::string& what) const {
    throw Error(code, path_.string() + ": " + what +
                          (db_ ? std::string(": ") + sqlite3_errmsg(db_.get()) : ""));
  }

  Statement prepared(const char* sql) const {
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(db_.get(), sql, -1, &statement, nullptr) != SQLITE_OK) {
      fail(ErrorCode::format, "the file is not an SQLite file of rosbag2");
    }
    return {statement, &sqlite3_finalize};
  }

  // False at the end, also if the rest is damaged or missing. SQLite reports damaged sizes as a
  // lack of memory.
  bool next(sqlite3_stmt* statement) {
    int code = sqlite3_step(statement);
    if (code == SQLITE_ROW) {
      // Repeated rows come from pages that form a cycle.
      const std::int64_t row = sqlite3_column_int64(statement, 0);
      if (row > last_row_) return last_row_ = row, true;
      code = SQLITE_CORRUPT;
    }
    if (code != SQLITE_DONE) {
      warnings_.add(path_.string() + ": " + sqlite3_errmsg(db_.get()) +
                    ". The file is truncated or damaged; the part before the damage is used");
    }
    return false;
  }

  void read_topics() {
    const Statement rows =
        prepared("SELECT rowid, id, name, type, serialization_format FROM topics ORDER BY rowid");
    const auto text = [&](int column) {
      const auto* bytes = sqlite3_column_text(rows.get(), column);
      return bytes == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(bytes));
    };
    while (next(rows.get())) {
      topics_.insert_or_assign(
          sqlite3_column_int64(rows.get(), 1),
          Topic{text(2), message_type(text(3)),
                text(4) == "cdr" ? MessageEncoding::cdr : MessageEncoding::other});
    }
  }

  // An interrupted recorder leaves messages in the journal.
  void warn_of_journal() {
    std::error_code ignored;
    const std::filesystem::path journal = path_.string() + "-wal";
    if (!std::filesystem::exists(journal, ignored) ||
        std::filesystem::file_size(journal, ignored) == 0) {
      return;
    }
    warnings_.add(
        journal.string() +
        ": the file is not read. The recorder was interrupted; add the messages to the .db3 file "
        "with `sqlite3 FILE.db3 vacuum`");
  }

  const std::filesystem::path& path_;
  const MessageVisitor& visit_;
  Warnings& warnings_;
  std::unique_ptr<sqlite3, decltype(&sqlite3_close)> db_{nullptr, &sqlite3_close};
  std::map<std::int64_t, Topic> topics_;
  std::int64_t last_row_ = INT64_MIN;
};

}  // namespace

void read_db3(const std::filesystem::path& file, const MessageVisitor& visit, Warnings& warnings) {
  Db3Reader(file, visit, warnings).read();
}

}  // namespace viewgain
