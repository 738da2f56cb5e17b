// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "voxels_in.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "viewgain/core/error.hpp"

namespace viewgain::detail {

VoxelBox voxels_in(const BeliefGrid& grid, const Box& region) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (std::isnan(region.min[axis]) || std::isnan(region.max[axis])) {
      throw Error(ErrorCode::invalid_argument,
                  std::string("region: a bound along ") + "xyz"[axis] + " is not a number");
    }
  }
  const VoxelBox workspace = VoxelBox::from_dims(grid.min_index(), grid.dims());
  // The first index i with (i + 1/2) V >= x, kept within what an integer can hold.
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

}  // namespace viewgain::detail
