// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/columns/mapped_poses.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <system_error>

#include "viewgain/core/error.hpp"
#include "viewgain/support/columns/npy_header.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

constexpr double kMendable = 1e-2, kUnnoticed = 1e-9, kLastRow = 1e-6;  // as core's pose_io

Eigen::Quaterniond quaternion_of(const double* numbers) {
  return {numbers[6], numbers[3], numbers[4], numbers[5]};
}

}  // namespace

std::optional<Pose> pose_of_row(const std::array<double, kPoseColumns.size()>& numbers) {
  Eigen::Quaterniond q = quaternion_of(numbers.data());
  if (!(std::abs(q.norm() - 1.0) <= kMendable)) return std::nullopt;
  q.normalize();
  return Pose(q.toRotationMatrix(), Eigen::Vector3d(numbers[0], numbers[1], numbers[2]));
}

std::array<double, kPoseColumns.size()> row_of_pose(const Pose& pose) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(pose.rotation()).normalized();
  const Eigen::Vector3d t = pose.translation();
  return {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
}

MappedPoses::MappedPoses(const std::filesystem::path& path) : name_(path.string()) {
  const std::size_t head_bytes = npy_header_bytes(name_, file_head(path, 12));
  const NpyHeader header = parse_npy_header(name_, file_head(path, head_bytes));
  const auto refuse = [&](const std::string& what) {
    throw Error(ErrorCode::format, name_ + ": " + what);
  };
  if (header.is_fortran) refuse("is in Fortran's order");
  std::size_t bytes = header.row_bytes;
  if (header.fields.front().name.empty() && header.fields.size() == 1) {
    if (header.shape.size() != 3 || header.shape[1] != 4 || header.shape[2] != 4 ||
        header.fields.front().type != "<f8") {
      std::string shape;
      for (const std::uint64_t n : header.shape) shape += std::to_string(n) + ", ";
      if (header.shape.size() > 1) shape.resize(shape.size() - 2);
      refuse("is (" + shape + ") of " + header.fields.front().type +
             ", neither a structured array with tx, ty, tz, qx, qy, qz, qw nor (n, 4, 4) matrices "
             "of <f8");
    }
    numbers_ = 16;
    bytes *= 16;
    for (std::size_t i = 0; i < numbers_; ++i) offsets_[i] = i * sizeof(double);
  } else {
    if (header.shape.size() != 1) refuse("is no array of rows");
    for (const std::string name : kPoseColumns) {
      const auto field = std::find_if(header.fields.begin(), header.fields.end(),
                                      [&](const auto& f) { return f.name == name; });
      if (field == header.fields.end() || field->type != "<f8" || field->items != 1) {
        refuse("has no column " + name + " of <f8");
      }
      offsets_[numbers_++] = field->offset;
    }
  }
  rows_ = header.shape[0];
  row_bytes_ = bytes;
  if (rows_ == 0) refuse("holds no pose");
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  const bool is_there = file >= 0 && ::fstat(file, &status) == 0;
  mapped_bytes_ = header.data_offset + rows_ * row_bytes_;
  const bool is_whole = is_there && static_cast<std::uint64_t>(status.st_size) >= mapped_bytes_;
  if (is_whole) mapped_ = ::mmap(nullptr, mapped_bytes_, PROT_READ, MAP_PRIVATE, file, 0);
  const int failed = errno;
  if (file >= 0) ::close(file);
  if (is_there && !is_whole) refuse("is cut off: " + std::to_string(rows_) + " rows do not fit");
  if (!is_there || mapped_ == MAP_FAILED) {
    throw Error(ErrorCode::io, name_ + ": " + std::system_category().message(failed));
  }
  data_ = static_cast<const char*>(mapped_) + header.data_offset;
}

MappedPoses::~MappedPoses() { ::munmap(mapped_, mapped_bytes_); }

void MappedPoses::fail(std::size_t row, const std::string& what) const {
  throw Error(ErrorCode::format, name_ + ": row " + std::to_string(row) + ": " + what);
}

double MappedPoses::number(std::size_t row, std::size_t column) const {
  return value_at<double>(data_ + row * row_bytes_ + offsets_.at(column));
}

std::string MappedPoses::hash() const {
  return hash_of_poses(rows_, numbers_,
                       [this](std::size_t row, std::size_t i) { return number(row, i); });
}

Pose MappedPoses::at(std::size_t row, bool& orthonormalized) const {
  std::array<double, 16> n{};
  for (std::size_t i = 0; i < numbers_; ++i) {
    n.at(i) = number(row, i);
    if (!std::isfinite(n.at(i))) fail(row, "holds a number that is not finite");
  }
  if (numbers_ == kPoseColumns.size()) {
    const double norm = quaternion_of(n.data()).norm();
    const auto pose = pose_of_row({n[0], n[1], n[2], n[3], n[4], n[5], n[6]});
    if (!pose) fail(row, "the quaternion's norm is " + short_text(norm) + ", not 1");
    orthonormalized = std::abs(norm - 1.0) > kUnnoticed;
    return *pose;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    if (std::abs(n.at(12 + i) - (i == 3 ? 1.0 : 0.0)) > kLastRow) {
      fail(row, "the matrix's last row is not 0 0 0 1");
    }
  }
  Pose pose;
  std::copy_n(n.begin(), pose.m.size(), pose.m.begin());
  const double error = orthonormality_error(pose);
  if (!(error <= kMendable)) fail(row, "the matrix is not a rigid transform");
  orthonormalized = error > kUnnoticed;
  return orthonormalized ? viewgain::orthonormalized(pose) : pose;
}

}  // namespace viewgain
