// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "classic_table.hpp"
#include "viewgain/literature/classic_gains.hpp"

namespace viewgain::detail {

/// Whether occlusion distances are known, or what is missing.
enum class OcclusionKnown : std::uint8_t { yes, no_sensor, no_views };

/// What ClassicMap owns.
struct ClassicMapData {
  std::shared_ptr<const VoxelScene> scene;
  ClassicTable table;
  OcclusionKnown occlusion = OcclusionKnown::no_sensor;
  double occlusion_depth = 0;  ///< [voxels]

  ClassicMapData(std::shared_ptr<const VoxelScene> s, const BeliefGrid& grid)
      : scene(std::move(s)), table(grid) {}
};

/// The way into a map for this library.
struct ClassicAccess {
  [[nodiscard]] static const ClassicMapData& data(const ClassicMap& map) { return *map.data_; }
};

}  // namespace viewgain::detail
