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

/// Settings of the integration.
struct VIEWGAIN_EXPORT IntegrationConfig {
  /// Which voxels a pixel crosses.
  enum class Carve : std::uint8_t {
    cones,  ///< those whose centre lies in the pixel's cone, nearer than the reading
    /// Those that the ray through the pixel's centre intersects, as in Foix et al. (2012). If
    /// several rays cross a voxel, the strongest evidence counts.
    lines,
  };

  /// How crossings and hits change a voxel's state.
  enum class Occupancy : std::uint8_t {
    probabilistic,  ///< a frame changes each voxel's log-odds once
    literal,        ///< crossed voxels: free; with a reading: occupied (Foix et al. 2012)
  };

  Carve carve = Carve::cones;                      ///< how pixels mark free space
  Occupancy occupancy = Occupancy::probabilistic;  ///< how states change
  /// Height z [m] of the table under the object, world frame. Readings (measured depths) below it,
  /// or less than 3 standard deviations above it (is_of_plane()), show the table. They mark free
  /// space but hit no voxel.
  std::optional<double> support_plane{};
  /// Largest scale of a leaf, 0 to 3. A leaf is a block of 8³ voxels; at scale s it stores cells
  /// that are 2^s voxels wide (apps/docs/guide/scales.md). If the value is above 0, the first frame
  /// that measures surface in a leaf determines the leaf's scale. Cells are then about as wide as a
  /// pixel's footprint or as sigma_ax at the leaf's range, whichever is larger. Nearer views refine
  /// the leaf. Free space is stored in blocks of 8³ voxels, with the log-odds of their least
  /// certain voxel. The method follows Funk et al. 2021 (supereight2).
  int coarsest = 0;
  std::vector<Box> fine{};  ///< leaves that touch one of these keep scale 0; grid coordinates [m]
  int finest = 0;           ///< smallest scale of all other leaves, at most `coarsest`
};

/// Counts of one integrated frame.
struct VIEWGAIN_EXPORT IntegrationReport {
  std::uint64_t readings = 0;  ///< pixels with a range in [min_range, max_range]
  /// Pixels that show the support plane or a known object (DepthFrame::known_depth). They are not
  /// counted in `readings`.
  std::uint64_t plane_readings = 0;
  std::uint64_t out_of_range = 0;     ///< pixels that are free up to max_range
  std::uint64_t invalid = 0;          ///< pixels without information
  std::uint64_t readings_inside = 0;  ///< readings that lie in the workspace
  std::uint64_t voxels_hit = 0;       ///< voxels that contain readings
  std::uint64_t voxels_crossed = 0;   ///< voxels that were crossed and not hit

  /// Sums over frames.
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
/// number of threads and each instruction set.
///
/// A pixel is a reading if its range lies in [min_range, max_range]; nearer ones are invalid,
/// farther ones out of range. The noise model needs the cosine of the angle of incidence. It is
/// DepthFrame::amplitude · range², at most 1. If the amplitude is missing or saturated, the cosine
/// comes from the normal of the 3×3 neighbourhood (1 without a normal). Readings of known objects
/// (DepthFrame::known_depth) mark free space but hit no voxel.
///
/// A reading hits the voxel that contains it. If sigma_ax is at least half a voxel, the reading
/// hits the voxel on its ray with the most support instead. Noise then does not thicken walls
/// (grid/README.md, "Frames and clouds"). IntegrationConfig::Occupancy::literal disables this, as
/// in eq. 4 of Foix et al. (2012).
///
/// Thread safety: one call at a time on one integrator and on one grid.
class VIEWGAIN_EXPORT FrameIntegrator {
 public:
  /// Removes the lens distortion once and chooses the instruction set (select_isa()). Throws
  /// Error(invalid_argument) if the sensor is invalid, the support plane is not finite, coarsest is
  /// not in 0..3, finest is not in 0..coarsest, or a fine box is inside out or NaN.
  explicit FrameIntegrator(const Sensor& sensor, const IntegrationConfig& config = {},
                           const ExecConfig& exec = {});
  ~FrameIntegrator();
  FrameIntegrator(FrameIntegrator&&) noexcept;
  FrameIntegrator& operator=(FrameIntegrator&&) noexcept;

