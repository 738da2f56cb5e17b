// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "show/pictures/ray_tracer.hpp"
#include "viewgain/core/camera.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::app {

// What pictures of views and maps are made of. Points are in the world [m] unless said otherwise.

// Linear colors of voxels in which a view's rays end: orange and blue.
inline const Eigen::Vector3d kUnknownColor{0.95, 0.30, 0.03}, kOccupiedColor{0.05, 0.26, 0.85};

/// A picture of 4:3, `width` px wide and a multiple of 4, through a long lens, so that what is near
/// does not look huge.
[[nodiscard]] PinholeCamera picture_camera(int width = 1280);

/// From where a picture shows a map or a surface, and how large it is.
struct Viewer {
  double azimuth = 0, elevation = 0;  ///< of the direction towards the viewer, as seen there [rad]
  int width = 1280;                   ///< of the picture [px], see picture_camera

  [[nodiscard]] Eigen::Vector3d direction() const;  ///< unit, world
};

/// Paints from dark to bright for shares from 0 to 1, which differ for people who see no colours,
/// too.
class HeatPaints {
 public:
  explicit HeatPaints(PaintedMesh& scene);
  [[nodiscard]] std::uint8_t at(double share) const;

 private:
  std::array<std::uint8_t, 64> paints_{};
};

/// Whether a pose can be drawn: a rigid transform up to 1e-3.
[[nodiscard]] bool is_rigid(const Pose& pose);

/// The corners of the workspace; bits 0, 1, 2 of the index are its three axes.
[[nodiscard]] std::array<Eigen::Vector3d, 8> workspace_corners(const GridSnapshot& snapshot);

void add_box_outline(PaintedMesh& scene, const std::array<Eigen::Vector3d, 8>& corners,
                     double width, std::uint8_t paint);

/// The cube of this side [m] at `index` in the lattice of such cubes, a little smaller so that
/// single ones stay visible; `share`: of its edge that is drawn.
void add_lattice_cube(PaintedMesh& scene, const Pose& T_world_grid, const Eigen::Vector3d& index,
                      double side, std::uint8_t paint, double share = 0.92);

/// Voxels in which rays of a view end or may end: cubes that cover those of the map, orange where
/// unknown, blue where occupied.
class VoxelPaints {
 public:
  explicit VoxelPaints(PaintedMesh& scene);

  void add(PaintedMesh& scene, const GridSnapshot& snapshot, Index3 voxel, bool is_unknown,
           double share = 1) const;
  /// An unknown one the larger the likelier a ray that reaches it ends in it: whole where chances
  /// are even, not at all under 1 %.
  void add(PaintedMesh& scene, const GridSnapshot& snapshot, const VoxelContribution& voxel) const;

 private:
  std::uint8_t unknown_, occupied_;
};

/// The four corners of the image at this depth [m], in order round it.
[[nodiscard]] std::array<Eigen::Vector3d, 4> image_corners(const Sensor& sensor,
                                                           const Pose& T_world_camera,
                                                           double depth);

/// The eight edges of a frustum.
void add_pyramid(PaintedMesh& scene, const Eigen::Vector3d& apex,
                 const std::array<Eigen::Vector3d, 4>& base, double width, std::uint8_t paint);

/// The hits in unknown or occupied voxels of every n-th pixel of every n-th row, with n such that
/// at most `most` are left. `hits` are GainEvaluator::trace's, of every s-th pixel of every s-th
/// row.
[[nodiscard]] std::vector<RayHit> even_hits(const std::vector<RayHit>& hits,
                                            const PinholeCamera& camera, std::size_t most);

/// How far a frustum is drawn [m]: to the middle of what the view sees, or its working distance.
[[nodiscard]] double frustum_depth(const std::vector<RayHit>& hits, const Sensor& sensor);

/// Which way round from a view the viewer stands, seen from above.
enum class Side : std::uint8_t { counter_clockwise, clockwise };

/// Level direction from the view towards the viewer's azimuth, unit; a view that looks straight up
/// or down counts as looking along -x.
[[nodiscard]] Eigen::Vector3d viewer_azimuth(const Eigen::Vector3d& view_eye,
                                             const Eigen::Vector3d& view_target, Side side);

/// Direction towards a viewer beside a view's optical axis and a little above it, so that what the
/// view sees and the way to it are both in sight; unit.
[[nodiscard]] Eigen::Vector3d viewer_beside(const Eigen::Vector3d& view_eye,
                                            const Eigen::Vector3d& view_target, Side side);

/// T_world_camera of a viewer in this direction (unit) who sees all `points`. Moves the principal
/// point of `camera` to centre them. Throws Error(invalid_argument) for points 1e6 m apart or more.
[[nodiscard]] Pose place_viewer(const std::vector<Eigen::Vector3d>& points,
                                const Eigen::Vector3d& direction, PinholeCamera& camera);

}  // namespace viewgain::app
