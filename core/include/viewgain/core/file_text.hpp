// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// The lines of a file, or of a binary file's header, from the front. Failures name file and line.
class VIEWGAIN_EXPORT LineReader {
 public:
  LineReader(std::string name, std::string_view bytes) : name_(std::move(name)), rest_(bytes) {}

  /// Moves to the next line; false at the end.
  bool next();
  [[nodiscard]] const std::vector<std::string_view>& words() const { return words_; }
  /// Behind the current line.
  [[nodiscard]] std::string_view rest() const { return rest_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::size_t line() const { return line_; }

  /// Throws Error(format): "file:line: what".
  [[noreturn]] void fail(const std::string& what) const;
  /// The word as a number, NaN and infinities included; fails otherwise.
  [[nodiscard]] double number(std::size_t word) const;
  /// The word as a whole number from 0 to `most`; fails otherwise.
  [[nodiscard]] std::uint64_t count(std::size_t word, std::uint64_t most) const;

 private:
  [[nodiscard]] std::string_view word_at(std::size_t word) const;

  std::string name_;
  std::string_view rest_;
  std::vector<std::string_view> words_;
  std::size_t line_ = 0;
};

/// For a message: at most 32 characters, printable, in quotes.
[[nodiscard]] VIEWGAIN_EXPORT std::string quoted(std::string_view word);

}  // namespace viewgain
