// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"

namespace viewgain {

/// Input of the surface reconstruction: a point with a hint on which side free space lies, in any
/// frame.
struct VIEWGAIN_EXPORT OrientedPoint {
  std::array<double, 3> position{};  ///< [m]
  /// Vector towards free space. Its length does not matter, and the direction may be rough. Zero:
  /// unknown.
  std::array<double, 3> toward_free{};
  /// Distance between neighbouring points [m]; 0: SurfaceConfig::spacing.
  double spacing = 0;
};

/// An open, oriented triangle surface as plain arrays, in the frame of its points. Faces are
/// counter-clockwise seen from outside (free space); every edge has one face or two.
struct VIEWGAIN_EXPORT SurfaceMesh {
  std::vector<std::array<double, 3>> vertices;          ///< [m]
  std::vector<std::array<double, 3>> normals;           ///< unit normals, outward, one per vertex
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< three vertex indices each
  std::vector<std::uint32_t> source;                    ///< input point of each vertex
};

/// Settings of the surface reconstruction.
struct VIEWGAIN_EXPORT SurfaceConfig {
  /// Distance between neighbouring points where they are closest [m]; usually the voxel size.
  double spacing = 0;
  /// Number of neighbours that smooth a point (jet fit); 0: no smoothing.
  unsigned smoothing_neighbors = 24;
  double max_edge = 4;       ///< longest edge of a triangle [spacings]
  double join_distance = 3;  ///< points within this distance belong to one component [spacings]
  std::size_t min_component = 40;  ///< components with fewer points are dropped as outliers
};

/// Reconstructs the surface through the points:
/// - drops duplicates and small components of the points
/// - smooths the points (jet fit); points with opposed hints are not smoothed together
/// - connects them into triangles (advancing front, CGAL)
/// - drops components of the mesh with fewer than min_component vertices
/// - orients the faces of each component outward, according to most hints in the component
///
/// Lengths are relative to each point's own spacing. A vertex is at most 1.25 spacings from its
/// point; points that smoothing would move further are dropped as outliers. Holes larger than
/// max_edge stay open.
///
/// Empty input, or outliers only, give an empty mesh. Results are bit-identical for any number of
/// threads. Throws Error(invalid_argument) for a position that is not finite, a point's spacing
/// that is not finite or smaller than the configuration's, a length of the configuration that is
/// not positive, and 2^32 points or more. Cost: O(n log n) of the points.
[[nodiscard]] VIEWGAIN_EXPORT SurfaceMesh reconstruct_surface(std::span<const OrientedPoint> points,
                                                              const SurfaceConfig& config,
                                                              const ExecConfig& exec = {});

}  // namespace viewgain
