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

/// How a map is laid out; by default for an object at the origin. A value type.
struct VIEWGAIN_EXPORT GridConfig {
  double voxel_size = 0.005;  ///< V [m]
  /// In the grid's frame [m]; grown outward to whole voxels, see BeliefGrid.
  Box workspace{{-0.25, -0.25, -0.25}, {0.25, 0.25, 0.25}};
  Pose T_world_grid{};  ///< places the grid's frame
  /// sigma_0 [m] of an unknown voxel; default_prior_sigma() of the map's sensor unless given.
  std::optional<double> prior_sigma{};
};

/// The belief grid: what is known of a workspace, voxel by voxel.
///
/// Voxel (i,j,k) is [i,i+1) x [j,j+1) x [k,k+1) times V in the grid's frame. The workspace is grown
/// outward to the lattice; a face within 1e-6 voxel of the lattice is not moved. Every voxel starts
/// unknown and an unknown workspace costs a few tiles. A known voxel has a log-odds in steps of
/// 0.05 within [-2, 3.5]: occupied above 0, else free. A voxel that was ever hit has a Belief,
/// which it keeps when it turns free.
///
/// Each 8³ leaf of the lattice has a scale s, 0 to 3: its voxels are known by cells of 2^s voxels
/// an edge. A cell has one state, one log-odds and one belief. What reads or sets a voxel reads or
/// sets its cell. A new map has scale 0 everywhere.
///
/// Thread safety: const members may run from many threads at once; nothing may run beside a
/// non-const member. Snapshots are independent of the grid once taken. Members that refuse a value
/// say so; the others take any. Members that look at one voxel cost constant time.
class VIEWGAIN_EXPORT BeliefGrid {
 public:
  /// A known voxel: what set() makes of one, and what for_each_occupied() shows.
  struct VoxelValue {
    Index3 voxel;                    ///< of the workspace; of a cell that is shown, its lowest
    float log_odds = 0;              ///< set() rounds it to the nearest step of 0.05 and clamps it
    std::optional<Belief> belief{};  ///< none: it has none, and after set() none any more
  };

  /// Voxel counts and the paper's measure of progress, of a map or a part of it ("selected parts").
  struct Statistics {
    std::uint64_t unknown = 0;   ///< voxels never observed
    std::uint64_t free = 0;      ///< voxels known to be free
    std::uint64_t occupied = 0;  ///< voxels known to be occupied
    std::uint64_t bytes = 0;     ///< memory of the whole map: tree, beliefs, book-keeping
    double entropy_removed =
        0;  ///< sum over occupied of H(Λ_0) - H(Λ_0 + Λ_v) [nat, or m² for trace]; a cell of scale
            ///< s counts as 4^s voxels that share its Λ
    std::uint64_t hits = 0;  ///< readings that ended there, whatever the voxels are now
  };

  /// `sensor`: that the map is for, which is asked where there is no prior_sigma. Throws
  /// Error(invalid_argument) naming the value unless voxel_size is at least 2e-5 m (smaller ones
  /// have no OpenVDB transform), it and prior_sigma are positive and finite, the workspace is
  /// finite and not inside out, T_world_grid is a rigid transform (1e-9), and Error(capacity) if
  /// the workspace has more than 65,536 voxels along an axis, more than 2^40 in all, or indices
  /// beyond +-2^30.
  explicit BeliefGrid(const GridConfig& config, const Sensor& sensor = {});
  ~BeliefGrid();
  BeliefGrid(BeliefGrid&&) noexcept;
  BeliefGrid& operator=(BeliefGrid&&) noexcept;

  /// From a dense array of states, [x][y][z] with z fastest, one per voxel of the workspace: 0
  /// unknown, 1 free (log-odds -0.4), 2 occupied (log-odds 0.85, no belief yet). Such a map
  /// does not know what was measured: GainModel::paper would have known surface measured again and
  /// again, the other gains leave it out. Throws Error(invalid_argument) for another size or
  /// another state, and as the constructor. Cost: a pass over the array.
  [[nodiscard]] static BeliefGrid from_states(const GridConfig& config,
                                              std::span<const std::uint8_t> states,
                                              const Sensor& sensor = {});

