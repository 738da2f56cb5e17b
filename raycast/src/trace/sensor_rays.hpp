// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image_projector.hpp"
#include "ray_tile.hpp"
#include "viewgain/core/camera.hpp"

namespace viewgain::detail {

/// A sensor's rays in tiles, whatever the scene: the lens distortion is undone here, once.
/// Immutable.
struct SensorRays {
  PinholeCamera camera;
  int pixel_stride;
  TileTable table;
  ImageProjector projector;

  SensorRays(const PinholeCamera& c, int stride)
      : camera(c), pixel_stride(stride), table(c, stride), projector(c, stride, table) {}

  /// Some of these rays; nothing is undone anew.
  SensorRays(const SensorRays& full, const RayLattice& lattice)
      : camera(moved_to(lattice, full)),
        pixel_stride(full.pixel_stride * lattice.step),
        table(full.table, lattice),
        projector(camera, pixel_stride, table) {}

 private:
  // The camera whose pixel (0, 0) is the lattice's first ray.
  [[nodiscard]] static PinholeCamera moved_to(const RayLattice& lattice, const SensorRays& full) {
    PinholeCamera moved = full.camera;
    moved.cx -= lattice.column * full.pixel_stride;
    moved.cy -= lattice.row * full.pixel_stride;
    moved.width -= lattice.column * full.pixel_stride;
    moved.height -= lattice.row * full.pixel_stride;
    return moved;
  }
};

}  // namespace viewgain::detail
