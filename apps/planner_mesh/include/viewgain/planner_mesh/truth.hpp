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

/// The object and its placement.
struct VIEWGAIN_EXPORT StageConfig {
  std::filesystem::path mesh;             ///< mesh file
  std::optional<double> size{};           ///< longest side to scale it to [m]; defaults to its own
  UpAxis up = UpAxis::z;                  ///< the file's axis that points up
  std::optional<Box> workspace{};         ///< world [m]; defaults to that of Stage
  std::optional<double> support_plane{};  ///< z of the table under the object, world [m]
};

/// The object to be modelled and its surroundings, world frame.
struct VIEWGAIN_EXPORT Stage {
  std::shared_ptr<const SurfaceScene> scene;         ///< the placed object
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< centre of the object's bounding box [m]
  double size = 0;                                   ///< longest side of that box [m]
  /// A cube of edge size · 0.4 / 0.35 around the object, or the given workspace; cut at the support
  /// plane, because the space below is known.
  Box workspace{};
  MeshRepairs repairs{};  ///< repairs made while reading the file
};

/// Reads and centres the mesh, and scales it if a size is given; puts it on the support plane, if
/// any. Throws Error for a mesh that cannot be read or has no extent, a size that is not positive,
/// and a workspace below the plane.
[[nodiscard]] VIEWGAIN_EXPORT Stage set_stage(const StageConfig& config, const ExecConfig& exec);

/// A pose (T_world_camera) that looks at the object's centre from `distance` [m] and 27° above, at
/// an azimuth that depends on the seed. If that pose is out of reach or not above support_plane
/// (world z [m]), returns the nearest possible pose among 2,562 on the sphere and the poses listed
/// in `reach`. Throws Error(invalid_argument) if there is none.
[[nodiscard]] VIEWGAIN_EXPORT Pose default_start(const Stage& stage, double distance,
                                                 std::uint64_t seed, const ReachRegion& reach,
                                                 const std::optional<double>& support_plane);

/// Default distance within which a point covers a sample of the reference mesh [m].
inline constexpr double kCovered = 5e-3;

/// Default covering distance for a map with this voxel size [m]: at least a voxel.
[[nodiscard]] constexpr double covered_within(double voxel_size) {
  return voxel_size > kCovered ? voxel_size : kCovered;
}

/// Quality of a model relative to a reference mesh. Lengths in metres.
struct VIEWGAIN_EXPORT QualityFigures {
  double coverage = 0;          ///< fraction of all samples covered by the surface's vertices
  double coverage_visible = 0;  ///< the same for the visible samples; NaN if there are none
  double coverage_points = 0;   ///< fraction of the visible samples covered by the points
  /// Fraction of the visible samples covered by the triangles of the surface, not only its
  /// vertices.
  double coverage_triangles = 0;
  /// Fraction of all samples with a vertex of the surface within 2.5 mm.
  double coverage_2_5mm = 0;
  double covered_area = 0;          ///< area of the mesh with covered visible samples [m²]
  ErrorStatistics surface_error{};  ///< error of the surface, written to surface.ply
  ErrorStatistics points_error{};   ///< error of the points, written to points.ply
  Consistency consistency{};        ///< consistency of the points
};

/// All figures of a surface and its points except covered_area, which stays 0. `visible` has one
/// entry per sample of the reference mesh, nonzero for a visible one. A sample is covered if a
/// point is within `tolerance` [m]. Throws Error(invalid_argument) if `visible` has a wrong number
/// of entries. Also throws whatever the members of GroundTruth throw; they also determine the cost.
[[nodiscard]] VIEWGAIN_EXPORT QualityFigures quality_figures(const GroundTruth& truth,
                                                             const SurfaceMesh& surface,
                                                             std::span<const FusedPoint> points,
                                                             double tolerance,
                                                             std::span<const std::uint8_t> visible);

/// Settings for visibility and coverage of samples.
struct VIEWGAIN_EXPORT VisibilityConfig {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< point that the poses look at, world [m]
  double distance = 0;  ///< distance of the 2,562 poses from the centre [m]
  Pose start;           ///< T_world_camera of the run's first pose, always included
  ReachRegion reach{};  ///< reachable poses
  std::optional<double> support_plane{};  ///< nothing is visible from below; world z [m]
  std::shared_ptr<const SurfaceScene> surroundings{};  ///< occluders; may be null
  double tolerance = kCovered;  ///< a point within this distance covers a sample [m]
};

/// Sets seen[i] to 1 for each sample i that the pose sees: in the image, within range, with a
/// cosine of incidence of at least `least_cosine`, and not occluded by the mesh or the surroundings
/// (may be null). Entries that are already set stay so. Checks nothing. Cost: at most two rays per
/// sample that is not set.
VIEWGAIN_EXPORT void mark_seen(const SurfaceScene& scene, const SurfaceScene* surroundings,
                               const Sensor& sensor, const Pose& T_world_camera,
                               double least_cosine, std::span<const SurfaceSample> samples,
                               std::span<std::uint8_t> seen);

/// A reference mesh, and which of its samples a camera can see. A sample is visible if the start or
/// one of 2,562 poses around the mesh sees it unoccluded, within range and at an angle of incidence
/// below 80°. If the reachable region has a list of poses, that list replaces the 2,562 poses. An
/// unreachable pose moves along its line of sight to the nearest reachable distance, or is omitted
/// if there is none. Thread safety: const members may run from many threads at once. Cost of the
/// constructor: at most 10,000 samples times 2,563 poses, two rays each.
class VIEWGAIN_EXPORT Truth {
 public:
  /// Determines the visible samples. The scene must not be null. Throws whatever GroundTruth and
  /// the region's predicate throw.
  Truth(std::shared_ptr<const SurfaceScene> scene, const Sensor& sensor,
        const VisibilityConfig& config, const ExecConfig& exec);

  /// Quality of a surface and its points: quality_figures() and the covered area.
  [[nodiscard]] QualityFigures figures(const SurfaceMesh& surface,
                                       std::span<const FusedPoint> points) const;

  /// Distance within which a point covers a sample [m].
  [[nodiscard]] double tolerance() const noexcept { return tolerance_; }
  /// The 10,000 samples.
  [[nodiscard]] const GroundTruth& ground_truth() const noexcept { return truth_; }

 private:
  GroundTruth truth_;
  double area_per_sample_;  // [m²]
  double tolerance_;        // [m]
  std::vector<std::uint8_t> visible_;
};

}  // namespace viewgain
