// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/raycast/gain_family.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain {

namespace detail {
struct ClassicMapData;
struct ClassicAccess;
}  // namespace detail

/// The gains of the literature, by name; apps/literature/README.md has equations and sources. Sums
/// run over the rays of a view and the voxels v of each, in order; H is the entropy of a voxel's
/// occupancy [nat] and P its visibility, the product of what the voxels before it on the ray let
/// through.
enum class ClassicGain : std::uint8_t {
  occlusion_aware,         ///< Σ P H [nat]
  unobserved_voxel,        ///< Σ P H over unknown voxels [nat]
  average_entropy,         ///< mean of H over the voxels passed [nat]
  rear_side_voxel,         ///< rays that come to a surface through an unknown voxel [rays]
  rear_side_entropy,       ///< Σ P H over the unknown voxels before such a surface [nat]
  proximity_count,         ///< Σ (most - steps behind a measured surface) over unknown [voxels]
  area_factor,             ///< of the shares of rays that meet surface, and what it hides [1]
  unknown_volume,          ///< Σ of the rays' cones within unknown voxels [m³]
  unknown_count,           ///< distinct unknown voxels [voxels]
  surface_frontier_count,  ///< those of them with a free and an occupied neighbour [voxels]
};
/// Names of the gains, in their order.
[[nodiscard]] VIEWGAIN_EXPORT const std::vector<std::string>& classic_gain_names();
/// The gain's name, as parse_classic_gain() reads it. Throws std::out_of_range for a number that is
/// none of them.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view classic_gain_name(ClassicGain gain);
/// Throws Error(invalid_argument) that lists the valid names.
[[nodiscard]] VIEWGAIN_EXPORT ClassicGain parse_classic_gain(std::string_view name);
/// "nat", "rays", "voxels", "m^3" or "1". Throws std::out_of_range for a number that is none of
/// them.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view classic_gain_unit(ClassicGain gain);
/// Does it need to know how far unknown voxels are behind what earlier views measured? Never
/// throws.
[[nodiscard]] VIEWGAIN_EXPORT bool needs_occlusion(ClassicGain gain);

/// These as a family for register_gains(), by ClassicGainEvaluator.
[[nodiscard]] VIEWGAIN_EXPORT std::shared_ptr<const GainFamily> literature_gains();

/// What changes the answer.
struct VIEWGAIN_EXPORT ClassicConfig {
  std::vector<ClassicGain> gains;     ///< results are in this order
  int pixel_stride = 1;               ///< every s-th pixel of every s-th row, from pixel (0,0)
  std::optional<double> min_range{};  ///< along the ray [m]; the sensor's unless given
  std::optional<double> max_range{};  ///< along the ray [m]; the sensor's unless given
  double unknown_prior = 0.5;         ///< probability p of a voxel that no reading told of
};

/// The sensor that a map's readings came from, and how far behind surfaces what it hid counts.
struct VIEWGAIN_EXPORT Acquisition {
  Sensor sensor;                 ///< that the map's readings come from
  double occlusion_depth = 0.3;  ///< along its rays, behind where they meet the surface [m]
};

/// What the classic gains read of a map: its scene, the log-odds of all voxels and, where they are
/// asked for, the occlusion distances of unknown ones. An immutable value to be shared: members may
/// be called from many threads. Members take any voxel and never throw; calls cost constant time.
///
/// Occlusion distances: each ray of each view that the map remembers (BeliefGrid::views(), all
/// pixels of `sensor`, from its min_range on) runs to the first occupied voxel within its
/// max_range, unless an obstacle is before it. The k-th voxel behind that which the ray enters
/// within occlusion_depth is k steps behind a measured surface, if it is unknown; the least of all
/// rays counts.
class VIEWGAIN_EXPORT ClassicMap {
 public:
  /// Obstacles are the scene's, voxels those of `grid` as it is. Throws Error(invalid_argument) for
  /// a null scene or one of another workspace, a sensor that is not valid, or a depth that is
  /// negative, not finite or over 140 voxels; Error(capacity) beyond 2^24 cubes of 128 voxels or
  /// 2^31 voxels where blocks of 8³ are not uniform. One pass over the map (some milliseconds at
  /// 128³) and, with `acquisition`, one over the rays of its views, on all threads of `exec`.
  [[nodiscard]] static std::shared_ptr<const ClassicMap> build(
      std::shared_ptr<const VoxelScene> scene, const BeliefGrid& grid,
      const std::optional<Acquisition>& acquisition = {}, const ExecConfig& exec = {});
  ~ClassicMap();
  ClassicMap(const ClassicMap&) = delete;
  ClassicMap& operator=(const ClassicMap&) = delete;

