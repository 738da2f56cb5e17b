// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "viewgain/core/box.hpp"
#include "viewgain/core/criterion.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief.hpp"
#include "viewgain/grid/grid_snapshot.hpp"
#include "viewgain/grid/hazard_counters.hpp"
#include "viewgain/grid/map_notes.hpp"
#include "viewgain/grid/voxel.hpp"

namespace viewgain {

namespace detail {
struct GridAccess;
struct GridStorage;
}  // namespace detail

/// Layout of a map. The default suits an object at the origin. A value type.
struct VIEWGAIN_EXPORT GridConfig {
  double voxel_size = 0.005;  ///< edge V of a voxel [m]
  /// The part of space that is mapped, grid frame [m]. Extended to whole voxels, see BeliefGrid.
  Box workspace{{-0.25, -0.25, -0.25}, {0.25, 0.25, 0.25}};
  Pose T_world_grid{};  ///< pose of the grid frame in the world
  /// Standard deviation sigma_0 of the surface position in an unknown voxel [m]. Unset:
  /// default_prior_sigma() with the map's sensor.
  std::optional<double> prior_sigma{};
};

/// The belief grid: a map of a workspace, voxel by voxel.
///
/// In the grid frame, voxel (i,j,k) covers [i,i+1) x [j,j+1) x [k,k+1) times the voxel size V. The
/// workspace is extended to whole voxels; a face within 1e-6 voxels of a voxel boundary counts as
/// lying on it. At first all voxels are unknown, which takes little memory. A known voxel has a
/// log-odds in [-2, 3.5], in steps of 0.05. It is occupied if the log-odds is above 0, otherwise
/// free. A reading (one measured depth) hits the voxel in which it ends. A voxel that was hit has a
/// Belief, and keeps it if it becomes free.
///
/// A leaf is a block of 8³ voxels. It has a scale s, initially 0 and at most 3, and is divided into
/// cells of 2^s voxels per edge. All voxels of a cell share one state, log-odds and belief
/// (apps/docs/guide/scales.md).
///
/// Thread safety: const members may run from many threads at once, but not while a non-const member
/// runs. Members that look at one voxel take constant time. The argument `region` of members is a
/// box in the grid frame [m], whose bounds may be infinite.
class VIEWGAIN_EXPORT BeliefGrid {
 public:
  /// A known voxel and its data, for set() and for_each_occupied().
  struct VoxelValue {
    Index3 voxel;        ///< voxel of the workspace; for_each_occupied(): lowest of its cell
    float log_odds = 0;  ///< set() rounds it to a step of 0.05 and clamps it
    std::optional<Belief> belief{};  ///< empty: none, and set() removes an existing one
  };

  /// Voxel counts of a map or of a part of it, and the removed entropy, which measures progress
  /// (Foix et al. 2012).
  struct Statistics {
    std::uint64_t unknown = 0;   ///< voxels never observed
    std::uint64_t free = 0;      ///< voxels known to be free
    std::uint64_t occupied = 0;  ///< voxels known to be occupied
    std::uint64_t bytes = 0;     ///< memory of the whole map
    /// Sum over occupied voxels of H(Λ_0) - H(Λ_0 + Λ_v) [nat; m² with Criterion::trace]. Λ_0 is
    /// the prior information, Λ_v that of the Belief and H the entropy() (core/criterion.hpp). A
    /// cell of scale s counts as 4^s voxels, among which its Λ_v is divided.
    double entropy_removed = 0;
    /// Number of readings that ended in the map or part, including those in voxels that are free by
    /// now.
    std::uint64_t hits = 0;
  };

  /// Makes a map in which all voxels are unknown. `sensor` only sets the default of prior_sigma.
  /// Throws Error(capacity) above 65,536 voxels along an axis or 2^40 in total, and for indices
  /// beyond ±2^30. Throws Error(invalid_argument), naming the value, unless:
  /// - voxel_size is finite and at least 2e-5 m
  /// - prior_sigma is finite and positive
  /// - the workspace is finite and not empty
  /// - T_world_grid is rigid within 1e-9 (orthonormality_error())
  explicit BeliefGrid(const GridConfig& config, const Sensor& sensor = {});
  ~BeliefGrid();
  BeliefGrid(BeliefGrid&&) noexcept;
  BeliefGrid& operator=(BeliefGrid&&) noexcept;

