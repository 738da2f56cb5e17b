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

/// Gains of the literature; apps/literature/README.md has equations and sources. Sums run over the
/// rays of a view and over the voxels of each ray. H is the entropy of a voxel's occupancy [nat]. P
/// is its visibility: the probability that the ray passes all nearer voxels.
enum class ClassicGain : std::uint8_t {
  occlusion_aware,    ///< Σ P H [nat]
  unobserved_voxel,   ///< Σ P H over unknown voxels [nat]
  average_entropy,    ///< mean of H over the crossed voxels [nat]
  rear_side_voxel,    ///< rays whose last voxel in front of a surface is unknown [rays]
  rear_side_entropy,  ///< Σ P H over the consecutive unknown voxels in front of that surface [nat]
  proximity_count,    ///< unknown voxels behind a measured surface; those near it weigh more
                      ///< [voxels]
  /// From two fractions of the rays: those that hit a surface, and those that reach space hidden by
  /// one. Dimensionless.
  area_factor,
  unknown_volume,          ///< Σ of the volume of the rays' cones in unknown voxels [m³]
  unknown_count,           ///< distinct unknown voxels [voxels]
  surface_frontier_count,  ///< distinct unknown voxels with a free and an occupied neighbour
                           ///< [voxels]
};
/// Names of the gains, in enumeration order.
[[nodiscard]] VIEWGAIN_EXPORT const std::vector<std::string>& classic_gain_names();
/// Name of the gain, as parse_classic_gain() reads it. Throws std::out_of_range for an invalid
/// value.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view classic_gain_name(ClassicGain gain);
/// Parses a name. Throws Error(invalid_argument) listing the valid names.
[[nodiscard]] VIEWGAIN_EXPORT ClassicGain parse_classic_gain(std::string_view name);
/// Unit: "nat", "rays", "voxels", "m^3" or "1". Throws std::out_of_range for an invalid value.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view classic_gain_unit(ClassicGain gain);
/// Whether the gain needs the occlusion distances of ClassicMap. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT bool needs_occlusion(ClassicGain gain);

/// These gains as a family for register_gains(), computed by ClassicGainEvaluator.
[[nodiscard]] VIEWGAIN_EXPORT std::shared_ptr<const GainFamily> literature_gains();

/// Settings that affect the gains.
struct VIEWGAIN_EXPORT ClassicConfig {
  std::vector<ClassicGain> gains;  ///< gains to compute; results follow this order
  int pixel_stride = 1;            ///< traces every s-th pixel of every s-th row, from pixel (0,0)
  std::optional<double> min_range{};  ///< along the ray [m]; defaults to the sensor's
  std::optional<double> max_range{};  ///< along the ray [m]; defaults to the sensor's
  double unknown_prior = 0.5;         ///< occupancy probability p of an unobserved voxel
};

/// The sensor that measured a map, and the depth of occlusion behind surfaces.
struct VIEWGAIN_EXPORT Acquisition {
  Sensor sensor;                 ///< sensor that measured the map
  double occlusion_depth = 0.3;  ///< how far occlusion extends behind the hit of a ray [m]
};

/// Data of a map for the classic gains: its scene, the log-odds of all voxels and, if requested,
/// the occlusion distances of unknown ones. Immutable; members may be called from many threads,
/// accept any voxel, never throw and take constant time.
///
/// Occlusion distances: each ray of each view of the map (BeliefGrid::views()) runs from min_range
/// to the first occupied voxel within max_range, unless an obstacle stops it. If the k-th voxel
/// behind that voxel is unknown and within occlusion_depth, its occlusion distance is k steps. The
/// smallest distance over all rays counts.
class VIEWGAIN_EXPORT ClassicMap {
 public:
  /// Uses the scene's obstacles and the voxels of the current `grid`. Throws
  /// Error(invalid_argument) for a scene that is null or has another workspace, an invalid sensor,
  /// or an occlusion_depth that is negative, not finite or above 140 voxels. Throws Error(capacity)
  /// if the map is too large. Cost: one pass over the map (some milliseconds at 128³ voxels) and,
  /// with `acquisition`, one over the rays of its views, on all threads of `exec`.
  [[nodiscard]] static std::shared_ptr<const ClassicMap> build(
      std::shared_ptr<const VoxelScene> scene, const BeliefGrid& grid,
      const std::optional<Acquisition>& acquisition = {}, const ExecConfig& exec = {});
  ~ClassicMap();
  ClassicMap(const ClassicMap&) = delete;
  ClassicMap& operator=(const ClassicMap&) = delete;

