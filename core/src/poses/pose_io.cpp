// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/pose_io.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

#include "viewgain/core/error.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/file_names.hpp"
#include "viewgain/support/pose_numbers.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

constexpr double kMendable = 1e-2;   // larger deviations are refused
constexpr double kUnnoticed = 1e-9;  // smaller deviations are ignored
constexpr double kTold = 1e-5;       // smaller deviations come from printing six decimals
constexpr double kLastRow = 1e-6;    // tolerance for a matrix's last row 0 0 0 1
constexpr std::uint64_t kMaxFileSize = std::uint64_t{1} << 30U;  // [bytes]

}  // namespace

std::array<double, kPoseColumns.size()> numbers_of_pose(const Pose& pose) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(pose.rotation()).normalized();
  const Eigen::Vector3d t = pose.translation();
  return {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
}

Pose pose_of_numbers(std::span<const double> numbers, bool& mended,
                     const std::function<void(const std::string&)>& fail) {
  if (numbers.size() == kPoseColumns.size()) {
    Eigen::Quaterniond q(numbers[6], numbers[3], numbers[4], numbers[5]);
    const double norm = q.norm();
    if (!(std::abs(norm - 1.0) <= kMendable)) {
      fail("the quaternion has norm " + short_text(norm) + "; expected 1");
    }
    mended = std::abs(norm - 1.0) > kTold;
    q.normalize();
    return {q.toRotationMatrix(), Eigen::Vector3d(numbers[0], numbers[1], numbers[2])};
  }
  for (std::size_t i = 0; i < 4; ++i) {
    if (std::abs(numbers[12 + i] - (i == 3 ? 1.0 : 0.0)) > kLastRow) {
      fail("the last row of the matrix must be 0 0 0 1");
    }
  }
  Pose pose;
  std::copy_n(numbers.begin(), pose.m.size(), pose.m.begin());
  const double error = orthonormality_error(pose);
  if (!(error <= kMendable)) fail("the matrix is not a rigid transform");
  mended = error > kTold;
  return error > kUnnoticed ? orthonormalized(pose) : pose;
}

Pose tum_line_pose(const LineReader& line, bool* orthonormalized) {
  std::array<double, 8> values{};
  const std::size_t count = line.words().size();
  for (std::size_t i = 0; i < count; ++i) {
    const double value = line.finite_number(i);
    if (i < values.size()) values[i] = value;
  }
  if (count != values.size()) {
    line.fail("expected 8 numbers (timestamp tx ty tz qx qy qz qw), found " +
              std::to_string(count));
  }
  bool mended = false;
  const Pose pose = pose_of_numbers(std::span(values).subspan(1), mended,
                                    [&](const std::string& what) { line.fail(what); });
  if (orthonormalized != nullptr) *orthonormalized = mended;
  return pose;
}

PoseList read_tum(const fs::path& path) {
  const std::string contents = file_bytes(path, kMaxFileSize);
  if (contents.starts_with("\x93NUMPY")) {
    throw Error(ErrorCode::format,
                path.string() + ": the file is a numpy array; rename it to end in .npy");
  }
  LineReader line(path.string(), contents);
  PoseList list;
  while (line.next()) {
    if (line.words().empty() || line.words().front().front() == '#') continue;
    bool mended = false;
    list.poses.push_back(tum_line_pose(line, &mended));
    list.timestamps.push_back(line.number(0));
    list.orthonormalized += mended ? 1 : 0;
  }
  if (list.poses.empty())
    throw Error(ErrorCode::format, path.string() + ": the file contains no pose");
  return list;
}

void write_tum(const fs::path& path, std::span<const Pose> poses) {
  std::vector<double> timestamps(poses.size());
  std::iota(timestamps.begin(), timestamps.end(), 0.0);
  write_tum(path, poses, timestamps);
}

void check_writable(const fs::path& path, std::span<const Pose> poses,
                    std::span<const double> timestamps) {
  if (timestamps.size() != poses.size()) {
    refuse(path.string() + ": one timestamp per pose is required; poses: " +
           std::to_string(poses.size()) + ", timestamps: " + std::to_string(timestamps.size()));
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!(orthonormality_error(poses[i]) <= kMendable)) {
      refuse(path.string() + ": pose " + std::to_string(i) + " is not a rigid transform");
    }
    if (!std::isfinite(timestamps[i])) {
      refuse(path.string() + ": timestamp " + std::to_string(i) + " is not finite");
    }
  }
}

void write_tum(const fs::path& path, std::span<const Pose> poses,
               std::span<const double> timestamps) {
  require_ending(path, "a TUM file of poses", {".txt", ".tum"});
  check_writable(path, poses, timestamps);
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  for (std::size_t i = 0; i < poses.size(); ++i) {
    text += exact_text(timestamps[i]);
    for (const double value : numbers_of_pose(poses[i])) text += ' ' + exact_text(value);
    text += '\n';
  }
  write_file_atomically(path, text);
}

Pose read_pose_matrix(const fs::path& path, bool* orthonormalized) {
  const std::string contents = folder_file_bytes(path, kMaxFileSize);
  LineReader line(path.string(), contents);
  std::array<double, 16> values{};
  std::size_t count = 0;
  while (line.next()) {
    for (std::size_t i = 0; i < line.words().size(); ++i, ++count) {
      const double value = line.finite_number(i);
      if (count < values.size()) values[count] = value;
    }
  }
  if (count != values.size()) {
    throw Error(ErrorCode::format, path.string() + ": expected 16 numbers (a 4x4 matrix), found " +
                                       std::to_string(count));
  }
  bool mended = false;
  const Pose pose = pose_of_numbers(values, mended, [&](const std::string& what) {
    throw Error(ErrorCode::format, path.string() + ": " + what);
  });
  if (orthonormalized != nullptr) *orthonormalized = mended;
  return pose;
}

}  // namespace viewgain
