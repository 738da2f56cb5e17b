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

/// Input point of the surface reconstruction, in any frame, with a hint about the side on which
/// free space lies.
struct VIEWGAIN_EXPORT OrientedPoint {
  std::array<double, 3> position{};  ///< [m]
  /// Vector towards free space, of any length. An approximate direction suffices. Zero: unknown.
  std::array<double, 3> toward_free{};
  /// Spacing: distance to neighbouring points [m]. 0: SurfaceConfig::spacing.
  double spacing = 0;
};

/// An open, oriented triangle surface as plain arrays, in the frame of the input points. Seen from
/// outside (free space), the vertices of a face are in counter-clockwise order. Every edge has one
/// or two faces.
struct VIEWGAIN_EXPORT SurfaceMesh {
  std::vector<std::array<double, 3>> vertices;          ///< [m]
  std::vector<std::array<double, 3>> normals;           ///< unit normals, outward, one per vertex
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< three vertex indices each
  std::vector<std::uint32_t> source;                    ///< index of the input point of each vertex
};

/// Settings of the surface reconstruction.
struct VIEWGAIN_EXPORT SurfaceConfig {
  /// Smallest distance between neighbouring points [m]; usually the voxel size.
  double spacing = 0;
  /// Number of neighbours in the jet fit (a local polynomial) that smooths a point; 0: no
  /// smoothing.
  unsigned smoothing_neighbors = 24;
  double max_edge = 4;       ///< longest edge of a triangle [spacings]
  double join_distance = 3;  ///< points within this distance belong to one component [spacings]
  std::size_t min_component = 40;  ///< components with fewer points are omitted as outliers
};

/// Reconstructs the surface through points:
/// - omits duplicates, and components of fewer than min_component points
/// - smooths the points (jet fit); points with opposed hints are not smoothed together
/// - connects them into triangles (advancing front, CGAL)
/// - omits components of the mesh with fewer than min_component vertices
/// - orients the faces of each component outward, as most hints in the component say
///
/// Lengths in [spacings] refer to the spacing of each point. Points that smoothing would move by
/// more than 1.25 spacings are omitted as outliers. Holes larger than max_edge stay open.
///
/// If there are no points, or only outliers, the mesh is empty. Results are bit-identical for any
/// number of threads. Throws Error(invalid_argument) if a position is not finite, a point's spacing
/// is not finite or smaller than that of `config`, a length of `config` is not positive, or there
/// are 2^32 points or more. Cost: O(n log n) for n points.
[[nodiscard]] VIEWGAIN_EXPORT SurfaceMesh reconstruct_surface(std::span<const OrientedPoint> points,
                                                              const SurfaceConfig& config,
                                                              const ExecConfig& exec = {});

}  // namespace viewgain
