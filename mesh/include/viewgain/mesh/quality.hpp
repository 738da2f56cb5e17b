// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "viewgain/core/covariance.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/triangle_mesh.hpp"

namespace viewgain {

/// A point on the reference surface, mesh frame.
struct VIEWGAIN_EXPORT SurfaceSample {
  Eigen::Vector3d position;  ///< [m]
  Eigen::Vector3d normal;    ///< unit normal of its triangle, by the right-hand rule
};

/// Statistics of the distances of points to the reference surface. NaN if there are no points.
struct VIEWGAIN_EXPORT ErrorStatistics {
  double rms = 0;          ///< root mean square [m]
  double p95 = 0;          ///< 95th percentile [m]
  std::size_t points = 0;  ///< number of points
};

/// Accuracy of points relative to their covariances Σ, measured by z² = e² / (nᵀ Σ n). e is the
/// distance of a point to the reference surface, and n the direction to the nearest surface point.
/// If e is 0, n is the surface normal. Only points within 10 mm of the surface count. Without such
/// points, the statistics are NaN.
struct VIEWGAIN_EXPORT Consistency {
  double mean_clipped = 0;   ///< mean of min(z², 25); ideal: 1
  double median = 0;         ///< median of z²; ideal: 0.455
  double above_9 = 0;        ///< fraction of points with z² > 9; ideal: 0.003
  std::size_t points = 0;    ///< number of points within 10 mm
  std::size_t outliers = 0;  ///< number of points more than 10 mm away
};

/// A reference mesh (ground truth) with which points and meshes are compared. Immutable. Thread
/// safety: const members may run from many threads.
///
/// Points are in the mesh frame [m]. Members that take points throw Error(invalid_argument) if a
/// point is not finite. Cost: O(log n) per point or sample, where n is the number of triangles or
/// points that it is compared with. Results are bit-identical for any number of threads.
class VIEWGAIN_EXPORT GroundTruth {
 public:
  /// Draws random samples, uniformly distributed over the surface. The same seed gives the same
  /// samples. `exec` sets the number of threads that members use. Throws Error(invalid_argument)
  /// for a mesh without area, an index out of range, or a vertex that is not finite. Cost: O(n log
  /// n) for n triangles, and O(samples).
  explicit GroundTruth(const TriangleMesh& mesh, std::size_t sample_count = 10'000,
                       std::uint64_t seed = 1, const ExecConfig& exec = {});
  ~GroundTruth();
  GroundTruth(GroundTruth&&) noexcept;
  GroundTruth& operator=(GroundTruth&&) noexcept;

  /// The samples of the surface, in the order of the triangles.
  [[nodiscard]] const std::vector<SurfaceSample>& samples() const noexcept;

  /// Distance of each sample to the nearest of the points [m]; infinity if there are no points.
  [[nodiscard]] std::vector<double> distances_to(
      std::span<const std::array<double, 3>> points) const;

  /// Distance of each sample to the nearest triangle of a mesh [m]; infinity if there are no
  /// triangles. Ignores triangles without area. Throws Error(invalid_argument) for an index out of
  /// range or a vertex that is not finite.
  [[nodiscard]] std::vector<double> distances_to(const TriangleMesh& mesh) const;

  /// Distance of each point to the surface [m].
  [[nodiscard]] std::vector<double> distances_of(
      std::span<const std::array<double, 3>> points) const;

  /// Statistics of the distances of points to the surface.
  [[nodiscard]] ErrorStatistics error(std::span<const std::array<double, 3>> points) const;

  /// Consistency of points with their covariances [m²], one per point. Throws
  /// Error(invalid_argument) if the sizes differ or a variance nᵀ Σ n is not positive and finite.
  [[nodiscard]] Consistency consistency(std::span<const std::array<double, 3>> points,
                                        std::span<const SymmetricMatrix3> covariances) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Fraction of the distances that are at most `radius` [m]. Only distances with a nonzero entry in
/// `mask` count; an empty mask selects all. NaN if none is selected. Throws Error(invalid_argument)
/// if the mask is not empty and has another size. Cost: O(distances).
[[nodiscard]] VIEWGAIN_EXPORT double coverage(std::span<const double> distances, double radius,
                                              std::span<const std::uint8_t> mask = {});

}  // namespace viewgain
