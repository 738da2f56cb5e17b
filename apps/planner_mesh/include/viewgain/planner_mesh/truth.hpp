// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "viewgain/core/box.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/reach.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/fused_points.hpp"
#include "viewgain/mesh/mesh_io.hpp"
#include "viewgain/mesh/quality.hpp"
#include "viewgain/mesh/surface.hpp"
#include "viewgain/raycast/surface_scene.hpp"

namespace viewgain {

/// The object and how it stands.
struct VIEWGAIN_EXPORT StageConfig {
  std::filesystem::path mesh;             ///< its file
  std::optional<double> size{};           ///< longest side to scale it to [m]; not given: its own
  UpAxis up = UpAxis::z;                  ///< the file's axis that points up
  std::optional<Box> workspace{};         ///< world [m]; default: see Stage
  std::optional<double> support_plane{};  ///< the object stands on it; world z [m]
};

/// The object to be modelled and the space around it, world frame.
struct VIEWGAIN_EXPORT Stage {
  std::shared_ptr<const SurfaceScene> scene;         ///< the object, placed
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< of the object's bounding box [m]
  double size = 0;                                   ///< longest side of that box [m]
  /// A cube of edge size · 0.4 / 0.35 around the object, or the one given; cut at the support
  /// plane, since what is under it is known.
  Box workspace{};
  MeshRepairs repairs{};  ///< made in reading the file
};

/// Reads and centres the mesh, scales it if a size is given; with a support plane it is put on it.
/// Throws Error for a mesh that cannot be read or has no extent, a size that is not positive, a
/// workspace under the plane.
[[nodiscard]] VIEWGAIN_EXPORT Stage set_stage(const StageConfig& config, const ExecConfig& exec);

/// A pose (T_world_camera) that looks at the object's centre from `distance` [m] and 27° above, at
/// an azimuth that depends on the seed; where that is out of reach or not above the support_plane
/// (world z [m]), the possible pose that is nearest to it among 2,562 on the sphere and the
/// region's list. Throws Error(invalid_argument) if there is none.
[[nodiscard]] VIEWGAIN_EXPORT Pose default_start(const Stage& stage, double distance,
                                                 std::uint64_t seed, const ReachRegion& reach,
                                                 const std::optional<double>& support_plane);

/// A sample is covered by a point that is within this of it, unless a run says otherwise [m].
inline constexpr double kCovered = 5e-3;

/// The same for a map of such voxels [m]: what is finer than these judges them, not the views [m].
[[nodiscard]] constexpr double covered_within(double voxel_size) {
  return voxel_size > kCovered ? voxel_size : kCovered;
}

/// How good one model is, against a ground truth. Lengths in [m].
struct VIEWGAIN_EXPORT QualityFigures {
  double coverage = 0;              ///< share of all samples that the surface covers
  double coverage_visible = 0;      ///< share of the visible ones; NaN if there are none
  double coverage_points = 0;       ///< the same by the points
  double coverage_triangles = 0;    ///< the same by the surface's triangles, not its vertices
  double coverage_2_5mm = 0;        ///< share of all samples, 2.5 mm, surface
  double covered_area = 0;          ///< of the mesh, where visible samples are covered [m²]
  ErrorStatistics surface_error{};  ///< of surface.ply
  ErrorStatistics points_error{};   ///< of points.ply
  Consistency consistency{};        ///< of the points
};

/// All figures of a surface and its points except covered_area, which stays 0. `visible` holds one
/// mark per sample of the ground truth. A sample is covered if a point is within `tolerance` [m].
/// Throws if the number of marks is wrong. Other errors and costs are those of GroundTruth's
/// members.
[[nodiscard]] VIEWGAIN_EXPORT QualityFigures quality_figures(const GroundTruth& truth,
                                                             const SurfaceMesh& surface,
                                                             std::span<const FusedPoint> points,
                                                             double tolerance,
                                                             std::span<const std::uint8_t> visible);

/// From where the visible samples are looked for, and when they are covered.
struct VIEWGAIN_EXPORT VisibilityConfig {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< what the poses look at, world [m]
  double distance = 0;                               ///< of the 2,562 poses from the centre [m]
  Pose start;                             ///< T_world_camera, the run's first pose, wherever it is
  ReachRegion reach{};                    ///< from where it may be seen
  std::optional<double> support_plane{};  ///< nothing is seen from under it; world z [m]
  std::shared_ptr<const SurfaceScene> surroundings{};  ///< which hide the object; may be null
  double tolerance = kCovered;  ///< a sample is covered by a point within this of it [m]
};

/// Marks with 1 those of the mesh's samples that are seen from a pose: in the image and the range
/// limits, unoccluded by mesh and surroundings (may be null), and at no more than an angle of
/// incidence whose cosine is `least_cosine`. Samples that have a mark keep it and cost nothing;
/// others at most two rays. As many marks as samples; checks nothing.
VIEWGAIN_EXPORT void mark_seen(const SurfaceScene& scene, const SurfaceScene* surroundings,
                               const Sensor& sensor, const Pose& T_world_camera,
                               double least_cosine, std::span<const SurfaceSample> samples,
                               std::span<std::uint8_t> seen);

/// A ground-truth mesh and which of its samples a camera can see: unoccluded, inside the image and
/// the range limits, at under 80°, from the start or one of 2,562 Fibonacci poses. A pose that is
/// out of reach moves along its line of sight to the reachable distance that is nearest to the
/// wanted one, in steps of 2.5 mm, at most 50 m and outside of the sphere round the mesh; it is
/// left out if there is none. Where the reachable region has a list of poses, those count instead.
/// Thread safety: const members may run from many threads at once. Cost of the constructor: at most
/// 10,000 samples times 2,563 poses, two rays each.
class VIEWGAIN_EXPORT Truth {
 public:
  /// Finds the visible samples, without noise. The scene must not be null; throws as GroundTruth,
  /// and what the region's predicate throws.
  Truth(std::shared_ptr<const SurfaceScene> scene, const Sensor& sensor,
        const VisibilityConfig& config, const ExecConfig& exec);

  /// How good a surface and its points are: quality_figures() and the covered area.
  [[nodiscard]] QualityFigures figures(const SurfaceMesh& surface,
                                       std::span<const FusedPoint> points) const;

  /// A sample is covered by a point that is within this of it [m].
  [[nodiscard]] double tolerance() const noexcept { return tolerance_; }
  /// The samples, 10,000 of them.
  [[nodiscard]] const GroundTruth& ground_truth() const noexcept { return truth_; }

 private:
  GroundTruth truth_;
  double area_per_sample_;  // [m²]
  double tolerance_;        // [m]
  std::vector<std::uint8_t> visible_;
};

}  // namespace viewgain