  /// A deep copy, in which beliefs are shared until one of both changes. Costs a copy of the tree.
  [[nodiscard]] BeliefGrid clone() const;

  [[nodiscard]] double voxel_size() const noexcept;  ///< [m]
  /// Places the grid's frame in the world.
  [[nodiscard]] const Pose& T_world_grid() const noexcept;
  [[nodiscard]] double prior_sigma() const noexcept;  ///< [m]
  [[nodiscard]] Index3 min_index() const noexcept;    ///< lowest voxel of the workspace
  [[nodiscard]] Index3 dims() const noexcept;         ///< voxels along x, y, z
  [[nodiscard]] Box workspace() const noexcept;       ///< grown to the lattice, grid frame [m]
  /// How many voxels the workspace has.
  [[nodiscard]] std::uint64_t voxel_count() const noexcept;

  /// The voxel that holds a point of the world [m]; nothing outside the workspace, or if the point
  /// is not finite.
  [[nodiscard]] std::optional<Index3> index_of(const Eigen::Vector3d& p_world) const;
  /// Centre of a voxel in the world [m]; it need not lie in the workspace.
  [[nodiscard]] Eigen::Vector3d center(Index3 voxel) const;

  /// Unknown outside the workspace, where a voxel has no log-odds and no belief either.
  [[nodiscard]] VoxelState state(Index3 voxel) const;
  /// Nothing for an unknown voxel.
  [[nodiscard]] std::optional<float> log_odds(Index3 voxel) const;
  /// Nothing for a voxel that was never hit.
  [[nodiscard]] std::optional<Belief> belief(Index3 voxel) const;
  /// Of the leaf that holds the voxel; 0 outside the workspace.
  [[nodiscard]] int scale(Index3 voxel) const;

  /// Fills the dense array of states, [x][y][z] with z fastest; size must be voxel_count(), else
  /// throws Error(invalid_argument). Cost: a pass over the array.
  void copy_states(std::span<std::uint8_t> states) const;

  /// Sets one voxel of the workspace, for importers and tests; without a belief it has none
  /// afterwards. Throws Error(invalid_argument) outside the workspace, for a log-odds that is NaN,
  /// or for a belief that no readings make: a number that is not finite, information that is not
  /// positive semidefinite (but for the rounding of `hits` sums), or a place Λ⁻¹η that is absurdly
  /// far (2^28 voxels) from the voxel. The grid is unchanged then. What rounding has left short of
  /// positive definite has its diagonal raised until it is.
  void set(Index3 voxel, float log_odds, const std::optional<Belief>& belief = {});
  /// Sets many voxels: as one by one in their order, but faster, and all or none if one of them is
  /// refused. Costs a sort of them by blocks, and a copy of each block that they change.
  void set(std::span<const VoxelValue> voxels);

  /// Makes the voxels of the workspace unknown again whose centres lie in a region of the grid's
  /// frame [m]; bounds may be infinite. In a map with larger cells the region is grown to the
  /// largest there are. They have no log-odds and no belief afterwards; views and
  /// hazard counters stay as they are. For what has moved, and for maps that follow a robot.
  /// Returns how many of the voxels were known. Costs a pass over the map's blocks. Throws
  /// Error(invalid_argument) for a bound that is not a number, or a region inside out.
  std::uint64_t forget(const Box& region);

  /// Makes the voxels of a box of the lattice what a dense array says, [x][y][z] with z fastest, as
  /// from_states() has it: for a planner with a map of its own, which grows. Leaves in which
  /// something changes go to scale 0 first (resample()). Where a voxel's state
  /// is that already nothing changes; elsewhere it has the log-odds that from_states() gives, and
  /// no belief. What VoxelScene::update() does anew is what has changed. Returns how many voxels
  /// have. Throws Error(invalid_argument) for a box that is not inside the workspace, another size
  /// or another state; nothing has changed then. Costs a pass over the array.
  std::uint64_t update_box(const VoxelBox& box, std::span<const std::uint8_t> states);

