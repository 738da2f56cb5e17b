// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

namespace viewgain {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

template <typename Number, typename... Format>
std::string number_text(Number value, Format... format) {
  if (std::isnan(value)) return "nan";
  std::array<char, 40> digits;
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value, format...);
  return {digits.data(), result.ptr};
}

}  // namespace

std::string short_text(double value) { return number_text(value); }
std::string short_text(float value) { return number_text(value); }
std::string exact_text(double value) { return number_text(value, std::chars_format::general, 17); }

std::string quoted(std::string_view word) {
  std::string text = "'";
  for (const char c : word.substr(0, 32)) text += (c >= ' ' && c <= '~') ? c : '?';
  return text + (word.size() > 32 ? "...'" : "'");
}

LineReader::LineReader(std::string name, std::string_view bytes)
    : name_(std::move(name)), rest_(bytes) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // written first by some editors
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
  const std::size_t end = rest_.find_first_of("\r\n");
  const bool has_return = end != std::string_view::npos && rest_[end] == '\r';
  if (has_return && !rest_.substr(end + 1).starts_with('\n')) line_end_ = '\r';
}

bool LineReader::next() {
  words_.clear();
  if (rest_.empty()) return false;
  ++line_;
  const std::size_t end = rest_.find(line_end_);
  const std::string_view line = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  for (std::size_t i = 0; i < line.size();) {
    while (i < line.size() && is_blank(line[i])) ++i;
    const std::size_t begin = i;
    while (i < line.size() && !is_blank(line[i])) ++i;
    if (i > begin) words_.push_back(line.substr(begin, i - begin));
  }
  return true;
}

void LineReader::fail(const std::string& what) const {
  throw Error(ErrorCode::format, name_ + ":" + std::to_string(line_) + ": " + what);
}

std::string_view LineReader::word_at(std::size_t word) const {
  if (word >= words_.size()) fail("a number is missing");
  return words_[word];
}

double LineReader::number(std::size_t word) const { return number_of(word_at(word)); }

double LineReader::number_of(std::string_view word) const {
  std::string_view digits = word;
  // Some writers print a plus sign, which from_chars does not accept.
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  double value = 0;
  const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (code == std::errc::result_out_of_range)
    fail("the number " + quoted(word) + " is out of range");
  if (code != std::errc{} || end != digits.data() + digits.size()) {
    fail(quoted(word) + " is not a number");
  }
  return value;
}

double LineReader::finite_number(std::size_t word) const {
  const double value = number(word);
  if (!std::isfinite(value)) fail("the number " + quoted(word_at(word)) + " is not finite");
  return value;
}

std::uint64_t LineReader::count(std::size_t word, std::uint64_t most) const {
  const std::string_view text = word_at(word);
  std::uint64_t value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code == std::errc::result_out_of_range || (code == std::errc{} && value > most)) {
    fail("the count " + quoted(text) + " is too large");
  }
  if (code != std::errc{} || end != text.data() + text.size()) {
    fail(quoted(text) + " is not a whole number");
  }
  return value;
}

}  // namespace viewgain
