// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ray_tile.hpp"
#include "tile_bins.hpp"
#include "viewgain/core/camera.hpp"

namespace viewgain::detail {

/// A sensor's rays in tiles, whatever the scene: the lens distortion is undone here, once.
/// Immutable.
struct SensorRays {
  PinholeCamera camera;
  int pixel_stride;
  TileTable table;
  TileBinner binner;

  SensorRays(const PinholeCamera& c, int stride)
      : camera(c), pixel_stride(stride), table(c, stride), binner(c, stride, table) {}
};

}  // namespace viewgain::detail
