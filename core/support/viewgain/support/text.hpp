// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "viewgain/core/export.hpp"

/// @file
/// Text of files and messages. Numbers do not depend on the process's locale. The functions for
/// text take any value and never throw.

namespace viewgain {

/// The shortest text that reads back as the same number; "nan", "inf" and "-inf" for the others.
[[nodiscard]] VIEWGAIN_EXPORT std::string short_text(double value);
/// As above.
[[nodiscard]] VIEWGAIN_EXPORT std::string short_text(float value);

/// With up to 17 significant digits, so that it reads back as the same double.
[[nodiscard]] VIEWGAIN_EXPORT std::string exact_text(double value);

/// A word of a file for a message: at most 32 characters, printable, in quotes.
[[nodiscard]] VIEWGAIN_EXPORT std::string quoted(std::string_view word);

/// The lines of a text, or of a binary file's header, from the front, cut into words at blanks. A
/// byte order mark before the first is skipped. Lines end at \n or \r\n, or all at \r if the first
/// does. Failures name file and line. Thread safety: one call at a time. Cost: all of the text is
/// gone through once.
class VIEWGAIN_EXPORT LineReader {
 public:
  /// `name` is the file's, for messages; `bytes` must outlive the reader.
  LineReader(std::string name, std::string_view bytes);

  /// Moves to the next line; false at the end.
  bool next();
  /// Words of the line that was read last, in their order; until the next call of next().
  [[nodiscard]] const std::vector<std::string_view>& words() const { return words_; }
  /// Behind the current line.
  [[nodiscard]] std::string_view rest() const { return rest_; }
  /// The file's name, for messages.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Number of the line that was read last, from 1.
  [[nodiscard]] std::size_t line() const { return line_; }

  /// Throws Error(format): "file:line: what".
  [[noreturn]] void fail(const std::string& what) const;
  /// The word as a number, NaN and infinities included; fails otherwise.
  [[nodiscard]] double number(std::size_t word) const;
  /// As number(), of a word that need not stand in the current line.
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

}  // namespace viewgain
