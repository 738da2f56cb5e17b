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

/// A sample of the true surface, in the mesh's frame.
struct VIEWGAIN_EXPORT SurfaceSample {
  Eigen::Vector3d position;  ///< [m]
  Eigen::Vector3d normal;    ///< unit, by the right-hand rule of its triangle
};

/// Distances of points to the true surface [m].
struct VIEWGAIN_EXPORT ErrorStatistics {
  double rms = 0;          ///< root mean square [m]
  double p95 = 0;          ///< 95th percentile of the distance [m]
  std::size_t points = 0;  ///< 0: the others are NaN
};

/// Are the sigmas honest? With z² = e² / (nᵀ Σ n), e the distance to the surface and n the
/// direction to its nearest point (the surface normal where the distance is 0).
struct VIEWGAIN_EXPORT Consistency {
  double mean_clipped = 0;   ///< mean of min(z², 25) [1]: 1 if honest
  double median = 0;         ///< of z² [1]: 0.455 if honest
  double above_9 = 0;        ///< share of z² > 9: 0.003 if honest
  std::size_t points = 0;    ///< that count: those within 10 mm; 0: the others are NaN
  std::size_t outliers = 0;  ///< points more than 10 mm off
};

/// A ground-truth mesh to hold results against. Immutable. Thread safety: const members may run
/// from many threads.
///
/// Members that take points [m], in the mesh's frame and in any order, throw
/// Error(invalid_argument) for one that is not finite. Such calls cost O(log n) of the triangles,
/// or of the points, for each point or sample. They give the same bits for any number of threads.
class VIEWGAIN_EXPORT GroundTruth {
 public:
  /// Area-weighted samples, the same for the same seed. `exec` says on how many threads the members
  /// below run. Throws Error(invalid_argument) for a mesh without area, an index out of range, or a
  /// vertex that is not finite. Costs O(n log n) of the triangles, and O(samples).
  explicit GroundTruth(const TriangleMesh& mesh, std::size_t sample_count = 10'000,
                       std::uint64_t seed = 1, const ExecConfig& exec = {});
  ~GroundTruth();
  GroundTruth(GroundTruth&&) noexcept;
  GroundTruth& operator=(GroundTruth&&) noexcept;

  /// Of the surface, weighted by area, in the order of the triangles.
  [[nodiscard]] const std::vector<SurfaceSample>& samples() const noexcept;

  /// One a sample, the distance to the nearest of the points [m]; infinity without points.
  [[nodiscard]] std::vector<double> distances_to(
      std::span<const std::array<double, 3>> points) const;

  /// One a sample, the distance to the nearest point of a mesh's triangles [m]; infinity without
  /// any. Triangles without area are left out. Throws also as the constructor for a bad mesh.
  [[nodiscard]] std::vector<double> distances_to(const TriangleMesh& mesh) const;

  /// One a point, its distance to the surface [m].
  [[nodiscard]] std::vector<double> distances_of(
      std::span<const std::array<double, 3>> points) const;

  /// Distance of each point to the surface, RMS and 95th percentile.
  [[nodiscard]] ErrorStatistics error(std::span<const std::array<double, 3>> points) const;

  /// One covariance Σ [m²] a point, in the same order. Throws Error(invalid_argument) if the sizes
  /// differ or a variance nᵀ Σ n is not positive and finite.
  [[nodiscard]] Consistency consistency(std::span<const std::array<double, 3>> points,
                                        std::span<const SymmetricMatrix3> covariances) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Share of the distances that are at most `radius` [m], among those whose `mask`, one a distance,
/// is not 0 (an empty mask: all). NaN if none. Throws Error(invalid_argument) if the mask has
/// another size. Costs O(distances).
[[nodiscard]] VIEWGAIN_EXPORT double coverage(std::span<const double> distances, double radius,
                                              std::span<const std::uint8_t> mask = {});

}  // namespace viewgain
