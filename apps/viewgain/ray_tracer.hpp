// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "png_io.hpp"
#include "viewgain/core/camera.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/triangle_mesh.hpp"

namespace viewgain::app {

/// How a part of a picture looks.
struct Paint {
  Eigen::Vector3d color = Eigen::Vector3d::Ones();  ///< linear red, green, blue in [0, 1]
  bool lit = true;  ///< false: drawn flat and throws no shadow, for lines
};

/// Triangles and their paints.
class PaintedMesh {
 public:
  /// Returns the number to give to the functions below.
  [[nodiscard]] std::uint8_t add_paint(const Paint& paint);

  /// A cube, or any hexahedron: corner k lies at bit 0, 1, 2 of k along three axes.
  void add_hexahedron(const std::array<Eigen::Vector3d, 8>& corners, std::uint8_t paint);

  /// A square prism of this width [m] along the segment from a to b.
  void add_line(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double width,
                std::uint8_t paint);

  [[nodiscard]] const TriangleMesh& mesh() const noexcept { return mesh_; }
  [[nodiscard]] const Paint& paint_of(std::uint32_t triangle) const {
    return paints_[paint_of_triangle_[triangle]];
  }

 private:
  TriangleMesh mesh_;
  std::vector<Paint> paints_;
  std::vector<std::uint8_t> paint_of_triangle_;
};

/// Renders with Embree: one sun with shadows, a sky with ambient occlusion up to `occlusion_range`
/// [m], 2x2 samples a pixel. The same picture for any number of threads.
[[nodiscard]] RgbImage render(const PaintedMesh& scene, const PinholeCamera& camera,
                              const Pose& T_world_camera, double occlusion_range,
                              const ExecConfig& exec);

}  // namespace viewgain::app