  /// Updates states, log-odds and beliefs. Appends the pose to the grid's views. Records the sensor
  /// and the depth frame (BeliefGrid::notes()). `pose_sigma` [m], [rad] is the uncertainty of this
  /// pose, for example after a registration. It is combined with Sensor::pose_sigma.
  ///
  /// Throws Error(invalid_argument), and leaves the grid unchanged, if the frame has a wrong size
  /// or an invalid DepthFrame::identity, pose_sigma is invalid, or the pose is not rigid within
  /// 1e-3. Smaller deviations are orthonormalised. After std::bad_alloc the grid is valid but can
  /// contain part of the frame. Cost: grows with the crossed voxels.
  IntegrationReport integrate(BeliefGrid& grid, const DepthFrame& frame, const Pose& T_world_camera,
                              const PoseSigma& pose_sigma = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Bounding box [m], in grid coordinates, of all readings of the depth frame. Use it to choose a
/// workspace. Readings of the support plane and of known objects are left out. Empty if there are
/// no readings. `T_world_grid` is the pose of the grid. `support_plane` [m] has the same meaning as
/// in IntegrationConfig. Throws the same Error(invalid_argument) as FrameIntegrator. Cost: removes
/// the lens distortion, and one pass over the pixels.
[[nodiscard]] VIEWGAIN_EXPORT std::optional<Box> reading_bounds(
    const Sensor& sensor, const DepthFrame& frame, const Pose& T_world_camera,
    const Pose& T_world_grid = {}, std::optional<double> support_plane = {});

/// Integrates point clouds into a belief grid, like FrameIntegrator for points that are not pixels
/// of a camera.
///
/// Each point is a reading along the line from the sensor's origin. It marks the voxels on the line
/// as free (IntegrationConfig::Carve::lines) and hits the voxel that contains it. Its covariance is
/// the sensor's for its range and direction, assuming frontal incidence. All points of a call are
/// one frame: a voxel is updated once, and a hit overrides crossings. Points nearer than min_range,
/// at the origin or not finite are invalid; points beyond max_range mark free space up to it. Of
/// the sensor, only the noise, fx and the range limits are used. The map is bit-identical for any
/// number of threads; the order of points only affects rounding of beliefs.
///
/// Thread safety: one call at a time on one integrator and on one grid. Cost: grows with the
/// crossed voxels.
class VIEWGAIN_EXPORT CloudIntegrator {
 public:
  /// `config.carve` has no effect, because clouds have no pixels. Throws Error(invalid_argument) if
  /// the sensor is invalid or the support plane is not finite.
  explicit CloudIntegrator(const Sensor& sensor, const IntegrationConfig& config = {},
                           const ExecConfig& exec = {});
  ~CloudIntegrator();
  CloudIntegrator(CloudIntegrator&&) noexcept;
  CloudIntegrator& operator=(CloudIntegrator&&) noexcept;

  /// Integrates points in the world [m]. The lines start at the pose's translation. The pose's
  /// rotation does not affect the voxels; it is only stored with the pose in the grid's views.
  /// Throws Error(invalid_argument) if the pose is not rigid within 1e-3; smaller deviations are
  /// orthonormalised. Throws Error(capacity) for 2^32 points or more. After an error the grid is
  /// unchanged.
  IntegrationReport integrate(BeliefGrid& grid, std::span<const std::array<double, 3>> points,
                              const Pose& T_world_sensor);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Bounding box [m], in grid coordinates, of all readings of the cloud. Use it to choose a
/// workspace. Readings of the support plane are left out. Empty if there are no readings. `points`
/// [m] are in the world frame, in any order. `T_world_grid` is the pose of the grid.
/// `support_plane` [m] has the same meaning as in IntegrationConfig. Throws the same
/// Error(invalid_argument) as CloudIntegrator. Cost: O(points).
[[nodiscard]] VIEWGAIN_EXPORT std::optional<Box> reading_bounds(
    const Sensor& sensor, std::span<const std::array<double, 3>> points, const Pose& T_world_sensor,
    const Pose& T_world_grid = {}, std::optional<double> support_plane = {});

}  // namespace viewgain
