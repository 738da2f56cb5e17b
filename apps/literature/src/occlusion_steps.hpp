// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>

namespace viewgain::detail {

/// Steps behind a measured surface, by brick of 8³ voxels in table coordinates (ClassicTable).
class OcclusionSteps {
 public:
  static constexpr std::uint8_t kNone = 0;
  using Brick = std::array<std::uint8_t, 512>;  ///< x << 6 | y << 3 | z
  using Place = std::array<std::int32_t, 3>;    ///< of a brick: x / 8, y / 8, z / 8

  /// The least of what is said of a voxel counts; `steps` is above 0.
  void mark(std::int32_t x, std::int32_t y, std::int32_t z, std::uint8_t steps) {
    const Place place{x >> 3, y >> 3, z >> 3};
    if (last_ == nullptr || place != last_place_) {
      std::unique_ptr<Brick>& found = bricks_[place];
      if (!found) found = std::make_unique<Brick>();
      last_place_ = place;
      last_ = found.get();
    }
    lower((*last_)[static_cast<std::size_t>((x & 7) << 6 | (y & 7) << 3 | (z & 7))], steps);
  }

  void merge(const OcclusionSteps& other) {
    for (const auto& [place, brick] : other.bricks_) {
      std::unique_ptr<Brick>& own = bricks_[place];
      if (!own) own = std::make_unique<Brick>();
      for (std::size_t i = 0; i < brick->size(); ++i) {
        if ((*brick)[i] != kNone) lower((*own)[i], (*brick)[i]);
      }
    }
  }

  [[nodiscard]] const std::map<Place, std::unique_ptr<Brick>>& bricks() const { return bricks_; }

 private:
  static void lower(std::uint8_t& own, std::uint8_t steps) {
    if (own == kNone || steps < own) own = steps;
  }

  std::map<Place, std::unique_ptr<Brick>> bricks_;
  Place last_place_{};
  Brick* last_ = nullptr;
};

}  // namespace viewgain::detail
