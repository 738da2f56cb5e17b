// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "viewgain/grid/voxel.hpp"

namespace viewgain {

/// "0,0,0 to 7,7,7": the lowest and the highest voxel of a box.
[[nodiscard]] inline std::string voxels_text(const VoxelBox& box) {
  const auto text = [](int x, int y, int z) {
    return std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(z);
  };
  return text(box.min.x, box.min.y, box.min.z) + " to " +
         text(box.max.x - 1, box.max.y - 1, box.max.z - 1);
}

}  // namespace viewgain
