// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>

#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/triangle_mesh.hpp"

namespace viewgain {

/// Where a ray meets a triangle mesh.
struct VIEWGAIN_EXPORT SurfaceHit {
  double range =
      std::numeric_limits<double>::infinity();  ///< along the unit direction [m]; infinity: miss
  std::uint32_t triangle = 0;                   ///< which one; 0 for a miss
  Eigen::Vector3d normal =
      Eigen::Vector3d::Zero();  ///< unit, in the mesh's frame, right-hand rule of the vertices
};

/// Triangles to trace, for simulated depth and for pictures. Immutable; owns its copy of the mesh.
/// Thread safety: const members may run from many threads. Cost of the constructor: Embree's BVH is
/// built, O(n log n) of the triangles.
class VIEWGAIN_EXPORT SurfaceScene {
 public:
  /// Throws Error(invalid_argument) for an empty mesh, a vertex that is not finite or an index out
  /// of range; Error(backend) if Embree fails.
  explicit SurfaceScene(TriangleMesh mesh, const ExecConfig& exec = {});
  ~SurfaceScene();
  SurfaceScene(SurfaceScene&&) noexcept;
  SurfaceScene& operator=(SurfaceScene&&) noexcept;

  /// First hit of the ray from origin [m] along the unit direction, both in the mesh's frame, in
  /// (0, max_range] [m]. In single precision. Checks nothing. Costs O(log n) of the triangles.
  [[nodiscard]] SurfaceHit intersect(
      const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
      double max_range = std::numeric_limits<double>::infinity()) const;

  /// The triangles that are traced.
  [[nodiscard]] const TriangleMesh& mesh() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
