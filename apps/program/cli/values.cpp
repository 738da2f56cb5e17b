// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/values.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace viewgain::app {
namespace {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

std::string general_text(double value, int digits) {
  if (std::isnan(value)) return "nan";
  std::array<char, 40> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                          std::chars_format::general, digits);
  return {buffer.data(), end};
}

}  // namespace

void refuse(std::string_view flag, std::string_view value, const std::string& what) {
  refuse(std::string(flag) + " " + std::string(value) + ": " + what);
}

std::vector<double> parse_numbers(std::string_view flag, std::string_view text,
                                  std::size_t min_count, std::size_t max_count) {
  std::vector<double> numbers;
  std::string_view rest = text;
  for (bool more = true; more;) {
    const std::size_t comma = rest.find(',');
    more = comma != std::string_view::npos;
    std::string_view word = trimmed(rest.substr(0, comma));
    if (more) rest.remove_prefix(comma + 1);
    if (word.size() > 1 && word.front() == '+') word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size()) {
      refuse(flag, text, std::string("\"").append(word).append("\" is not a number"));
    }
    if (!std::isfinite(value)) refuse(flag, text, "the numbers must be finite");
    numbers.push_back(value);
  }
  if (numbers.size() < min_count || numbers.size() > max_count) {
    refuse(flag, text,
           "expected " + std::to_string(min_count) +
               (min_count == max_count ? "" : " to " + std::to_string(max_count)) +
               " numbers separated by commas; found " + std::to_string(numbers.size()));
  }
  return numbers;
}

std::size_t parse_count(std::string_view flag, double value) {
  constexpr double kMaxCount = 1e7;
  if (!(value >= 0 && value <= kMaxCount && value == std::floor(value))) {
    refuse(flag, short_text(value), "the value must be a whole number from 0 to 10000000");
  }
  return static_cast<std::size_t>(value);
}

Box box_of(std::string_view flag, const std::vector<double>& numbers) {
  const Box box{{numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]}};
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(box.min[k] < box.max[k])) {
      refuse(flag, describe(box), "the box is inside out or empty");
    }
  }
  return box;
}

Box parse_box(std::string_view flag, std::string_view text) {
  return box_of(flag, parse_numbers(flag, text, 6, 6));
}

std::array<double, 3> parse_size(std::string_view flag, std::string_view text) {
  const std::vector<double> n = parse_numbers(flag, text, 3, 3);
  for (const double length : n) {
    if (!(length > 0)) refuse(flag, text, "width, height and depth must be positive");
  }
  return {n[0], n[1], n[2]};
}

Pose parse_pose(std::string_view flag, std::string_view text) {
  const std::vector<double> n = parse_numbers(flag, text, 7, 7);
  const Eigen::Quaterniond q(n[6], n[3], n[4], n[5]);
  if (!(std::abs(q.norm() - 1) < 1e-2)) {
    refuse(flag, text,
           "the quaternion qx,qy,qz,qw has norm " + short_text(q.norm()) + "; expected 1");
  }
  return {q.normalized().toRotationMatrix(), Eigen::Vector3d(n[0], n[1], n[2])};
}

Eigen::Vector3d parse_point(std::string_view flag, std::string_view text) {
  const std::vector<double> n = parse_numbers(flag, text, 3, 3);
  return {n[0], n[1], n[2]};
}

std::string fault_of_name(const std::string& value, const std::vector<std::string>& names,
                          const char* what) {
  if (std::find(names.begin(), names.end(), value) != names.end()) return {};
  const std::string nearest = did_you_mean(value, names);
  return "unknown " + std::string(what) + " " + value +
         (nearest.empty() ? "; valid values: " : nearest + " Valid values: ") + listed(names);
}

std::vector<std::string> names_in(std::string_view text) {
  std::vector<std::string> names;
  for (std::size_t begin = 0; !text.empty() && begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    names.emplace_back(trimmed(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return names;
}

std::string describe(const Box& box) {
  std::string text;
  for (const auto& corner : {box.min, box.max}) {
    for (const double value : corner) {
      text.append(text.empty() ? "" : ",").append(general_text(value, 10));
    }
  }
  return text;
}

std::string formatted(const char* format, ...) {
  std::array<char, 512> text{};
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text.data(), text.size(), format, arguments);
  va_end(arguments);
  return text.data();
}

std::string printable(std::string text) noexcept {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const auto before = static_cast<unsigned char>(i > 0 ? text[i - 1] : 0);
    if (c == '\n' || c == '\r') {
      text[i] = ' ';
    } else if (c < 0x20 || c == 0x7F) {
      text[i] = '?';
    } else if (before == 0xC2 && c >= 0x80 && c < 0xA0) {
      text[i - 1] = text[i] = '?';
    }
  }
  return text;
}

std::string with_commas(unsigned long long value) {
  const std::string digits = std::to_string(value);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

std::string with_unit(double value) {
  const char* unit = "";
  for (const char* next : {" k", " M", " G"}) {
    if (value < 1000) break;
    value /= 1000;
    unit = next;
  }
  return general_text(value, 3) + unit;
}

std::string counts_text(const std::map<std::string, std::size_t>& counts) {
  std::string text;
  for (const auto& [reason, count] : counts) {
    text.append(text.empty() ? "" : ", ").append(std::to_string(count)).append(" ").append(reason);
  }
  return text;
}

void print_mended(std::size_t poses) {
  if (poses == 0) return;
  std::printf("poses whose slightly inexact rotation was corrected: %zu\n", poses);
}

void check_finite(std::string_view flag, double value) {
  if (!std::isfinite(value)) refuse(flag, short_text(value), "the value must be finite");
}

void check_positive(std::string_view flag, double value) {
  if (!(value > 0 && std::isfinite(value))) {
    refuse(flag, short_text(value), "the value must be positive and finite");
  }
}

void check_at_least_0(std::string_view flag, double value) {
  if (!(value >= 0 && std::isfinite(value))) {
    refuse(flag, short_text(value), "the value must be at least 0 and finite");
  }
}

void check_inside_0_1(std::string_view flag, double value) {
  if (!(value > 0 && value < 1))
    refuse(flag, short_text(value), "the value must be between 0 and 1");
}

}  // namespace viewgain::app
