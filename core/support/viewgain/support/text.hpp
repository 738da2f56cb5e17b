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
/// Text of files and messages. Numbers do not depend on the process's locale. Functions that make
/// text take any value and never throw.

namespace viewgain {

/// The shortest text that reads back as the same number; "nan", "inf" or "-inf" if it is not
/// finite.
[[nodiscard]] VIEWGAIN_EXPORT std::string short_text(double value);
/// As above.
[[nodiscard]] VIEWGAIN_EXPORT std::string short_text(float value);

/// With up to 17 significant digits, so that it reads back as the same double.
[[nodiscard]] VIEWGAIN_EXPORT std::string exact_text(double value);

/// A word from a file, for a message: in quotes, printable, at most 32 characters.
[[nodiscard]] VIEWGAIN_EXPORT std::string quoted(std::string_view word);

/// The lines of a text, or of a binary file's header, from the front, cut into words at blanks. A
/// byte order mark before the first is skipped. Lines end at \n or \r\n, or all at \r if the first
/// does. Failures name file and line. Thread safety: one call at a time. Cost: one pass over the
/// text.
class VIEWGAIN_EXPORT LineReader {
 public:
  /// `name` is the file's name in messages; `bytes` must outlive the reader.
  LineReader(std::string name, std::string_view bytes);

  /// Moves to the next line; false at the end.
  bool next();
  /// Words of the last line read, in order; valid until the next call of next().
  [[nodiscard]] const std::vector<std::string_view>& words() const { return words_; }
  /// The text after the current line.
  [[nodiscard]] std::string_view rest() const { return rest_; }
  /// The file's name, for messages.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Number of the last line read, from 1.
  [[nodiscard]] std::size_t line() const { return line_; }

  /// Throws Error(format): "file:line: what".
  [[noreturn]] void fail(const std::string& what) const;
  /// The word as a number, NaN and infinities included; fails otherwise.
  [[nodiscard]] double number(std::size_t word) const;
  /// Like number(), for a word that need not be in the current line.
  [[nodiscard]] double number_of(std::string_view word) const;
  /// The word as a finite number; fails otherwise.
  [[nodiscard]] double finite_number(std::size_t word) const;
  /// The word as a whole number from 0 to `most`; fails otherwise.
  [[nodiscard]] std::uint64_t count(std::size_t word, std::uint64_t most) const;

 private:
  [[nodiscard]] std::string_view word_at(std::size_t word) const;

  std::string name_;
  std::string_view rest_;
  std::vector<std::string_view> words_;
  std::size_t line_ = 0;
  char line_end_ = '\n';
};

/// Edit distance: number of letters to add, remove, change or swap with a neighbour. A letter is
/// not changed again after a swap.
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

/// The name that was probably meant: the one with the fewest edits, at most one per three letters,
/// or one that begins with the given text. Empty if none is near. Ties go to the first.
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

/// "; did you mean NAME?", or nothing.
[[nodiscard]] inline std::string did_you_mean(std::string_view given,
                                              const std::vector<std::string>& names) {
  const std::optional<std::string> nearest = nearest_name(given, names);
  return nearest ? "; did you mean " + *nearest + "?" : std::string();
}

/// "a, b, c"
[[nodiscard]] inline std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text.append(text.empty() ? "" : ", ").append(name);
  return text;
}

/// Index of a name in `names`. Throws Error(invalid_argument) with `what` that lists the valid
/// names.
[[nodiscard]] inline std::size_t place_of_name(std::string_view name,
                                               const std::vector<std::string>& names,
                                               std::string_view what) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  refuse(std::string("unknown ").append(what).append(" '") + std::string(name) +
         "'; valid values: " + listed(names));
}

}  // namespace viewgain
