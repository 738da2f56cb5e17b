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

/// Layout of a map; by default for an object at the origin. A value type.
struct VIEWGAIN_EXPORT GridConfig {
  double voxel_size = 0.005;  ///< voxel size V [m]
  /// Grid frame [m]; extended to whole voxels, see BeliefGrid.
  Box workspace{{-0.25, -0.25, -0.25}, {0.25, 0.25, 0.25}};
  Pose T_world_grid{};  ///< pose of the grid frame in the world
  /// Standard deviation sigma_0 [m] of an unknown voxel; defaults to default_prior_sigma() of the
  /// map's sensor.
  std::optional<double> prior_sigma{};
};

/// The belief grid: the state of a workspace, voxel by voxel.
///
/// Voxel (i,j,k) covers [i,i+1) x [j,j+1) x [k,k+1) times V in the grid frame. The workspace is
/// extended to whole voxels. A face within 1e-6 voxels of a voxel boundary counts as lying on it.
/// At first all voxels are unknown, which takes little memory. A known voxel has a log-odds in
/// steps of 0.05 within [-2, 3.5]. If the log-odds is above 0, the voxel is occupied, otherwise
/// free. Readings (measured depths) that end in a voxel hit it. A voxel that was hit has a Belief,
/// and keeps the belief if it becomes free.
///
/// Each leaf of 8³ voxels has a scale s, initially 0 and at most 3. It is divided into cells of 2^s
/// voxels per edge. All voxels of a cell share one state, log-odds and belief
/// (apps/docs/guide/scales.md).
///
/// Thread safety: const members may run from many threads at once, but not during a non-const one.
/// Snapshots are independent of the grid. Members that look at one voxel take constant time.
class VIEWGAIN_EXPORT BeliefGrid {
 public:
  /// A known voxel, for set() and for_each_occupied().
  struct VoxelValue {
    Index3 voxel;                    ///< in the workspace; for a visited cell, its lowest voxel
    float log_odds = 0;              ///< set() rounds it to the nearest step of 0.05 and clamps it
    std::optional<Belief> belief{};  ///< empty: no belief; set() then removes an existing one
  };

  /// Voxel counts of a map or a part of it, and the removed entropy that measures progress in Foix
  /// et al. (2012).
  struct Statistics {
    std::uint64_t unknown = 0;   ///< voxels never observed
    std::uint64_t free = 0;      ///< voxels known to be free
    std::uint64_t occupied = 0;  ///< voxels known to be occupied
    std::uint64_t bytes = 0;     ///< memory of the whole map: tree, beliefs and bookkeeping
    /// Sum over occupied voxels of H(Λ_0) - H(Λ_0 + Λ_v) [nat, or m² for trace]; a cell of scale s
    /// counts as 4^s voxels that share its Λ.
    double entropy_removed = 0;
    /// Number of readings that ended in the map or part. Their voxels may be free by now.
    std::uint64_t hits = 0;
  };

  /// `sensor`: the map's sensor, which determines prior_sigma if that is not set. Throws
  /// Error(invalid_argument) naming the value if voxel_size is below 2e-5 m, voxel_size or
  /// prior_sigma is not positive and finite, the workspace is not finite or is inside out, or
  /// T_world_grid is not a rigid transform (1e-9). Throws Error(capacity) above 65,536 voxels along
  /// an axis, 2^40 voxels, or indices of ±2^30.
  explicit BeliefGrid(const GridConfig& config, const Sensor& sensor = {});
  ~BeliefGrid();
  BeliefGrid(BeliefGrid&&) noexcept;
  BeliefGrid& operator=(BeliefGrid&&) noexcept;

  /// Makes a map from a dense array of states, [x][y][z] with z fastest, one per voxel of the
  /// workspace: 0 unknown, 1 free (log-odds -0.4), 2 occupied (log-odds 0.85, no belief). Because
  /// beliefs are missing, GainModel::paper rewards measuring occupied voxels again; the other gains
  /// do not. Throws Error(invalid_argument) for another size or state. Also throws whatever the
  /// constructor throws. Cost: one pass over the array.
  [[nodiscard]] static BeliefGrid from_states(const GridConfig& config,
                                              std::span<const std::uint8_t> states,
                                              const Sensor& sensor = {});