  /// Makes a map from an array of states, [x][y][z] with z fastest, one per voxel of the workspace:
  /// 0 unknown, 1 free (log-odds -0.4), 2 occupied (log-odds 0.85, no belief). Because beliefs are
  /// missing, GainModel::paper rewards measuring occupied voxels again; other gains do not. Throws
  /// Error(invalid_argument) if the array has a wrong size or an invalid state. Also throws
  /// whatever the constructor throws. Cost: one pass over the array.
  [[nodiscard]] static BeliefGrid from_states(const GridConfig& config,
                                              std::span<const std::uint8_t> states,
                                              const Sensor& sensor = {});

  /// A deep copy. Cost: a copy of the states. Beliefs are copied on write.
  [[nodiscard]] BeliefGrid clone() const;

  [[nodiscard]] double voxel_size() const noexcept;  ///< [m]
  /// Pose of the grid frame in the world.
  [[nodiscard]] const Pose& T_world_grid() const noexcept;
  [[nodiscard]] double prior_sigma() const noexcept;  ///< [m]
  [[nodiscard]] Index3 min_index() const noexcept;    ///< lowest voxel of the workspace
  [[nodiscard]] Index3 dims() const noexcept;         ///< voxels along x, y, z
  [[nodiscard]] Box workspace() const noexcept;       ///< extended to whole voxels, grid frame [m]
  /// Number of voxels in the workspace.
  [[nodiscard]] std::uint64_t voxel_count() const noexcept;

  /// The voxel that contains a point in the world frame [m]. Empty if the point lies outside the
  /// workspace or is not finite.
  [[nodiscard]] std::optional<Index3> index_of(const Eigen::Vector3d& p_world) const;
  /// Centre of a voxel in the world frame [m]. The voxel may lie outside the workspace.
  [[nodiscard]] Eigen::Vector3d center(Index3 voxel) const;

  /// State of a voxel; unknown outside the workspace.
  [[nodiscard]] VoxelState state(Index3 voxel) const;
  /// Log-odds of a voxel; empty if the voxel is unknown.
  [[nodiscard]] std::optional<float> log_odds(Index3 voxel) const;
  /// Belief of a voxel; empty if the voxel was never hit.
  [[nodiscard]] std::optional<Belief> belief(Index3 voxel) const;
  /// Scale of the leaf that contains the voxel; 0 outside the workspace.
  [[nodiscard]] int scale(Index3 voxel) const;

  /// Writes the states of all voxels to an array, in the order of from_states(). Throws
  /// Error(invalid_argument) unless its size is voxel_count(). Cost: one pass over the array.
  void copy_states(std::span<std::uint8_t> states) const;

  /// Sets one voxel of the workspace, for importers and tests. If no belief is given, an existing
  /// one is removed. Throws Error(invalid_argument), and changes nothing, if the voxel lies outside
  /// the workspace, the log-odds is NaN or the belief is invalid. A valid belief meets these
  /// conditions:
  /// - All numbers are finite.
  /// - The information matrix is positive semidefinite. Violations by rounding errors are repaired.
  /// - The mean of the readings is at most 2^28 voxels away from the voxel's centre.
  void set(Index3 voxel, float log_odds, const std::optional<Belief>& belief = {});
  /// Sets many voxels at once. The result is as if they were set one after the other. If one is
  /// invalid, none is set. Cost: sorting by leaves, and a copy of each changed leaf.
  void set(std::span<const VoxelValue> voxels);

  /// Makes voxels whose centres lie in the region unknown again, without log-odds and belief. The
  /// region is extended to whole cells of the map's largest scale. Views and hazard counters
  /// remain. Use it when objects have moved, and for maps that follow a robot. Returns the number
  /// of voxels that were known. Throws Error(invalid_argument) if a bound is NaN or a minimum
  /// exceeds its maximum. Cost: one pass over the map's leaves.
  std::uint64_t forget(const Box& region);

  /// Sets the voxels of a box from an array of states, as in from_states(). For planners with their
  /// own growing map. Voxels that already have the state do not change, and cost no time in
  /// VoxelScene::update(). Changed voxels lose their belief. Their leaves get scale 0. Returns the
  /// number of changed voxels. Throws Error(invalid_argument), and changes nothing, if the box is
  /// not inside the workspace, or the array has a wrong size or an invalid state. Cost: one pass
  /// over the array.
  std::uint64_t update_box(const VoxelBox& box, std::span<const std::uint8_t> states);

