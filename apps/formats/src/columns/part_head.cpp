// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/columns/part_head.hpp"

#include <array>
#include <charconv>
#include <tuple>
#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

// The lines before rows and scored: key and text.
constexpr std::array<std::pair<const char*, std::string PartHead::*>, 5> kTexts{
    {{"viewgain", &PartHead::version},
     {"map", &PartHead::map},
     {"sensor", &PartHead::sensor},
     {"settings", &PartHead::settings},
     {"isa", &PartHead::isa}}};

std::string poses_text(const PartHead& head) {
  return std::to_string(head.poses) + " " + head.poses_hash;
}

class HeadReader {
 public:
  HeadReader(const std::string& file, std::string_view rest) : file_(file), rest_(rest) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::format, file_ + ": line " + std::to_string(line_) + " of #: " + what);
  }
  // What stands behind "# key ".
  std::string_view value(const std::string& key) {
    ++line_;
    const std::string start = "# " + key + " ";
    const std::size_t end = rest_.find('\n');
    if (end == std::string_view::npos || !rest_.starts_with(start)) {
      fail("expected \"" + start + "...\"");
    }
    const std::string_view found = rest_.substr(start.size(), end - start.size());
    rest_.remove_prefix(end + 1);
    if (found.empty()) fail(key + " is empty");
    return found;
  }
  [[nodiscard]] std::uint64_t count(std::string_view word) const {
    std::uint64_t value = 0;
    const char* const end = word.data() + word.size();
    if (std::from_chars(word.data(), end, value).ptr != end || word.empty()) {
      fail(quoted(word) + " is no count");
    }
    return value;
  }
  // A word and what stands behind its separator.
  [[nodiscard]] std::pair<std::string_view, std::string_view> cut(std::string_view text,
                                                                  char separator) const {
    const std::size_t at = text.find(separator);
    if (at == std::string_view::npos) fail(quoted(text) + " lacks a " + quoted({&separator, 1}));
    return {text.substr(0, at), text.substr(at + 1)};
  }
  [[nodiscard]] bool has(std::string_view start) const { return rest_.starts_with(start); }
  void end() const {
    if (!rest_.empty()) fail("more lines follow");
  }

 private:
  const std::string& file_;
  std::string_view rest_;
  std::size_t line_ = 0;
};

}  // namespace

std::string text_of(const RowRange& rows) {
  return std::to_string(rows.begin) + ":" + std::to_string(rows.end);
}

std::string head_text(const PartHead& head) {
  std::string text;
  for (const auto& [key, member] : kTexts) {
    text.append("# ").append(key).append(" ").append(head.*member).append("\n");
  }
  text.append("# poses ").append(poses_text(head)).append("\n");
  text.append("# rows ").append(text_of(head.rows)).append("\n");
  text.append(head.is_best ? "# best " : "# scored ").append(std::to_string(head.scored));
  return text + "\n";
}

PartHead parse_head(const std::string& file, std::string_view text) {
  HeadReader reader(file, text);
  PartHead head;
  for (const auto& [key, member] : kTexts) head.*member = reader.value(key);
  const auto [poses, hash] = reader.cut(reader.value("poses"), ' ');
  head.poses = reader.count(poses);
  head.poses_hash = hash;
  const auto [begin, end] = reader.cut(reader.value("rows"), ':');
  head.rows = {reader.count(begin), reader.count(end)};
  if (head.rows.begin > head.rows.end || head.rows.end > head.poses) {
    reader.fail("rows " + text_of(head.rows) + " of " + std::to_string(head.poses));
  }
  head.is_best = reader.has("# best ");
  head.scored = reader.count(reader.value(head.is_best ? "best" : "scored"));
  if (head.scored > head.rows.end - head.rows.begin) reader.fail("more were scored than rows");
  reader.end();
  return head;
}

std::string difference(const PartHead& head, const PartHead& first, const std::string& first_file) {
  const auto differ = [&](const char* key, const std::string& mine, const std::string& other) {
    return std::string(key) + " " + mine + ", not " + other + " as in " + first_file;
  };
  for (const auto& [key, member] : kTexts) {
    if (head.*member != first.*member) return differ(key, head.*member, first.*member);
  }
  if (poses_text(head) != poses_text(first)) {
    return differ("poses", poses_text(head), poses_text(first));
  }
  return "";
}

}  // namespace viewgain
