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

/// The input of surface reconstruction: a point, and on which side of the surface free space lies,
/// in any frame.
struct VIEWGAIN_EXPORT OrientedPoint {
  std::array<double, 3> position{};  ///< [m]
  /// A direction [1], no precise normal: a hint; zero where not known.
  std::array<double, 3> toward_free{};
  /// How far apart the points around it are [m]; 0: as SurfaceConfig::spacing says.
  double spacing = 0;
};

/// An open, oriented triangle surface as plain arrays. Faces turn counter-clockwise seen from
/// outside (free space); every edge has one face or two. In the frame of the points that it is made
/// of.
struct VIEWGAIN_EXPORT SurfaceMesh {
  std::vector<std::array<double, 3>> vertices;          ///< [m], in any order
  std::vector<std::array<double, 3>> normals;           ///< unit, outward, one a vertex
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< three indices of vertices each
  std::vector<std::uint32_t> source;                    ///< one a vertex: index of its input point
};

/// How points become a surface.
struct VIEWGAIN_EXPORT SurfaceConfig {
  double spacing = 0;  ///< of neighbouring points, where they are closest [m]; the voxel size
  unsigned smoothing_neighbors = 24;  ///< of the jet fit that smooths the points; 0: no smoothing
  double max_edge = 4;                ///< longest edge of a triangle, in units of spacing
  double join_distance = 3;           ///< points within this, in spacings, belong to one component
  std::size_t min_component = 40;     ///< components of fewer points are outliers and dropped
};

/// Rebuilds the surface through the points, given in any order: duplicates and small components
/// dropped, jet smoothing, advancing front (CGAL), components of the mesh with fewer than
/// min_component vertices dropped, faces turned outward by majority of the hints in each component.
/// Neighbours whose hints are opposed are not smoothed together. Lengths are in each point's own
/// spacing; an edge may be as long as either end allows. A vertex is at most 1.25 spacings from its
/// point; a point that smoothing would move further is an outlier. No hole is filled
/// beyond max_edge: open boundaries stay. Empty input, or nothing but outliers, gives an empty
/// mesh. The same input gives the same bits, with any number of threads. Throws
/// Error(invalid_argument) for a position that is not finite, a spacing of a point that is finer
/// than the configuration's or not finite, or a length in the configuration that is not positive,
/// and for 2^32 points or more. Cost: O(n log n) of the points, by a search tree and a Delaunay
/// triangulation.
[[nodiscard]] VIEWGAIN_EXPORT SurfaceMesh reconstruct_surface(std::span<const OrientedPoint> points,
                                                              const SurfaceConfig& config,
                                                              const ExecConfig& exec = {});

}  // namespace viewgain
