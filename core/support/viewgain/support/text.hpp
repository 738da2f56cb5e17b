// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/error.hpp"
#include "viewgain/core/export.hpp"

/// @file
/// Reads and writes text of files and messages. The form of numbers does not depend on the locale
/// of the process. Functions that return text accept any value and never throw.

namespace viewgain {

/// The shortest text that reads back as the same number. For numbers that are not finite: "nan",
/// "inf" or "-inf".
[[nodiscard]] VIEWGAIN_EXPORT std::string short_text(double value);
/// As above.
[[nodiscard]] VIEWGAIN_EXPORT std::string short_text(float value);

/// Text with up to 17 significant digits, which reads back as the same double.
[[nodiscard]] VIEWGAIN_EXPORT std::string exact_text(double value);

/// A word from a file as it appears in a message: in quotes, printable, at most 32 characters.
[[nodiscard]] VIEWGAIN_EXPORT std::string quoted(std::string_view word);

/// Reads the lines of a text, or of a binary file's header, and splits them into words at blanks.
/// Skips a byte order mark at the beginning. Lines end with \n or \r\n; if the first line ends with
/// \r, all do. Errors name file and line. Thread safety: one call at a time. Cost: one pass over
/// the text.
class VIEWGAIN_EXPORT LineReader {
 public:
  /// `name` is the file's name in messages; `bytes` must outlive the reader.
  LineReader(std::string name, std::string_view bytes);

  /// Moves to the next line; false at the end.
  bool next();
  /// Words of the current line, in order. Valid until the next call of next().
  [[nodiscard]] const std::vector<std::string_view>& words() const { return words_; }
  /// The text after the current line.
  [[nodiscard]] std::string_view rest() const { return rest_; }
  /// The file's name, for messages.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Number of the current line, from 1.
  [[nodiscard]] std::size_t line() const { return line_; }

  /// Throws Error(format) with the message "file:line: what".
  [[noreturn]] void fail(const std::string& what) const;
  /// Word number `word` of the current line, from 0, as a number. NaN and infinities are allowed.
  /// Calls fail() if it is not a number.
  [[nodiscard]] double number(std::size_t word) const;
  /// As number(), for any text.
  [[nodiscard]] double number_of(std::string_view word) const;
  /// As number(). Calls fail() if it is not finite.
  [[nodiscard]] double finite_number(std::size_t word) const;
  /// As number(), for a whole number. Calls fail() if it is not in 0..most.
  [[nodiscard]] std::uint64_t count(std::size_t word, std::uint64_t most) const;

 private:
  [[nodiscard]] std::string_view word_at(std::size_t word) const;

  std::string name_;
  std::string_view rest_;
  std::vector<std::string_view> words_;
  std::size_t line_ = 0;
  char line_end_ = '\n';
};

/// Edit distance of two words: number of letters to add, remove, change or swap with a neighbour.
/// Letters that were swapped are not changed again (optimal string alignment).
[[nodiscard]] inline std::size_t edits_between(std::string_view a, std::string_view b) {
  std::vector<std::size_t> two_back(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(two_back, last);
    std::swap(last, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] =
          std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], two_back[j - 2] + 1);
      }
    }
  }
  return row[b.size()];
}

/// The name that was probably meant by `given`: the one with the smallest edit distance, at most
/// one edit per three letters. A name that begins with `given` counts as one edit. The first of
/// several equal names is returned. Empty if no name is near.
[[nodiscard]] inline std::optional<std::string> nearest_name(
    std::string_view given, const std::vector<std::string>& names) {
  std::optional<std::string> nearest;
  std::size_t least = std::max<std::size_t>(1, (given.size() + 1) / 3) + 1;
  for (const std::string& name : names) {
    const bool is_begun = given.size() >= 3 && name.starts_with(given);
    const std::size_t edits = is_begun ? 1 : edits_between(given, name);
    if (edits < least) least = edits, nearest = name;
  }
  return nearest;
}

/// Text for a message: "; did you mean NAME?" with nearest_name(), or nothing.
[[nodiscard]] inline std::string did_you_mean(std::string_view given,
                                              const std::vector<std::string>& names) {
  const std::optional<std::string> nearest = nearest_name(given, names);
  return nearest ? "; did you mean " + *nearest + "?" : std::string();
}

/// The names as text: "a, b, c".
[[nodiscard]] inline std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text.append(text.empty() ? "" : ", ").append(name);
  return text;
}

/// Index of a name in `names`. If it is missing, throws Error(invalid_argument) that lists the
/// valid names. `what` is the kind of name, such as "tracer".
[[nodiscard]] inline std::size_t place_of_name(std::string_view name,
                                               const std::vector<std::string>& names,
                                               std::string_view what) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  refuse(std::string("unknown ").append(what).append(" '") + std::string(name) +
         "'; valid values: " + listed(names));
}

}  // namespace viewgain
