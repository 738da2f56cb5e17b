// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/pose_io.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "viewgain/core/atomic_file.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

constexpr double kMendable = 1e-2;   // rotations off by more are refused
constexpr double kUnnoticed = 1e-9;  // rotations off by less are taken as they are
constexpr double kLastRow = 1e-6;    // how far a matrix's last row may be from 0 0 0 1
constexpr std::size_t kMaxFileSize = std::size_t{1} << 30;  // [bytes]

std::string read_file(const fs::path& path) {
  std::error_code code;
  if (fs::is_directory(path, code)) {
    throw Error(ErrorCode::io, path.string() + ": is a directory");
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw Error(ErrorCode::io,
                path.string() + ": cannot open: " + std::generic_category().message(errno));
  }
  std::string contents;
  std::array<char, 65536> buffer;
  while (file) {
    file.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    contents.append(buffer.data(), static_cast<std::size_t>(file.gcount()));
    if (contents.size() > kMaxFileSize) {
      throw Error(ErrorCode::format, path.string() + ": larger than 1 GiB, no file of poses");
    }
  }
  if (file.bad()) throw Error(ErrorCode::io, path.string() + ": cannot read");
  return contents;
}

[[noreturn]] void fail(const fs::path& path, std::size_t line, const std::string& what) {
  throw Error(ErrorCode::format, path.string() + ":" + std::to_string(line) + ": " + what);
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

/// A word of the file for a message: short, printable.
std::string quoted(std::string_view word) {
  std::string text = "'";
  for (const char c : word.substr(0, 32)) text += (c >= ' ' && c <= '~') ? c : '?';
  return text + (word.size() > 32 ? "...'" : "'");
}

double parse_number(const fs::path& path, std::size_t line, std::string_view word) {
  std::string_view digits = word;
  // from_chars does not take a plus sign, some writers print one.
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  double value = 0;
  const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (code == std::errc::result_out_of_range) {
    fail(path, line, "the number " + quoted(word) + " is out of range");
  }
  if (code != std::errc{} || end != digits.data() + digits.size()) {
    fail(path, line, quoted(word) + " is not a number");
  }
  if (!std::isfinite(value)) fail(path, line, "the number " + quoted(word) + " is not finite");
  return value;
}

/// Takes the next line off the front of `text`, without its end.
std::string_view next_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

/// Takes the next word off the front of `line`; empty at its end.
std::string_view next_word(std::string_view& line) {
  std::size_t begin = 0;
  while (begin < line.size() && is_blank(line[begin])) ++begin;
  std::size_t end = begin;
  while (end < line.size() && !is_blank(line[end])) ++end;
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

void append_number(std::string& text, double value) {
  std::array<char, 64> digits;
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                    std::chars_format::general, 17);
  text.append(digits.data(), result.ptr);
}

}  // namespace

PoseList read_tum(const fs::path& path) {
  const std::string contents = read_file(path);
  PoseList list;
  std::string_view rest = contents;
  for (std::size_t line_number = 1; !rest.empty(); ++line_number) {
    std::string_view line = next_line(rest);
    std::string_view word = next_word(line);
    if (word.empty() || word.front() == '#') continue;

    std::array<double, 8> values{};
    std::size_t count = 0;
    for (; !word.empty(); word = next_word(line), ++count) {
      const double value = parse_number(path, line_number, word);
      if (count < values.size()) values[count] = value;
    }
    if (count != values.size()) {
      fail(path, line_number,
           "expected 8 numbers (timestamp tx ty tz qx qy qz qw), found " + std::to_string(count));
    }
    Eigen::Quaterniond q(values[7], values[4], values[5], values[6]);
    const double norm = q.norm();
    if (!(std::abs(norm - 1.0) <= kMendable)) {
      std::string text;
      append_number(text, norm);
      fail(path, line_number, "the quaternion's norm is " + text + ", not 1");
    }
    if (std::abs(norm - 1.0) > kUnnoticed) ++list.orthonormalized;
    q.normalize();
    list.poses.emplace_back(q.toRotationMatrix(), Eigen::Vector3d(values[1], values[2], values[3]));
    list.timestamps.push_back(values[0]);
  }
  if (list.poses.empty()) {
    throw Error(ErrorCode::format, path.string() + ": holds no pose");
  }
  return list;
}

void write_tum(const fs::path& path, std::span<const Pose> poses) {
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!(orthonormality_error(poses[i]) <= kMendable)) {
      throw Error(ErrorCode::invalid_argument,
                  path.string() + ": pose " + std::to_string(i) + " is not a rigid transform");
    }
    const Eigen::Quaterniond q = Eigen::Quaterniond(poses[i].rotation()).normalized();
    const Eigen::Vector3d t = poses[i].translation();
    text += std::to_string(i);
    for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
      text += ' ';
      append_number(text, value);
    }
    text += '\n';
  }
  write_file_atomically(path, text);
}

Pose read_pose_matrix(const fs::path& path, bool* orthonormalized) {
  const std::string contents = read_file(path);
  std::array<double, 16> values{};
  std::size_t count = 0;
  std::string_view rest = contents;
  for (std::size_t line_number = 1; !rest.empty(); ++line_number) {
    std::string_view line = next_line(rest);
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line), ++count) {
      const double value = parse_number(path, line_number, word);
      if (count < values.size()) values[count] = value;
    }
  }
  if (count != values.size()) {
    throw Error(ErrorCode::format, path.string() + ": expected 16 numbers (a 4x4 matrix), found " +
                                       std::to_string(count));
  }
  constexpr std::array<double, 4> kExpected{0, 0, 0, 1};
  for (std::size_t i = 0; i < 4; ++i) {
    if (std::abs(values[12 + i] - kExpected[i]) > kLastRow) {
      throw Error(ErrorCode::format, path.string() + ": the matrix's last row is not 0 0 0 1");
    }
  }
  Pose pose;
  for (std::size_t i = 0; i < 12; ++i) pose.m[i] = values[i];
  const double error = orthonormality_error(pose);
  if (!(error <= kMendable)) {
    throw Error(ErrorCode::format, path.string() + ": the matrix is not a rigid transform");
  }
  const bool mend = error > kUnnoticed;
  if (orthonormalized != nullptr) *orthonormalized = mend;
  return mend ? viewgain::orthonormalized(pose) : pose;
}

}  // namespace viewgain
