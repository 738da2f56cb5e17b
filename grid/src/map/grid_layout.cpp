// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "grid_layout.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::detail {
namespace {

constexpr double kLatticeTolerance = 1e-6;  // [voxel]
constexpr double kRigidTolerance = 1e-9;
constexpr double kMinVoxelSize = 2e-5;  // [m]; OpenVDB has no transform for less than 1.44e-5
constexpr std::int32_t kMaxDim = 65536;
constexpr double kMaxVoxels = 1099511627776.0;  // 2^40
constexpr double kMaxIndex = 1073741824.0;      // 2^30

std::string text_of(const char* words) { return words; }
std::string text_of(char letter) { return std::string(1, letter); }
std::string text_of(double value) { return short_text(value); }
std::string text_of(std::int32_t value) { return std::to_string(value); }

template <typename... Parts>
[[noreturn]] void fail(ErrorCode code, const Parts&... parts) {
  throw Error(code, (... + text_of(parts)));
}

void check_positive(const char* name, double value) {
  if (!(std::isfinite(value) && value > 0)) {
    fail(ErrorCode::invalid_argument, "the ", name, " must be positive and finite, not ", value);
  }
}

}  // namespace

GridLayout layout_of(const GridConfig& config) {
  check_positive("voxel size", config.voxel_size);
  std::int32_t low[3], count[3];
  for (std::size_t a = 0; a < 3; ++a) {
    const double from = config.workspace.min[a], to = config.workspace.max[a];
    if (!std::isfinite(from) || !std::isfinite(to)) {
      fail(ErrorCode::invalid_argument, "the workspace must be finite, but along ", "xyz"[a],
           " it extends from ", from, " to ", to);
    }
    if (!(from < to)) {
      fail(ErrorCode::invalid_argument, "the workspace is inside out or empty: along ", "xyz"[a],
           " it extends from ", from, " to ", to);
    }
    const auto snap = [&](double value, double outward) {
      const double nearest = std::round(value);
      return std::abs(value - nearest) <= kLatticeTolerance ? nearest : outward;
    };
    const double a0 = from / config.voxel_size, a1 = to / config.voxel_size;
    const double first = snap(a0, std::floor(a0));
    const double last = std::max(snap(a1, std::ceil(a1)), first + 1.0);
    if (!(last - first <= kMaxDim)) {
      fail(ErrorCode::capacity, "the workspace has ", last - first, " voxels along ", "xyz"[a],
           "; the maximum is ", kMaxDim);
    }
    if (!(std::abs(first) <= kMaxIndex && std::abs(last) <= kMaxIndex)) {
      fail(ErrorCode::capacity, "the workspace lies ", std::max(std::abs(first), std::abs(last)),
           " voxels from the origin along ", "xyz"[a], "; the maximum is ", kMaxIndex);
    }
    low[a] = static_cast<std::int32_t>(first);
    count[a] = static_cast<std::int32_t>(last - first);
  }
  return {{low[0], low[1], low[2]}, {count[0], count[1], count[2]}};
}

void check_layout(double voxel_size, const Pose& T_world_grid, double prior_sigma,
                  const GridLayout& layout) {
  check_positive("voxel size", voxel_size);
  if (voxel_size < kMinVoxelSize) {
    fail(ErrorCode::invalid_argument, "the voxel size is ", voxel_size, " m; the minimum is ",
         kMinVoxelSize, " m");
  }
  check_positive("prior sigma", prior_sigma);
  const double error = orthonormality_error(T_world_grid);
  if (!(error <= kRigidTolerance)) {
    fail(ErrorCode::invalid_argument,
         "T_world_grid is not a rigid transform: its matrix deviates from a rotation by ", error);
  }
  double voxels = 1;
  for (const auto& [low, count] :
       {std::pair{layout.min_index.x, layout.dims.x}, std::pair{layout.min_index.y, layout.dims.y},
        std::pair{layout.min_index.z, layout.dims.z}}) {
    if (count < 1 || count > kMaxDim || std::abs(static_cast<double>(low)) > kMaxIndex ||
        std::abs(static_cast<double>(low) + count) > kMaxIndex) {
      fail(ErrorCode::capacity, "the workspace has ", count,
           " voxels along an axis, starting at voxel ", low, ". The limits are ", kMaxDim,
           " voxels along an axis, and ", kMaxIndex, " voxels from the origin");
    }
    voxels *= count;
  }
  if (voxels > kMaxVoxels) {
    fail(ErrorCode::capacity, "the workspace has ", voxels, " voxels; the maximum is ", kMaxVoxels);
  }
}

void check_counters(const HazardCounters& counters) {
  constexpr std::int64_t kMost = std::int64_t{1} << 40U;
  for (const HazardCounters::Class& c : counters.classes) {
    for (const std::int64_t count : {c.expected, c.met}) {
      if (count >= 0 && count <= kMost) continue;
      refuse("a hazard counter is " + std::to_string(count) + "; it must be in 0..2^40");
    }
  }
}

VoxelBox voxels_in(const BeliefGrid& grid, const Box& region) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (std::isnan(region.min[axis]) || std::isnan(region.max[axis])) {
      refuse(std::string("region: a bound along ") + "xyz"[axis] + " is not a number");
    }
  }
  const VoxelBox workspace = VoxelBox::from_dims(grid.min_index(), grid.dims());
  // First index i with (i + 1/2) V >= x, clamped to the range of an integer.
  const auto first = [&](double x, std::int32_t low, std::int32_t high) {
    return static_cast<std::int32_t>(std::clamp(std::ceil(x / grid.voxel_size() - 0.5),
                                                static_cast<double>(low),
                                                static_cast<double>(high)));
  };
  const Index3 &low = workspace.min, &high = workspace.max;
  return {{first(region.min[0], low.x, high.x), first(region.min[1], low.y, high.y),
           first(region.min[2], low.z, high.z)},
          {first(region.max[0], low.x, high.x), first(region.max[1], low.y, high.y),
           first(region.max[2], low.z, high.z)}};
}

Pose rigid_view(const Pose& T_world_camera) {
  const std::optional<Pose> rigid = rigid_pose(T_world_camera);
  if (!rigid) {
    refuse("the camera pose is not a rigid transform: its matrix deviates from a rotation by " +
           short_text(orthonormality_error(T_world_camera)));
  }
  return *rigid;
}

}  // namespace viewgain::detail