  /// A deep copy. Cost: a copy of the tree; beliefs are copied when they change.
  [[nodiscard]] BeliefGrid clone() const;

  [[nodiscard]] double voxel_size() const noexcept;  ///< [m]
  /// Pose of the grid frame in the world.
  [[nodiscard]] const Pose& T_world_grid() const noexcept;
  [[nodiscard]] double prior_sigma() const noexcept;  ///< [m]
  [[nodiscard]] Index3 min_index() const noexcept;    ///< lowest voxel of the workspace
  [[nodiscard]] Index3 dims() const noexcept;         ///< voxels along x, y, z
  [[nodiscard]] Box workspace() const noexcept;       ///< extended to the lattice, grid frame [m]
  /// Number of voxels in the workspace.
  [[nodiscard]] std::uint64_t voxel_count() const noexcept;

  /// The voxel that contains a point of the world [m]; empty outside the workspace or if the point
  /// is not finite.
  [[nodiscard]] std::optional<Index3> index_of(const Eigen::Vector3d& p_world) const;
  /// Centre of a voxel in the world [m]; any voxel of the lattice.
  [[nodiscard]] Eigen::Vector3d center(Index3 voxel) const;

  /// State of a voxel; unknown outside the workspace, where a voxel has neither log-odds nor
  /// belief.
  [[nodiscard]] VoxelState state(Index3 voxel) const;
  /// Log-odds of a voxel; empty if unknown.
  [[nodiscard]] std::optional<float> log_odds(Index3 voxel) const;
  /// Belief of a voxel; empty if it was never hit.
  [[nodiscard]] std::optional<Belief> belief(Index3 voxel) const;
  /// Scale of the leaf that contains the voxel; 0 outside the workspace.
  [[nodiscard]] int scale(Index3 voxel) const;

  /// Writes the states of all voxels to a dense array, [x][y][z] with z fastest. Throws
  /// Error(invalid_argument) unless the size is voxel_count(). Cost: one pass over the array.
  void copy_states(std::span<std::uint8_t> states) const;

  /// Sets one voxel of the workspace, for importers and tests. If no belief is given, an existing
  /// one is removed. Throws Error(invalid_argument) without a change if the voxel lies outside the
  /// workspace, the log-odds is NaN, or the belief is impossible: a number that is not finite,
  /// information that is not positive semidefinite, or a position Λ⁻¹η more than 2^28 voxels away.
  /// Rounding errors of the information are repaired.
  void set(Index3 voxel, float log_odds, const std::optional<Belief>& belief = {});
  /// Sets many voxels, with the same result as one by one in order, but faster. If one is invalid,
  /// none is set. Cost: sorting by blocks, and a copy of each changed block.
  void set(std::span<const VoxelValue> voxels);

  /// Resets voxels whose centres lie in a region of the grid frame [m] to unknown, without log-odds
  /// and belief. Bounds may be infinite. The region is extended to whole cells of the map's largest
  /// scale. Views and hazard counters remain. Use it after objects have moved, and for maps that
  /// follow a robot. Returns the number of voxels that were known. Throws Error(invalid_argument)
  /// for a bound that is NaN or a region inside out. Cost: one pass over the map's blocks.
  std::uint64_t forget(const Box& region);

  /// Sets the voxels of a lattice box from a dense array of states, [x][y][z] with z fastest, as in
  /// from_states(); for planners with their own growing map. A voxel that already has the state
  /// does not change; others get the log-odds of from_states() and no belief. Changed leaves get
  /// scale 0 (resample()). Returns the number of changed voxels; only these cost time in
  /// VoxelScene::update(). Throws Error(invalid_argument) without a change if the box is not inside
  /// the workspace, and for another size or state. Cost: one pass over the array.
  std::uint64_t update_box(const VoxelBox& box, std::span<const std::uint8_t> states);

