// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "viewgain/core/box.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"

namespace viewgain {

/// Settings of the integration. A reading is one measured depth. A pixel crosses the voxels between
/// the camera and its reading, which are therefore free, and its reading hits one voxel.
struct VIEWGAIN_EXPORT IntegrationConfig {
  /// Which voxels a pixel crosses.
  enum class Carve : std::uint8_t {
    cones,  ///< voxels whose centre lies in the pixel's cone and is nearer than the reading
    /// Voxels that the ray through the pixel's centre intersects, as in Foix et al. (2012). If
    /// several rays cross a voxel, the strongest evidence counts.
    lines,
  };

  /// How crossings and hits change a voxel's state.
  enum class Occupancy : std::uint8_t {
    probabilistic,  ///< a frame changes the log-odds of each voxel once
    literal,        ///< crossed voxels become free, hit voxels occupied (Foix et al. 2012)
  };

  Carve carve = Carve::cones;                      ///< which voxels a pixel crosses
  Occupancy occupancy = Occupancy::probabilistic;  ///< how voxels change
  /// Height z of the table under the object, world frame [m]. Readings below it, or less than 3
  /// standard deviations above it, show the table (is_of_plane()). They mark free space, but hit no
  /// voxel.
  std::optional<double> support_plane{};
  /// Largest scale of a leaf, 0 to 3. A leaf is a block of 8³ voxels; at scale s it consists of
  /// cells that are 2^s voxels wide (apps/docs/guide/scales.md). If `coarsest` is above 0, the
  /// first frame that measures surface in a leaf sets its scale. Cells are then about as wide as a
  /// pixel on the surface or as sigma_ax, whichever is larger, and nearer views refine them. Free
  /// space is stored per leaf, with the log-odds of the least certain voxel. The method follows
  /// Funk et al. 2021 (supereight2).
  int coarsest = 0;
  std::vector<Box> fine{};  ///< leaves that touch one of these boxes keep scale 0; grid frame [m]
  int finest = 0;           ///< smallest scale of all other leaves, at most `coarsest`
};

/// Counts of pixels and voxels of an integrated frame. For a cloud, points take the place of
/// pixels.
struct VIEWGAIN_EXPORT IntegrationReport {
  std::uint64_t readings = 0;  ///< pixels with a range in [min_range, max_range]
  /// Pixels that show the support plane or a known object (DepthFrame::known_depth). They do not
  /// count in `readings`.
  std::uint64_t plane_readings = 0;
  std::uint64_t out_of_range = 0;     ///< pixels that are free up to max_range
  std::uint64_t invalid = 0;          ///< pixels that measured nothing
  std::uint64_t readings_inside = 0;  ///< readings that lie in the workspace
  std::uint64_t voxels_hit = 0;       ///< voxels that readings hit
  std::uint64_t voxels_crossed = 0;   ///< voxels that were crossed, but not hit

  /// Adds the counts of another frame.
  IntegrationReport& operator+=(const IntegrationReport& other) {
    readings += other.readings;
    plane_readings += other.plane_readings;
    out_of_range += other.out_of_range;
    invalid += other.invalid;
    readings_inside += other.readings_inside;
    voxels_hit += other.voxels_hit;
    voxels_crossed += other.voxels_crossed;
    return *this;
  }
};

/// Integrates depth frames of one sensor into a belief grid. The map is bit-identical for any
/// number of threads and every instruction set.
///
/// Ranges below min_range are invalid, and those above max_range are out of range. The noise model
/// needs the cosine of the angle of incidence, which is DepthFrame::amplitude · range², at most 1.
/// If the amplitude is missing or saturated, the cosine follows from the normal of the 3×3
/// neighbourhood; it is 1 if there is no normal. Readings of known objects
/// (DepthFrame::known_depth) mark free space, but hit no voxel.
///
/// A reading hits the voxel that contains it. Exception: if sigma_ax is at least half a voxel, it
/// hits the voxel on its ray with the most support, so that noise does not thicken walls
/// (grid/README.md, "Frames and clouds"). With Occupancy::literal there is no exception, as in eq.
/// 4 of Foix et al. (2012).
///
/// Thread safety: one call at a time on one integrator and on one grid.
class VIEWGAIN_EXPORT FrameIntegrator {
 public:
  /// Computes the rays of all pixels once. Throws Error(backend) if no instruction set is
  /// supported. Throws Error(invalid_argument) if the environment variable VIEWGAIN_ISA has an
  /// unknown value, and unless:
  /// - the sensor is valid and the support plane is finite
  /// - 0 <= finest <= coarsest <= 3
  /// - in each fine box, no bound is NaN and no minimum exceeds its maximum
  explicit FrameIntegrator(const Sensor& sensor, const IntegrationConfig& config = {},
                           const ExecConfig& exec = {});
  ~FrameIntegrator();
  FrameIntegrator(FrameIntegrator&&) noexcept;
  FrameIntegrator& operator=(FrameIntegrator&&) noexcept;

