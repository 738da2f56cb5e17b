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

/// Triangles to trace, for simulated depth and for pictures. Immutable; owns its copy of the mesh.
/// Traced by Embree in single precision, relative to the middle of the mesh: how far off the
/// world's origin is does not matter. Thread safety: const members may run from many threads. Cost
/// of the constructor: Embree's BVH is built, O(n log n) of the triangles.
class VIEWGAIN_EXPORT SurfaceScene {
 public:
  /// A ray to trace, in the mesh's frame.
  struct Ray {
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();            ///< [m]
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();        ///< of unit length
    double max_range = std::numeric_limits<double>::infinity();  ///< it meets nothing beyond [m]
  };
  /// Where a ray meets a triangle mesh.
  struct Hit {
    double range =
        std::numeric_limits<double>::infinity();  ///< along the unit direction [m]; infinity: miss
    std::uint32_t triangle = 0;                   ///< which one; 0 for a miss
    Eigen::Vector3d normal =
        Eigen::Vector3d::Zero();  ///< unit, in the mesh's frame, right-hand rule of the vertices
  };

  /// Throws Error(invalid_argument) for an empty mesh, a vertex that is not finite or an index out
  /// of range; Error(backend) if Embree fails.
  explicit SurfaceScene(TriangleMesh mesh, const ExecConfig& exec = {});
  ~SurfaceScene();
  SurfaceScene(SurfaceScene&&) noexcept;
  SurfaceScene& operator=(SurfaceScene&&) noexcept;

  /// First hits in (0, max_range], hit i of ray i; as many as rays. A ray that has a number that is
  /// none, or comes from over 1e18 m away, meets nothing; else checks nothing. Fastest if rays
  /// that follow on one another start and look alike, since 4 to 16 are traced together; O(log n)
  /// of the triangles a ray.
  void intersect(std::span<const Ray> rays, std::span<Hit> hits) const;
  /// The same of one ray.
  [[nodiscard]] Hit intersect(const Ray& ray) const;

  /// Whether rays meet anything in (0, max_range], whatever it is, as it takes for shadows. Faster
  /// than first hits, and rays may look anywhere. As many answers as rays; checks nothing.
  void block(std::span<const Ray> rays, std::span<bool> blocked) const;

  /// The triangles that are traced.
  [[nodiscard]] const TriangleMesh& mesh() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