  /// Sets the scale of the leaves that a region of the grid frame [m] touches; bounds may be
  /// infinite. A leaf that the workspace cuts off gets the largest scale that fits. When cells
  /// merge, their beliefs add up, and the new cell is occupied if one of the old cells was. When a
  /// cell is split, its belief goes to the new cell that contains the mean of its readings. The
  /// other parts of an occupied cell become unknown. Returns the number of changed leaves. Throws
  /// Error(invalid_argument) for a NaN or a scale outside 0..3. Cost: one pass over the map.
  std::uint64_t resample(const Box& region, int scale);

  /// Visits occupied voxels, one per cell. Leaves come in the order of snapshot().leaves, the
  /// voxels of a leaf in the order [x][y][z] with z fastest. Equal maps give the same order. The
  /// visit must not change the grid. Cost: a snapshot.
  void for_each_occupied(const std::function<void(const VoxelValue&)>& visit) const;

  /// Visits all beliefs, including those of free voxels, block by block in a fixed order. Within a
  /// block the order is [x][y][z] with z fastest.
  void for_each_belief(const std::function<void(Index3, const Belief&)>& visit) const;

  /// T_world_camera of every integrated frame, in order.
  [[nodiscard]] const std::vector<Pose>& views() const noexcept;
  /// Appends a view. Throws Error(invalid_argument) if the pose is not rigid (1e-3; smaller
  /// deviations are orthonormalised).
  void append_view(const Pose& T_world_camera);

  /// Counters of frames for the hazard of unknown space (HazardCalibration).
  [[nodiscard]] const HazardCounters& hazard_counters() const noexcept;
  /// Replaces the counters. Throws Error(invalid_argument) for a count that is negative or above
  /// 2^40.
  void set_hazard_counters(const HazardCounters& counters);

  /// Where the map comes from. FrameIntegrator and CloudIntegrator record sensor and frames;
  /// save_vdb() and clone() keep them. Notes are not part of content_hash().
  [[nodiscard]] const MapNotes& notes() const noexcept;
  /// Replaces the notes. Throws Error(invalid_argument) for an invalid identity of a frame
  /// (DepthFrame::identity), and if MapNotes::others contains the name "sensor" or "frames".
  void set_notes(MapNotes notes);

  /// Statistics of the map; the criterion applies to the removed entropy. Deterministic. Cost: one
  /// pass over the map's blocks.
  [[nodiscard]] Statistics statistics(Criterion criterion = Criterion::log_diagonal) const;
  /// Statistics of the voxels whose centres lie in a half-open region of the grid frame [m]. The
  /// belief of a cell larger than a voxel counts if the centre of the cell's lowest voxel lies in
  /// the region. Bounds may be infinite. Throws Error(invalid_argument) if a bound is NaN.
  [[nodiscard]] Statistics statistics(const Box& region,
                                      Criterion criterion = Criterion::log_diagonal) const;
  /// Mean position uncertainty [m] of the region's occupied voxels with a belief: √(tr(Λ_v⁻¹ +
  /// e²/12 I) / 3), where e is the edge of the cell. A cell of scale s has the weight 4^s, because
  /// its area is 4^s times that of a voxel. NaN if there are no such voxels. Throws like
  /// statistics(). Cost: one pass over the occupied voxels.
  [[nodiscard]] double mean_sigma(const Box& region) const;

  /// Hash of states, log-odds, beliefs, layout, prior, views and, if present, hazard counters and
  /// scales; 16 hexadecimal digits. Equal maps have the same hash, independent of thread count,
  /// save and load, and tree topology.
  [[nodiscard]] std::string content_hash() const;

  /// The data that a VoxelScene needs. Immutable and independent of later changes to the grid;
  /// beliefs are shared and copied on write. Cost: one pass over the leaves that are not free.
  [[nodiscard]] GridSnapshot snapshot() const;
  /// The same result, but faster: leaves in regions of 32³ voxels that did not change since
  /// `before` are copied from `before`. `before` must come from this grid or the grid it was cloned
  /// from; any other snapshot has no effect.
  [[nodiscard]] GridSnapshot snapshot(const GridSnapshot& before) const;

 private:
  friend struct detail::GridAccess;  // for this module's sources
  explicit BeliefGrid(std::unique_ptr<detail::GridStorage> storage);
  std::unique_ptr<detail::GridStorage> storage_;
};

}  // namespace viewgain
