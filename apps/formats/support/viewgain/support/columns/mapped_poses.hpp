// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"

namespace viewgain {

/// Poses of a .npy file that is mapped into memory, so that only rows that are asked for are read.
/// Rows have columns tx, ty, tz [m], qx, qy, qz, qw of T_world_camera ("<f8", others are passed
/// over), or the array is one of matrices (n, 4, 4).
class VIEWGAIN_EXPORT MappedPoses {
 public:
  /// Throws Error(io), Error(format) that names the file.
  explicit MappedPoses(const std::filesystem::path& path);
  ~MappedPoses();
  MappedPoses(const MappedPoses&) = delete;
  MappedPoses& operator=(const MappedPoses&) = delete;

  [[nodiscard]] std::size_t size() const { return rows_; }
  /// The numbers of a row, hashed.
  [[nodiscard]] std::uint64_t hash(std::size_t row) const;
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
