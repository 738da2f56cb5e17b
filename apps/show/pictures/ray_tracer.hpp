// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "viewgain/core/camera.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/triangle_mesh.hpp"
#include "viewgain/formats/png.hpp"

namespace viewgain::app {

/// How a part of a picture looks.
struct Paint {
  Eigen::Vector3d color = Eigen::Vector3d::Ones();  ///< linear red, green, blue in [0, 1]
  bool lit = true;            ///< false: drawn flat and throws no shadow, for lines
  double back_side = 1;       ///< brightness of a lit triangle's back, relative to its front
  bool passes_light = false;  ///< throws no shadow though it may be lit; fast to trace
};

/// Triangles and their paints.
class PaintedMesh {
 public:
  /// Returns the number to give to the functions below.
  [[nodiscard]] std::uint8_t add_paint(const Paint& paint);

  /// A cube, or any hexahedron: corner k lies at bit 0, 1, 2 of k along three axes.
  void add_hexahedron(const std::array<Eigen::Vector3d, 8>& corners, std::uint8_t paint);

  /// Triangles whose vertices have a unit normal each on the front (the side that they turn
  /// counter-clockwise on), shaded smoothly.
  void add_surface(const std::vector<std::array<double, 3>>& vertices,
                   const std::vector<std::array<double, 3>>& normals,
                   const std::vector<std::array<std::uint32_t, 3>>& triangles, std::uint8_t paint);
  /// The same with a paint for each triangle, all of one part.
  void add_surface(const std::vector<std::array<double, 3>>& vertices,
                   const std::vector<std::array<double, 3>>& normals,
                   const std::vector<std::array<std::uint32_t, 3>>& triangles,
                   const std::vector<std::uint8_t>& paint_of_triangle);

  /// A square prism of this width [m] along the segment from a to b.
  void add_line(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double width,
                std::uint8_t paint);

  /// Triangles of one kind, apart since each is met in another way.
  struct Part {
    TriangleMesh mesh;
    /// Zero for vertices of flat triangles; shorter than mesh.vertices if the last ones are flat.
    std::vector<Eigen::Vector3d> normals;
    std::vector<std::uint8_t> paint_of_triangle;

    /// The normal to shade this point of the triangle with, on the side of its own normal.
    [[nodiscard]] Eigen::Vector3d shading_normal(std::uint32_t triangle,
                                                 const Eigen::Vector3d& point,
                                                 const Eigen::Vector3d& normal) const;
  };
  [[nodiscard]] const Part& solid() const noexcept { return solid_; }      ///< lit, throws shadows
  [[nodiscard]] const Part& overlay() const noexcept { return overlay_; }  ///< passes light
  [[nodiscard]] const Paint& paint_of(const Part& part, std::uint32_t triangle) const {
    return paints_[part.paint_of_triangle[triangle]];
  }

 private:
  Part& part_for(std::uint8_t paint) {
    return paints_[paint].passes_light || !paints_[paint].lit ? overlay_ : solid_;
  }

  Part solid_, overlay_;
  std::vector<Paint> paints_;
};

/// Two directions that make a right-handed frame with the unit vector n.
[[nodiscard]] std::pair<Eigen::Vector3d, Eigen::Vector3d> tangents(const Eigen::Vector3d& n);

/// Renders with Embree: one sun with shadows, a sky with ambient occlusion up to `occlusion_range`
/// [m], 2x2 samples a pixel. The same picture for any number of threads.
[[nodiscard]] RgbImage render(const PaintedMesh& scene, const PinholeCamera& camera,
                              const Pose& T_world_camera, double occlusion_range,
                              const ExecConfig& exec);

}  // namespace viewgain::app
