// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/support/hash64.hpp"

namespace viewgain {

/// The columns of a pose's row: tx, ty, tz [m], qx, qy, qz, qw of T_world_camera.
inline constexpr std::array kPoseColumns{"tx", "ty", "tz", "qx", "qy", "qz", "qw"};

/// These numbers of a pose; NaN for one that is not finite.
[[nodiscard]] VIEWGAIN_EXPORT std::array<double, kPoseColumns.size()> row_of_pose(const Pose& pose);

/// Names a list of poses, 16 digits, by how many there are and all numbers of their rows:
/// number(row, column).
template <typename Number>
[[nodiscard]] std::string hash_of_poses(std::size_t rows, std::size_t columns,
                                        const Number& number) {
  Hash64 hash;
  hash.add(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t i = 0; i < columns; ++i) hash.add_number(number(row, i));
  }
  return hash.hex();
}

/// Of these numbers, the quaternion normalised; nothing where its norm is off by more than 1e-2.
[[nodiscard]] VIEWGAIN_EXPORT std::optional<Pose> pose_of_row(
    const std::array<double, kPoseColumns.size()>& numbers);

/// Poses of a .npy file that is mapped into memory, so that only rows that are asked for are read.
/// Rows have kPoseColumns ("<f8", others are passed over), or the array is one of matrices
/// (n, 4, 4).
class VIEWGAIN_EXPORT MappedPoses {
 public:
  /// Throws Error(io), Error(format) that names the file.
  explicit MappedPoses(const std::filesystem::path& path);
  ~MappedPoses();
  MappedPoses(const MappedPoses&) = delete;
  MappedPoses& operator=(const MappedPoses&) = delete;

  [[nodiscard]] std::size_t size() const { return rows_; }
  /// hash_of_poses(). Reads the whole file.
  [[nodiscard]] std::string hash() const;
  /// A row as a pose, mended as read_tum() and read_pose_matrix() do; *orthonormalized says
  /// whether. Throws Error(format) that names file and row as they do.
  [[nodiscard]] Pose at(std::size_t row, bool& orthonormalized) const;

 private:
  [[noreturn]] void fail(std::size_t row, const std::string& what) const;
  [[nodiscard]] double number(std::size_t row, std::size_t column) const;

  std::string name_;
  std::size_t rows_ = 0, row_bytes_ = 0, numbers_ = 0;
  std::array<std::size_t, 16> offsets_{};  // of the numbers in a row [bytes]
  const char* data_ = nullptr;             // of the first row
  void* mapped_ = nullptr;
  std::size_t mapped_bytes_ = 0;
};

}  // namespace viewgain
