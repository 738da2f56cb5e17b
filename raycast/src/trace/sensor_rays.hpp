// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image_bounds.hpp"
#include "ray_tile.hpp"
#include "viewgain/core/camera.hpp"

namespace viewgain::detail {

/// Where in a sensor's image boxes lie, whatever the scene. Immutable.
class ImageProjector {
 public:
  ImageProjector(const PinholeCamera& camera, int pixel_stride, const TileTable& table);

  /// For rays that count from min_range [voxels] on.
  [[nodiscard]] ImageScale scale_for(const PoseFrame& frame, float min_range) const;

 private:
  LensBend lens_;
  float scale_x_ = 0, shift_x_ = 0;  // ray column = scale * x / z + shift, the lens apart
  float scale_y_ = 0, shift_y_ = 0;
  float last_column_ = 0, last_row_ = 0;
  float least_cosine_ = 1;  // of a ray with the optical axis
  float widest_slope_ = 0;  // of a ray to the optical axis, or more
};

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