  /// Updates states, log-odds and beliefs. Appends the pose to the grid's views, and adds the
  /// sensor and the frame to its notes. `pose_sigma` is the uncertainty of this pose in addition to
  /// Sensor::pose_sigma, for example after a registration.
  ///
  /// Throws Error(invalid_argument), and leaves the grid unchanged, unless:
  /// - the frame has the sensor's size, and its DepthFrame::identity is valid or empty
  /// - pose_sigma is finite and not negative
  /// - the pose is rigid within 1e-3; smaller errors are repaired (rigid_pose())
  ///
  /// After std::bad_alloc the grid is valid, but can contain part of the frame. Cost: grows with
  /// the crossed voxels.
  IntegrationReport integrate(BeliefGrid& grid, const DepthFrame& frame, const Pose& T_world_camera,
                              const PoseSigma& pose_sigma = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Bounding box of all readings of a depth frame, in the grid frame [m]. Use it to choose a
/// workspace. Readings of the support plane and of known objects are ignored. Empty if there are no
/// readings. `support_plane` is that of IntegrationConfig [m]. Throws Error(invalid_argument) for
/// the same faults as FrameIntegrator. Cost: computing the rays, and one pass over the pixels.
[[nodiscard]] VIEWGAIN_EXPORT std::optional<Box> reading_bounds(
    const Sensor& sensor, const DepthFrame& frame, const Pose& T_world_camera,
    const Pose& T_world_grid = {}, std::optional<double> support_plane = {});

/// Integrates point clouds into a belief grid, for points that are not pixels of a camera.
///
/// Each point is a reading on the line from the sensor's origin. It crosses the voxels on this line
/// and hits the voxel that contains it. Its covariance is that of the sensor for frontal incidence
/// at this range. All points of a call are one frame: a voxel is updated once, and is hit rather
/// than crossed if both apply. Points that are at the origin, nearer than min_range or not finite
/// are invalid. Points beyond max_range mark free space up to max_range. Of the sensor, only the
/// noise, fx and the range limits are used. The map is bit-identical for any number of threads. The
/// order of the points only affects the rounding of beliefs.
///
/// Thread safety: one call at a time on one integrator and on one grid. Cost: grows with the
/// crossed voxels.
class VIEWGAIN_EXPORT CloudIntegrator {
 public:
  /// `config.carve` is ignored, because clouds have no pixels. Throws Error(invalid_argument) if
  /// the sensor or a setting is invalid, as FrameIntegrator does.
  explicit CloudIntegrator(const Sensor& sensor, const IntegrationConfig& config = {},
                           const ExecConfig& exec = {});
  ~CloudIntegrator();
  CloudIntegrator(CloudIntegrator&&) noexcept;
  CloudIntegrator& operator=(CloudIntegrator&&) noexcept;

  /// Integrates points in the world frame [m]. The lines start at the translation of the pose. The
  /// rotation of the pose is only stored, in the grid's views. Throws Error(invalid_argument) if
  /// the pose is not rigid within 1e-3; smaller errors are repaired (rigid_pose()). Throws
  /// Error(capacity) for 2^32 points or more. After an error the grid is unchanged.
  IntegrationReport integrate(BeliefGrid& grid, std::span<const std::array<double, 3>> points,
                              const Pose& T_world_sensor);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Bounding box of all readings of a cloud, in the grid frame [m]. Use it to choose a workspace.
/// Readings of the support plane are ignored. Empty if there are no readings. `points` are in the
/// world frame [m]. `support_plane` is that of IntegrationConfig [m]. Throws
/// Error(invalid_argument) for the same faults as CloudIntegrator. Cost: O(points).
[[nodiscard]] VIEWGAIN_EXPORT std::optional<Box> reading_bounds(
    const Sensor& sensor, std::span<const std::array<double, 3>> points, const Pose& T_world_sensor,
    const Pose& T_world_grid = {}, std::optional<double> support_plane = {});

}  // namespace viewgain
