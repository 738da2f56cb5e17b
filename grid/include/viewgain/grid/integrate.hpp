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

/// What changes the map.
struct VIEWGAIN_EXPORT IntegrationConfig {
  /// Which voxels count as crossed by a pixel.
  enum class Carve : std::uint8_t {
    cones,  ///< those whose centre lies in the pixel's pyramid nearer than the reading
    /// Those that the ray of the pixel's centre passes through: the paper's literal rule. The
    /// weight is that of the ray's entry into the voxel; of several rays the strongest counts.
    lines,
  };

  /// How crossings and hits change a voxel's state.
  enum class Occupancy : std::uint8_t {
    probabilistic,  ///< log-odds, once a voxel a frame
    literal,        ///< crossed -> free, encloses a reading -> occupied: the paper's rule
  };

  Carve carve = Carve::cones;                      ///< what a pixel carves
  Occupancy occupancy = Occupancy::probabilistic;  ///< how states follow
  /// Height z [m] of the table that the object stands on, world. Readings whose point is below it,
  /// or less than 3 σ above it (is_of_plane()), are of the table: they carve as far
  /// as they reach but do not hit.
  std::optional<double> support_plane{};
  /// The greatest scale of a leaf, 0 to 3. Above 0 leaves get the scale whose cells are about as
  /// large as a pixel's footprint and sigma_ax at their range, and a nearer look makes them finer
  /// (thresholds of 1.5, 3 and 6 voxels: Funk et al. 2021, supereight2). Free space is then kept by
  /// blocks of 8³ voxels, as free as their least sure voxel.
  int coarsest = 0;
  std::vector<Box> fine{};  ///< leaves that touch one of them keep scale 0; grid's frame [m]
  int finest = 0;           ///< the least scale of all other leaves, at most `coarsest`
};

/// Counts of one integrated frame.
struct VIEWGAIN_EXPORT IntegrationReport {
  std::uint64_t readings = 0;  ///< pixels with a depth whose range is in [min_range, max_range]
  /// Such pixels that see the support plane or a known depth of the frame; not in `readings`.
  std::uint64_t plane_readings = 0;
  std::uint64_t out_of_range = 0;     ///< pixels that carve up to max_range
  std::uint64_t invalid = 0;          ///< pixels that say nothing
  std::uint64_t readings_inside = 0;  ///< readings that lie in the workspace
  std::uint64_t voxels_hit = 0;       ///< that readings lie in
  std::uint64_t voxels_crossed = 0;   ///< and not hit

  /// Of several frames.
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

/// Puts depth frames of one sensor into a belief grid.
///
/// A pixel is a reading if its range along the ray is in [min_range, max_range]; nearer ones are
/// invalid, farther ones out of range. Readings also carve what lies nearer than min_range. cosθ
/// is amplitude · range² (at most 1) where the frame has amplitudes that are not saturated
/// (DepthFrame::kSaturated); else it comes from the normal of the pixel's 3×3 neighbourhood, 1
/// where there is none. Readings of what is known (DepthFrame::known_depth) carve as far as they
/// reach but do not hit. The map is the same bit for bit for any number of threads and under each
/// instruction set.
///
/// A reading hits the voxel that it lies in. Where its sigma_ax is at least half a voxel, noise may
/// have carried it there: it is put on the plane through the 5×5 pixels around, and hits the best
/// supported voxel on its ray within 3 sigma_ax of there, that with the most readings of map and
/// frame, near ones before far ones, if it has more than twice the support of the plane's. So noise
/// does not make walls thick. IntegrationConfig::Occupancy::literal leaves it where it is (the
/// paper's eq. 4).
///
/// Thread safety: one call at a time on one integrator and on one grid.
class VIEWGAIN_EXPORT FrameIntegrator {
 public:
  /// Undoes the lens distortion once and chooses the instruction set (select_isa()). Throws
  /// Error(invalid_argument) if the sensor is not valid, the support plane is not finite, the
  /// coarsest scale is not 0 to 3, the finest not 0 to the coarsest, or a fine box is inside out or
  /// not a number.
  explicit FrameIntegrator(const Sensor& sensor, const IntegrationConfig& config = {},
                           const ExecConfig& exec = {});
  ~FrameIntegrator();
  FrameIntegrator(FrameIntegrator&&) noexcept;
  FrameIntegrator& operator=(FrameIntegrator&&) noexcept;