  /// The scene that the map was made of.
  [[nodiscard]] const VoxelScene& scene() const noexcept;
  /// Steps behind a measured surface of an unknown voxel; 0: none known.
  [[nodiscard]] int occlusion_steps(Index3 voxel) const;
  /// Is it unknown, with a free and an occupied one among its 26 neighbours in the workspace?
  [[nodiscard]] bool is_surface_frontier(Index3 voxel) const;
  /// Memory beside the scene's.
  [[nodiscard]] std::uint64_t bytes() const noexcept;

 private:
  friend struct detail::ClassicAccess;
  explicit ClassicMap(std::unique_ptr<const detail::ClassicMapData> data);
  std::unique_ptr<const detail::ClassicMapData> data_;
};

/// Scores camera poses by any number of classic gains at once. A ray visits, for a positive length
/// and in order, the voxels of the workspace from min_range on to the first occupied one (log-odds
/// above 0), which it ends in, or to max_range, a known obstacle, the scene's support plane or the
/// workspace's edge; none if it enters an occupied one before min_range. Nothing outside the
/// workspace counts, and no ray twice; but a voxel that several rays pass counts with each of them,
/// unless its gain says distinct.
///
/// Rays are in single precision, as the tracer's: some in a hundred thousand go by the other side
/// of a voxel's edge. Else gains agree with sums in double precision to 1e-5, counts of rays
/// to 5e-4 and unknown_volume to 1e-3 (README.md). Thread safety: const
/// members may run from many threads at once. Determinism: the same bits for any number of threads.
///
/// Cost of evaluate(): all ten gains together take some 20 times the time of the paper's gain
/// (perf/README.md). Cost of the constructor: a PinholeCamera::ray() a pixel; of with_map()
/// constant time.
class VIEWGAIN_EXPORT ClassicGainEvaluator {
 public:
  /// Throws Error(invalid_argument), naming the value: no gain, one twice, a null map, a sensor
  /// that is not valid, a stride below 1, ranges as GainConfig's, an unknown_prior outside 0..1, a
  /// gain that needs occlusion distances of a map that was built without.
  ClassicGainEvaluator(std::shared_ptr<const ClassicMap> map, const Sensor& sensor,
                       const ClassicConfig& config, const ExecConfig& exec = {});
  ~ClassicGainEvaluator();
  ClassicGainEvaluator(ClassicGainEvaluator&&) noexcept;
  ClassicGainEvaluator& operator=(ClassicGainEvaluator&&) noexcept;

  /// The evaluator of another map, for following one as it grows; rays and threads are shared.
  /// Throws as the constructor does for a map.
  [[nodiscard]] ClassicGainEvaluator with_map(std::shared_ptr<const ClassicMap> map) const;

  /// Gains of a batch: `results` in the unit of each gain, results[i * gains + g] for pose i and
  /// gain g of the configuration. A bad pose (see ViewGain::Status) has NaN, a camera in an
  /// occupied voxel 0. `statuses` is empty or has one place a pose. Returns how many poses were
  /// scored: all, or fewer if `control` ended the call, when the others keep NaN and bad_pose.
  /// Throws Error(invalid_argument) if the sizes do not fit.
  std::size_t evaluate(std::span<const Pose> T_world_camera, std::span<double> results,
                       std::span<ViewGain::Status> statuses = {},
                       const BatchControl& control = {}) const;
  /// The same, into a new array: row i for pose i.
  [[nodiscard]] std::vector<double> evaluate(std::span<const Pose> T_world_camera) const;

  /// What it was made with.
  [[nodiscard]] const ClassicConfig& config() const noexcept;
  /// What poses are scored against.
  [[nodiscard]] const ClassicMap& map() const noexcept;
  /// One for each pixel of the strided image.
  [[nodiscard]] std::size_t rays_per_pose() const noexcept;
  /// Threads that a batch runs on.
  [[nodiscard]] int num_threads() const noexcept;

 private:
  struct Impl;
  explicit ClassicGainEvaluator(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