  /// The scene of the map.
  [[nodiscard]] const VoxelScene& scene() const noexcept;
  /// Occlusion distance of the voxel [steps]; 0 if it has none.
  [[nodiscard]] int occlusion_steps(Index3 voxel) const;
  /// Whether the voxel is unknown, and its 26 neighbours in the workspace include a free and an
  /// occupied voxel.
  [[nodiscard]] bool is_surface_frontier(Index3 voxel) const;
  /// Memory in addition to the scene's [bytes].
  [[nodiscard]] std::uint64_t bytes() const noexcept;

 private:
  friend struct detail::ClassicAccess;
  explicit ClassicMap(std::unique_ptr<const detail::ClassicMapData> data);
  std::unique_ptr<const detail::ClassicMapData> data_;
};

/// Computes any number of classic gains of camera poses at once. A ray visits, in order, the voxels
/// of the workspace that it crosses from min_range on. It ends in the first occupied voxel
/// (log-odds above 0), or at max_range, an obstacle, the support plane or the workspace's edge. A
/// ray that enters an occupied voxel nearer than min_range visits none. Each ray counts a voxel
/// once; several rays count it several times, unless the gain counts distinct voxels.
///
/// Rays are in single precision; apps/literature/README.md states the accuracy. Thread safety:
/// const members may run from many threads at once. Bit-identical for any number of threads.
///
/// Cost of evaluate(): all ten gains together take about 20 times as long as the paper's gain
/// (perf/README.md). Cost of the constructor: one PinholeCamera::ray() per pixel; with_map() takes
/// constant time.
class VIEWGAIN_EXPORT ClassicGainEvaluator {
 public:
  /// Throws Error(invalid_argument) naming the value for an empty list of gains, a duplicate gain,
  /// a null map, an invalid sensor, a stride below 1, invalid ranges, or an unknown_prior outside
  /// 0..1. Also throws it for a gain that needs occlusion distances if the map has none.
  ClassicGainEvaluator(std::shared_ptr<const ClassicMap> map, const Sensor& sensor,
                       const ClassicConfig& config, const ExecConfig& exec = {});
  ~ClassicGainEvaluator();
  ClassicGainEvaluator(ClassicGainEvaluator&&) noexcept;
  ClassicGainEvaluator& operator=(ClassicGainEvaluator&&) noexcept;

  /// An evaluator for another map, to follow a growing map. It shares the rays and threads of this
  /// one. Throws like the constructor if the map is invalid.
  [[nodiscard]] ClassicGainEvaluator with_map(std::shared_ptr<const ClassicMap> map) const;

  /// Gains of a batch: results[i * gains + g] for pose i and gain g, in the unit of each gain. The
  /// result is NaN for an invalid pose, and 0 for a camera in an occupied voxel. `statuses` is
  /// empty or has one entry per pose. Returns the number of scored poses. If `control` ended the
  /// call early, the remaining results are NaN with the status bad_pose. Throws
  /// Error(invalid_argument) if the sizes do not match.
  std::size_t evaluate(std::span<const Pose> T_world_camera, std::span<double> results,
                       std::span<ViewGain::Status> statuses = {},
                       const BatchControl& control = {}) const;
  /// As above, in a new array; row i belongs to pose i.
  [[nodiscard]] std::vector<double> evaluate(std::span<const Pose> T_world_camera) const;

  /// The settings.
  [[nodiscard]] const ClassicConfig& config() const noexcept;
  /// The map of the evaluator.
  [[nodiscard]] const ClassicMap& map() const noexcept;
  /// Rays per pose: one per pixel of the strided image.
  [[nodiscard]] std::size_t rays_per_pose() const noexcept;
  /// Number of threads of a batch.
  [[nodiscard]] int num_threads() const noexcept;

 private:
  struct Impl;
  explicit ClassicGainEvaluator(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
