// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/grid/grid_snapshot.hpp"

namespace viewgain::detail {

/// Counts occupied voxels that a file stores as whole cubes. A cube of any size takes a few bytes
/// in the file, but each voxel takes over a byte of memory. Without a limit, a forged file of a
/// hundred bytes could fill the memory.
class SolidVoxels {
 public:
  /// For the message: the file's name, and advice for the user.
  explicit SolidVoxels(std::string name, std::string advice = {})
      : name_(std::move(name)), advice_(std::move(advice)) {}

  /// Adds the box [min, max), at most 65,536 voxels per side. Throws Error(capacity) above 2^27 in
  /// total.
  void add(Index3 min, Index3 max) {
    const auto length = [](std::int32_t from, std::int32_t to) {
      return static_cast<std::uint64_t>(to - from);
    };
    count_ += length(min.x, max.x) * length(min.y, max.y) * length(min.z, max.z);
    if (count_ > kMost) {
      throw Error(ErrorCode::capacity,
                  name_ + ": solid parts of the map have more than 2^27 occupied voxels" + advice_);
    }
  }

 private:
  static constexpr std::uint64_t kMost = std::uint64_t{1} << 27U;

  std::string name_, advice_;
  std::uint64_t count_ = 0;
};

}  // namespace viewgain::detail