  /// Updates states, log-odds and beliefs, appends the pose to the grid's views, and notes sensor
  /// and frame (BeliefGrid::notes()). `pose_sigma`
  /// [m], [rad] is what this frame's pose may be off beside the sensor's own pose_sigma, say what
  /// is left after a registration; its readings are that much less sure (Sensor::sigmas()). Throws
  /// Error(invalid_argument) as check_frame_size(), if the frame's identity is none, the pose is
  /// not rigid (1e-3; smaller errors are orthonormalised) or a sigma is negative or not finite; the
  /// grid is unchanged then. If memory runs out (std::bad_alloc), part of the frame may be in the
  /// grid, which stays one that can be saved and loaded, and the pose is not. Cost: grows with the
  /// voxels crossed; 6 ms a frame of 176 x 144 px at 128³ voxels (perf/results/loop.md).
  IntegrationReport integrate(BeliefGrid& grid, const DepthFrame& frame, const Pose& T_world_camera,
                              const PoseSigma& pose_sigma = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The box, in the frame of T_world_grid, that holds every reading of the frame [m], those of the
/// support plane and of known depths left out; nothing if the frame has none. support_plane [m] as
/// in IntegrationConfig. For choosing a workspace. Throws Error(invalid_argument) as
/// FrameIntegrator. Cost: undoes the lens distortion, and a pass over the pixels.
[[nodiscard]] VIEWGAIN_EXPORT std::optional<Box> reading_bounds(
    const Sensor& sensor, const DepthFrame& frame, const Pose& T_world_camera,
    const Pose& T_world_grid = {}, std::optional<double> support_plane = {});

/// Puts point clouds into a belief grid: the sibling of FrameIntegrator for points that are no
/// pixels of a camera.
///
/// Each point is a reading along the line from the sensor's origin, which carves the voxels that it
/// passes through (IntegrationConfig::Carve::lines) and hits the one that holds the point, with the
/// sensor's covariance at that range and direction and frontal incidence. All points of a call
/// count as one frame: a voxel is updated once, a hit beats crossings. Ranges are treated as
/// FrameIntegrator does: nearer than min_range is invalid, farther than max_range carves as far as
/// that. A point that is not finite, or is the origin itself, is invalid. Of the sensor only noise,
/// fx (of the models whose sigma_lat is a pixel's footprint) and range limits matter. The map is
/// the same bit for bit for any number of threads, and for the points in any order but for the
/// rounding of the beliefs' sums.
///
/// Thread safety: one call at a time on one integrator and on one grid. Cost: grows with
/// the voxels crossed.
class VIEWGAIN_EXPORT CloudIntegrator {
 public:
  /// `config.carve` does not matter: clouds have no pixels to carve by. Throws
  /// Error(invalid_argument) if the sensor is not valid or the support plane is not finite.
  explicit CloudIntegrator(const Sensor& sensor, const IntegrationConfig& config = {},
                           const ExecConfig& exec = {});
  ~CloudIntegrator();
  CloudIntegrator(CloudIntegrator&&) noexcept;
  CloudIntegrator& operator=(CloudIntegrator&&) noexcept;

  /// Points in the world [m]; the origin is the pose's translation, its rotation matters only in
  /// the grid's views, to which the pose is appended. Throws Error(invalid_argument) if the pose is
  /// not rigid (1e-3; smaller errors are orthonormalised) and Error(capacity) for 2^32 points or
  /// more; the grid is unchanged then.
  IntegrationReport integrate(BeliefGrid& grid, std::span<const std::array<double, 3>> points,
                              const Pose& T_world_sensor);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The box, in the frame of T_world_grid, that holds every reading of the cloud [m], those of the
/// support plane left out; nothing if it has none. `points` [m] are in the world, in any order;
/// support_plane [m] as in IntegrationConfig. For choosing a workspace. Throws
/// Error(invalid_argument) as CloudIntegrator. Costs O(points).
[[nodiscard]] VIEWGAIN_EXPORT std::optional<Box> reading_bounds(
    const Sensor& sensor, std::span<const std::array<double, 3>> points, const Pose& T_world_sensor,
    const Pose& T_world_grid = {}, std::optional<double> support_plane = {});

}  // namespace viewgain
