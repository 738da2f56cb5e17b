// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/triangle_mesh.hpp"

namespace viewgain {

/// A triangle mesh for ray tracing, for simulated depths and pictures. Immutable; owns its mesh.
/// Embree traces in single precision relative to the centre of the mesh, so a distant origin of the
/// frame does not matter. Thread safety: const members may run from many threads. Cost of the
/// constructor: Embree's bounding volume hierarchy, O(n log n) for n triangles.
class VIEWGAIN_EXPORT SurfaceScene {
 public:
  /// A ray to trace, mesh frame.
  struct Ray {
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();            ///< [m]
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();        ///< unit length
    double max_range = std::numeric_limits<double>::infinity();  ///< farther hits are ignored [m]
  };
  /// Intersection of a ray with the mesh.
  struct Hit {
    /// Distance along the ray [m]; infinity if the ray hits nothing.
    double range = std::numeric_limits<double>::infinity();
    std::uint32_t triangle = 0;  ///< index of the triangle; 0 if there is none
    /// Unit normal of the triangle, mesh frame, by the right-hand rule of its vertices.
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  };

  /// Throws Error(invalid_argument) for an empty mesh, a vertex that is not finite or an index out
  /// of range. Throws Error(backend) if Embree fails.
  explicit SurfaceScene(TriangleMesh mesh, const ExecConfig& exec = {});
  ~SurfaceScene();
  SurfaceScene(SurfaceScene&&) noexcept;
  SurfaceScene& operator=(SurfaceScene&&) noexcept;

  /// First hits of rays in (0, max_range]; hit i is that of ray i. A ray with NaN, or from more
  /// than 1e18 m away, hits nothing. Rays are not checked further. 4 to 16 rays are traced
  /// together, so consecutive rays should be similar. Cost: O(log n) per ray for n triangles.
  void intersect(std::span<const Ray> rays, std::span<Hit> hits) const;
  /// First hit of one ray.
  [[nodiscard]] Hit intersect(const Ray& ray) const;

  /// Whether each ray hits anything in (0, max_range], for example for shadows. Faster than
  /// intersect(). The rays may be in any order, and are not checked.
  void block(std::span<const Ray> rays, std::span<bool> blocked) const;

  /// The triangles of the scene.
  [[nodiscard]] const TriangleMesh& mesh() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
