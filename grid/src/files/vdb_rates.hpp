// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>

#include "vdb_contents.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/hazard.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::detail {

/// Hazard rates in a .vdb file of any program.
class RateReader {
 public:
  RateReader(const std::filesystem::path& path, const VdbContents& contents)
      : path_(path), rates_(grid_of(contents)) {
    if (!rates_->transform().isLinear())
      fail("the hazard rates have a transform that is not linear");
  }

  [[nodiscard]] HazardConfig::Volume rates_in(const BeliefGrid& grid) const {
    HazardConfig::Volume volume;
    volume.outside = checked(rates_->background());
    const VoxelBox& box = volume.box = touched_by_active(grid);
    check_place(grid, box);
    volume.rates.reserve(static_cast<std::size_t>(box.volume()));
    const openvdb::tree::ValueAccessor<const openvdb::FloatTree, false> values(rates_->tree());
    for (std::int32_t x = box.min.x; x < box.max.x; ++x) {
      for (std::int32_t y = box.min.y; y < box.max.y; ++y) {
        for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
          const Eigen::Vector3d p = grid.center({x, y, z});
          const openvdb::Vec3d at = rates_->worldToIndex({p.x(), p.y(), p.z()});
          float rate = 0;
          const bool is_set = is_index(at) && values.probeValue(openvdb::Coord::round(at), rate);
          volume.rates.push_back(checked(is_set ? rate : volume.outside));
        }
      }
    }
    return volume;
  }

 private:
  // Rates in other units or at another place would count as a single rate everywhere.
  void check_place(const BeliefGrid& grid, const VoxelBox& box) const {
    constexpr double kMost = 50;  // ratio of voxel sizes
    openvdb::CoordBBox active;
    if (!rates_->tree().evalActiveVoxelBoundingBox(active)) return;
    const openvdb::Vec3d sides = rates_->voxelSize();
    const double size = std::max({sides.x(), sides.y(), sides.z()});
    const double ratio = size / grid.voxel_size();
    if (ratio > kMost || ratio * kMost < 1) {
      mismatch("the hazard rates have voxels of " + short_text(size) +
               " m, but the map has voxels of " + short_text(grid.voxel_size()) + " m");
    }
    if (box.volume() == 0) {
      const openvdb::Vec3d low = rates_->indexToWorld(active.min().asVec3d());
      const openvdb::Vec3d high = rates_->indexToWorld(active.max().asVec3d());
      mismatch("all hazard rates lie outside the map: they lie between " + text_of(low) + " and " +
               text_of(high) + " m");
    }
  }
  [[nodiscard]] static std::string text_of(const openvdb::Vec3d& p) {
    return short_text(p.x()) + "," + short_text(p.y()) + "," + short_text(p.z());
  }
  [[noreturn]] void mismatch(const std::string& what) const {
    throw Error(ErrorCode::invalid_argument,
                path_.string() + ": " + what +
                    ". The transform of the rates must lead to the world frame, in metres");
  }

  [[nodiscard]] static bool is_index(const openvdb::Vec3d& at) {
    constexpr double kMost = std::numeric_limits<std::int32_t>::max() - 1;
    return std::abs(at.x()) < kMost && std::abs(at.y()) < kMost && std::abs(at.z()) < kMost;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::format, path_.string() + ": " + what);
  }

  [[nodiscard]] openvdb::FloatGrid::Ptr grid_of(const VdbContents& contents) const {
    openvdb::FloatGrid::Ptr found;
    std::size_t count = 0;
    for (const auto& grid : contents.grids) {
      const auto floats = openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
      if (floats && grid->getName() == kHazardGridName) return floats;
      if (floats) found = floats, ++count;
    }
    if (count != 1) {
      fail("the file has " + std::to_string(count) +
           " grids of floats; name the grid of hazard rates 'hazard'");
    }
    return found;
  }

  [[nodiscard]] float checked(float rate) const {
    if (!(rate >= 0 && std::isfinite(rate))) {
      fail("a hazard rate is " + short_text(rate) + "; it must be at least 0 and finite");
    }
    return rate;
  }

  /// The map's voxels that active voxels of the file can touch.
  [[nodiscard]] VoxelBox touched_by_active(const BeliefGrid& grid) const {
    openvdb::CoordBBox active;
    if (!rates_->tree().evalActiveVoxelBoundingBox(active)) return {};
    Eigen::AlignedBox3d touched;
    const Pose T_grid_world = grid.T_world_grid().inverse();
    for (int corner = 0; corner < 8; ++corner) {
      openvdb::Vec3d at;
      for (int a = 0; a < 3; ++a) {
        at[a] = (corner >> a & 1) != 0 ? active.max()[a] + 0.5 : active.min()[a] - 0.5;
      }
      const openvdb::Vec3d p = rates_->indexToWorld(at);
      touched.extend(T_grid_world * Eigen::Vector3d(p.x(), p.y(), p.z()) / grid.voxel_size());
    }
    const VoxelBox all = VoxelBox::from_dims(grid.min_index(), grid.dims());
    const auto within = [](double value, std::int32_t least, std::int32_t most) {
      return static_cast<std::int32_t>(std::clamp<double>(value, least, most));
    };
    // Equal lattices can differ by rounding.
    constexpr double kRounding = 1e-6;  // [voxels]
    const auto low = [&](int a, std::int32_t least, std::int32_t most) {
      return within(std::floor(touched.min()[a] + kRounding), least, most);
    };
    const auto high = [&](int a, std::int32_t least, std::int32_t most) {
      return within(std::ceil(touched.max()[a] - kRounding), least, most);
    };
    return {
        {low(0, all.min.x, all.max.x), low(1, all.min.y, all.max.y), low(2, all.min.z, all.max.z)},
        {high(0, all.min.x, all.max.x), high(1, all.min.y, all.max.y),
         high(2, all.min.z, all.max.z)}};
  }

  const std::filesystem::path& path_;
  openvdb::FloatGrid::Ptr rates_;
};

}  // namespace viewgain::detail