  /// Sets the scale of all leaves that the region touches. If a leaf is only partly inside the
  /// workspace, it gets the largest scale up to this one at which no cell crosses the workspace's
  /// border. When cells merge, their beliefs add up, and the new cell is occupied if one of the old
  /// cells was. When a cell is split, its belief goes to the new cell that contains the mean of its
  /// readings. The rest of an occupied cell becomes unknown. Returns the number of changed leaves.
  /// Throws Error(invalid_argument) if a bound is NaN or the scale is outside 0..3. Cost: one pass
  /// over the map.
  std::uint64_t resample(const Box& region, int scale);

  /// Calls `visit` for the lowest voxel of each occupied cell. Leaves come in the order of
  /// snapshot().leaves, and the voxels of a leaf in the order [x][y][z] with z fastest. Equal maps
  /// give the same order. `visit` must not change the grid. Cost: a snapshot.
  void for_each_occupied(const std::function<void(const VoxelValue&)>& visit) const;

  /// Calls `visit` for each belief, including those of free voxels, leaf by leaf in a fixed order.
  /// Within a leaf the order is [x][y][z] with z fastest.
  void for_each_belief(const std::function<void(Index3, const Belief&)>& visit) const;

  /// T_world_camera of every integrated frame, in order.
  [[nodiscard]] const std::vector<Pose>& views() const noexcept;
  /// Appends a pose to views(), after repairing it with rigid_pose(). Throws
  /// Error(invalid_argument) if the pose is not rigid within 1e-3.
  void append_view(const Pose& T_world_camera);

  /// Counts from past frames. They correct the hazard of unknown space (HazardCalibration).
  [[nodiscard]] const HazardCounters& hazard_counters() const noexcept;
  /// Replaces the counters. Throws Error(invalid_argument) if a count is negative or above 2^40.
  void set_hazard_counters(const HazardCounters& counters);

  /// Where the map's data came from: its sensor and its frames, which FrameIntegrator and
  /// CloudIntegrator record. save_vdb() and clone() keep the notes. content_hash() ignores them.
  [[nodiscard]] const MapNotes& notes() const noexcept;
  /// Replaces the notes. Throws Error(invalid_argument) if the identity of a frame is invalid
  /// (DepthFrame::identity), or MapNotes::others contains the name "sensor" or "frames".
  void set_notes(MapNotes notes);

  /// Statistics of the map. `criterion` selects the entropy. Deterministic. Cost: one pass over the
  /// map's leaves.
  [[nodiscard]] Statistics statistics(Criterion criterion = Criterion::log_diagonal) const;
  /// Statistics of the voxels whose centres lie in the region (Box::contains()). The belief of a
  /// cell counts if the centre of the cell's lowest voxel lies in the region. Throws
  /// Error(invalid_argument) if a bound is NaN.
  [[nodiscard]] Statistics statistics(const Box& region,
                                      Criterion criterion = Criterion::log_diagonal) const;
  /// Mean of √(tr(Λ_v⁻¹ + e²/12 I) / 3), the uncertainty of the surface position [m], over the
  /// region's occupied cells with a belief. e is the edge of a cell. A cell of scale s has the
  /// weight 4^s, because its area is 4^s times that of a voxel. NaN if there are no such cells.
  /// Throws Error(invalid_argument) if a bound is NaN. Cost: one pass over the occupied voxels.
  [[nodiscard]] double mean_sigma(const Box& region) const;

  /// Hash of the map's contents, as 16 hexadecimal digits. Covers states, log-odds, beliefs,
  /// scales, layout, prior, views and hazard counters. Maps with equal contents have the same hash.
  /// The number of threads, saving and loading do not affect it.
  [[nodiscard]] std::string content_hash() const;

  /// The data that a VoxelScene needs. Immutable, and independent of later changes to the grid.
  /// Beliefs are copied on write. Cost: one pass over the leaves that are not completely free.
  [[nodiscard]] GridSnapshot snapshot() const;
  /// As above, but faster: copies regions of 32³ voxels from `before` if they did not change since.
  /// `before` must be a snapshot of this grid, or of the grid that it was cloned from. Any other
  /// snapshot has no effect.
  [[nodiscard]] GridSnapshot snapshot(const GridSnapshot& before) const;

 private:
  friend struct detail::GridAccess;  // for this module's sources
  explicit BeliefGrid(std::unique_ptr<detail::GridStorage> storage);
  std::unique_ptr<detail::GridStorage> storage_;
};

}  // namespace viewgain