  /// Gives the leaves that a region of the grid's frame [m] touches another scale; bounds may be
  /// infinite. Leaves that are uniform and without beliefs have none, and those that the workspace
  /// cuts off within a cell take the largest that fits. Upwards a cell's hits and Λ are sums, η is
  /// moved to its centre; it is occupied if a voxel is, else unknown if one is and none was hit.
  /// Downwards all goes to the voxel, or smaller cell, that holds the mean Λ⁻¹η; what else was
  /// occupied with it becomes unknown. Returns how many leaves have changed. Costs a pass over the
  /// map's blocks. Throws Error(invalid_argument) for a bound that is not a number or a scale that
  /// is not 0 to 3.
  std::uint64_t resample(const Box& region, int scale);

  /// Visits the occupied voxels, of cells one each: by leaves in the order of snapshot().leaves, in
  /// a leaf [x][y][z] with z fastest. Equal maps give the same order. The visit must not change the
  /// grid. Costs a snapshot.
  void for_each_occupied(const std::function<void(const VoxelValue&)>& visit) const;

  /// Visits all beliefs, those of free voxels too, by blocks in a fixed order, in a block [x][y][z]
  /// with z fastest. Costs a look at each.
  void for_each_belief(const std::function<void(Index3, const Belief&)>& visit) const;

  /// T_world_camera of every frame integrated so far, in order.
  [[nodiscard]] const std::vector<Pose>& views() const noexcept;
  /// Throws Error(invalid_argument) if the pose is not rigid (1e-3; smaller errors are
  /// orthonormalised).
  void append_view(const Pose& T_world_camera);

  /// What frames have said of the hazard of unknown space (HazardCalibration).
  [[nodiscard]] const HazardCounters& hazard_counters() const noexcept;
  /// Throws Error(invalid_argument) for a count that is negative or over 2^40.
  void set_hazard_counters(const HazardCounters& counters);

  /// Its origin: FrameIntegrator and CloudIntegrator note sensor and frames, save_vdb() and clone()
  /// keep them. No part of content_hash().
  [[nodiscard]] const MapNotes& notes() const noexcept;
  /// Throws Error(invalid_argument) for an identity of a frame that is none (DepthFrame::identity),
  /// and if MapNotes::others has the name "sensor" or "frames".
  void set_notes(MapNotes notes);

  /// How much is known, and how well; the entropy removed is by this criterion. Costs a pass over
  /// the map's blocks. Deterministic.
  [[nodiscard]] Statistics statistics(Criterion criterion = Criterion::log_diagonal) const;
  /// The same of the voxels whose centres lie in a region of the grid's frame [m], half-open; of
  /// larger cells the lowest voxel decides over the belief. Bounds may be infinite. Throws
  /// Error(invalid_argument) if one is NaN.
  [[nodiscard]] Statistics statistics(const Box& region,
                                      Criterion criterion = Criterion::log_diagonal) const;
  /// Mean of √(tr(Λ_v⁻¹ + cell²/12 I) / 3) over the region's occupied voxels with a belief [m];
  /// NaN without. A cell of scale s counts 4^s times, by its area. Throws as statistics(). Costs a
  /// pass over the occupied voxels.
  [[nodiscard]] double mean_sigma(const Box& region) const;

  /// 16 hexadecimal digits over states, log-odds, beliefs, layout, prior, views and, if there are
  /// any, hazard counters and scales. The same for
  /// equal maps however they came about (thread count, save and load, tree topology).
  [[nodiscard]] std::string content_hash() const;

  /// What a scene needs, immutable and independent of later changes to the grid; beliefs are shared
  /// and copied only when written. Costs one pass over the non-free leaves.
  [[nodiscard]] GridSnapshot snapshot() const;
  /// The same result; leaves of regions of 32³ voxels that have not changed since `before` was
  /// taken of this grid, or of the one that it is a clone of, are copied from there. Any other
  /// snapshot is as good as none.
  [[nodiscard]] GridSnapshot snapshot(const GridSnapshot& before) const;

 private:
  friend struct detail::GridAccess;  // this module's sources
  explicit BeliefGrid(std::unique_ptr<detail::GridStorage> storage);
  std::unique_ptr<detail::GridStorage> storage_;
};

}  // namespace viewgain
