// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "viewgain/raycast/surface_scene.hpp"

namespace viewgain::detail {

/// Where a ray meets the first surface.
struct RayReturn {
  double range = std::numeric_limits<double>::infinity();  ///< [m]; infinity: nothing
  double cos_incidence = 0;
};

/// The object and what stands round it.
struct SimulatedRoom {
  std::shared_ptr<const SurfaceScene> object;
  double background_radius = 0;                      ///< of a sphere round the origin [m]; 0: none
  std::optional<double> support_plane;               ///< height of a table without end [m]
  std::shared_ptr<const SurfaceScene> surroundings;  ///< may be null

  /// The first returns of rays, which go on for ever, world frame; as many as there are rays.
  void first_returns(std::span<const SurfaceScene::Ray> rays, std::span<RayReturn> returns) const;
};

}  // namespace viewgain::detail
