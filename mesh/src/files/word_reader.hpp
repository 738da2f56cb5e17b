// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

#include "viewgain/support/text.hpp"

namespace viewgain::detail {

/// Number of words of a line before a comment, which begins with '#'.
inline std::size_t words_before_comment(const LineReader& lines) {
  const auto& words = lines.words();
  const auto comment = std::find_if(words.begin(), words.end(),
                                    [](std::string_view word) { return word.front() == '#'; });
  return static_cast<std::size_t>(comment - words.begin());
}

/// The text. If its lines end in several ways, a copy in which all end in \n; otherwise a line
/// after a comment or a name would be lost.
inline std::string_view with_one_line_end(std::string_view text, std::string& copy) {
  const auto is_return_alone = [text](std::size_t i) {
    return text[i] == '\r' && !text.substr(i + 1).starts_with('\n');
  };
  std::size_t i = 0;
  while (i < text.size() && !is_return_alone(i)) ++i;
  if (i == text.size() || text.find('\n') == std::string_view::npos) return text;
  copy.clear();
  for (i = 0; i < text.size(); ++i) {
    if (text[i] != '\r') {
      copy += text[i];
    } else if (is_return_alone(i) && !text.substr(i + 1).starts_with('\r')) {
      copy += '\n';
    }
  }
  return copy;
}

/// The words of a text one by one, regardless of lines, without comments.
class WordReader {
 public:
  explicit WordReader(LineReader& lines) : lines_(lines) {}

  /// Whether this line has another word.
  [[nodiscard]] bool more_here() const { return at_ < count_; }
  /// Whether another word follows; advances to its line.
  bool more() {
    while (!more_here()) {
      if (!lines_.next()) return false;
      at_ = 0;
      count_ = words_before_comment(lines_);
    }
    return true;
  }
  /// The word after the next one; empty if the next word is the last of its line.
  [[nodiscard]] std::string_view second_here() const {
    return at_ + 1 < count_ ? lines_.words()[at_ + 1] : std::string_view();
  }
  /// The next word, which next() consumes. Both fail at the end of the file.
  std::string_view peek() {
    if (!more()) lines_.fail("the file ends too early");
    return lines_.words()[at_];
  }
  std::string_view next() {
    const std::string_view word = peek();
    ++at_;
    return word;
  }

  /// The next word, which must be a number.
  double number() { return lines_.number_of(next()); }
  double finite_number() {
    (void)peek();
    return lines_.finite_number(at_++);
  }
  double whole_number() {
    const double value = number();
    if (value != std::floor(value)) {
      lines_.fail(quoted(lines_.words()[at_ - 1]) + " is not a whole number");
    }
    return value;
  }
  [[nodiscard]] std::size_t line() const { return lines_.line(); }

 private:
  LineReader& lines_;
  std::size_t at_ = 0, count_ = 0;
};

}  // namespace viewgain::detail
