// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/box.hpp"
#include "viewgain/core/camera.hpp"
#include "viewgain/core/criterion.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/grid_snapshot.hpp"
#include "viewgain/raycast/view_measure.hpp"
#include "viewgain/raycast/view_selection.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain {

namespace detail {
struct EvaluatorAccess;
}

/// What a view's gain measures (apps/docs/guide/equations.md).
enum class GainModel : std::uint8_t {
  paper,     ///< the paper's: entropy removed where rays first meet voxels that are not free [nat]
  surface,   ///< expected new surface, where rays continue through unknown voxels [m²]
  combined,  ///< expected new surface in nats, and refinement of known surface [nat]
};
/// Default model everywhere: here, in the planner, and in every program and binding. Of the models
/// it finds the surface with the fewest views.
inline constexpr GainModel kDefaultGain = GainModel::combined;
/// Names of the models, in enumeration order.
[[nodiscard]] VIEWGAIN_EXPORT const std::vector<std::string>& gain_model_names();
/// Name of the model, as parse_gain_model() reads it. Unchecked.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view gain_model_name(GainModel model);
/// Unit of ViewGain::gain: "nat", or "m^2" for the surface gain and the paper's gain with criterion
/// trace.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view gain_unit(
    GainModel model, Criterion criterion = Criterion::log_diagonal) noexcept;
/// Parses a name. Throws Error(invalid_argument) listing the valid names.
[[nodiscard]] VIEWGAIN_EXPORT GainModel parse_gain_model(std::string_view name);

/// Settings that affect the gain.
struct VIEWGAIN_EXPORT GainConfig {
  /// Task weight of a part of the workspace: the paper's "selected parts".
  struct WeightRegion {
    Box box;            ///< grid frame [m]; applies to voxels whose centre lies in it
    double weight = 1;  ///< w_v >= 0; the last region that contains a voxel counts, 1 outside all
  };

  GainModel model = kDefaultGain;  ///< what the gain measures
  /// Criterion of the paper's gain. The refinement of the combined gain always uses log_diagonal;
  /// trace cannot be used with it.
  Criterion criterion = Criterion::log_diagonal;
  int pixel_stride = 1;  ///< traces every s-th pixel of every s-th row, from pixel (0,0)
  std::optional<double> prior_sigma{};  ///< sigma_0 [m]; defaults to the map's
  /// Along the ray [m]; defaults to the sensor's. Nothing nearer gains. Known surface that a ray
  /// enters before it blocks the ray; obstacles block at any range.
  std::optional<double> min_range{};
  std::optional<double> max_range{};    ///< along the ray [m]; defaults to the sensor's
  std::vector<WeightRegion> weights{};  ///< task weights; later ones override earlier ones
  double refinement_weight = 1.0;  ///< combined: weight w of refinement relative to new surface
  /// Paper: also compute ViewGain::posterior_entropy; about 4 % slower.
  bool posterior_entropy = false;
};

/// Expected gain of a view, in nats, or in m² for the criterion trace and the surface gain. Each
/// member names its models; for other models it is NaN, a count 0, and null in JSON.
struct VIEWGAIN_EXPORT ViewGain {
  /// Whether the view could be scored.
  enum class Status : std::uint8_t {
    ok,
    bad_pose,            ///< not finite, or a rotation that deviates by more than 1e-3: gain NaN
    camera_in_occupied,  ///< the camera centre lies in an occupied voxel: gain 0
  };

  /// Depends on GainConfig::model: exploration + refinement; area; or area · ΔH_new / voxel² + w ·
  /// refinement_saturated. NaN for an invalid pose, or for sensor sigmas outside the range of
  /// double precision.
  double gain = std::numeric_limits<double>::quiet_NaN();
  /// Paper: share of unknown voxels.
  double exploration = std::numeric_limits<double>::quiet_NaN();
  /// Paper: share of occupied voxels.
  double refinement = std::numeric_limits<double>::quiet_NaN();
  /// surface, combined: expected new surface, measured perpendicular to the rays [m²].
  double area = std::numeric_limits<double>::quiet_NaN();
  /// combined: entropy removed from points at occupied voxels with readings, each pooled with the
  /// surrounding voxels, with a floor (apps/docs/guide/surface_gain.md) [nat]. Labelled voxels have
  /// none.
  double refinement_saturated = std::numeric_limits<double>::quiet_NaN();
  /// If enabled in GainConfig: eq. (6) of the paper over the touched voxels, Σ_v Σ_k ln[(Λ_v +
  /// ΣΛ_r)⁻¹]_kk, lengths in metres.
  double posterior_entropy = std::numeric_limits<double>::quiet_NaN();
  std::uint32_t rays = 0;             ///< rays of the view
  std::uint32_t hits = 0;             ///< rays that end in a voxel
  std::uint32_t unknown_voxels = 0;   ///< distinct voxels; paper
  std::uint32_t occupied_voxels = 0;  ///< distinct voxels; paper, combined
  Status status = Status::bad_pose;   ///< whether it could be scored
};

/// Name of the status as used in JSON; never throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view view_status_name(ViewGain::Status status);

/// The end of one ray of a view.
struct VIEWGAIN_EXPORT RayHit {
  /// What the ray ends in. A ray that enters known surface before min_range ends there as at an
  /// obstacle.
  enum class Kind : std::uint8_t { none, unknown, occupied, obstacle };
  Kind kind = Kind::none;  ///< kind of end
  Index3 voxel{};          ///< voxel of the end (unknown, occupied)
  /// Max(range of the entry point, min_range) [m].
  double range = std::numeric_limits<double>::infinity();
};

/// Contribution of one voxel to the gain of a view; see GainEvaluator::contributions().
struct VIEWGAIN_EXPORT VoxelContribution {
  Index3 voxel{};                          ///< index in the map
  VoxelState state = VoxelState::unknown;  ///< unknown or occupied
  std::uint32_t rays = 0;  ///< rays that end in it; surface, combined: rays that reach it
  /// Expected number of rays that end in it: `rays` for the paper's gain, otherwise the sum of
  /// their probabilities.
  double expected_rays = 0;
  double gain = 0;  ///< including its task weight, in the gain's unit
};

/// Scores camera poses against a scene by expected information gain (apps/docs/guide/equations.md).
/// A camera more than 1e6 voxels away from the workspace has gain 0.
///
/// Thread safety: all const members may run from many threads at once on one evaluator. Each
/// thread's buffers grow to the largest view and are kept; then no pose allocates. Identical bits
/// for any number of threads.
///
/// Cost of evaluate(): grows with the rays; surface and combined gains cost about 4 times the
/// paper's (perf/README.md). The constructor calls PinholeCamera::ray() per pixel and, for surface
/// and combined gains, computes the hazard (combined: also the known surface) of a scene without
/// it.
/// @code
/// const GainEvaluator evaluator(VoxelScene::build(grid), sensor);
/// const std::vector<ViewGain> gains = evaluator.evaluate(poses);
/// const BestViews best = evaluator.race(poses, 3);
/// @endcode
class VIEWGAIN_EXPORT GainEvaluator {
 public:
  /// Where a view's rays end, to explain its gain. Each ray counts once: the counts after `rays`
  /// add up to it.
  struct RayOutcomes {
    std::uint32_t rays = 0;           ///< rays of the view
    std::uint32_t too_near = 0;       ///< hit known surface or an obstacle before min_range
    std::uint32_t unknown = 0;        ///< reach unknown space: possible new surface
    std::uint32_t known_surface = 0;  ///< end on known surface after free space
    /// End on an obstacle or, except for the paper's gain, on the support plane.
    std::uint32_t obstacle = 0;
    std::uint32_t out_of_range = 0;  ///< stay in known free space up to max_range
    std::uint32_t out_of_map = 0;    ///< leave the workspace, or never enter it
  };

  /// Removes the lens distortion once. With ExecConfig::tracer `embree`, the first evaluator of a
  /// scene builds its BVH, 0.5 ms per 1,000 primitives; throws Error(backend) on failure. Throws
  /// Error(invalid_argument) naming the value for a null scene, an invalid sensor, sigmas below
  /// 1e-8 m or a factor above 1e3 apart, a stride below 1, a prior outside 1e-6..1e3 m, a weight or
  /// range that is negative or not finite, min_range >= max_range, or a weight box inside out.
  GainEvaluator(std::shared_ptr<const VoxelScene> scene, const Sensor& sensor,
                const GainConfig& config = {}, const ExecConfig& exec = {});
  ~GainEvaluator();
  GainEvaluator(GainEvaluator&&) noexcept;
  GainEvaluator& operator=(GainEvaluator&&) noexcept;

  /// An evaluator with the same sensor and configuration for another scene, to follow a growing
  /// map. Shares ray table, threads and buffers; takes microseconds. For surface and combined gains
  /// of a new scene it first computes hazard and pooled information, some milliseconds. Results are
  /// bit-identical to a new evaluator; sigma_0 is the new map's unless configured. Both evaluators
  /// may be used, moved and destroyed concurrently; while one uses the threads, a call of the other
  /// runs on its calling thread. Throws Error(invalid_argument) for a null scene or a prior sigma
  /// outside 1e-6..1e3 m; Error(backend) and Error(capacity) as VoxelScene::build().
  [[nodiscard]] GainEvaluator with_scene(std::shared_ptr<const VoxelScene> scene) const;

  /// Expected gain of one pose. The paper's gain uses all threads of the evaluator, the others the
  /// calling thread. ViewGain::status reports an invalid pose; nothing is thrown.
  [[nodiscard]] ViewGain evaluate(const Pose& T_world_camera) const;

  /// Expected gains of a batch, result i for pose i, on all threads of the evaluator. An invalid
  /// pose affects only its own result. Returns the number of scored poses: fewer than all if
  /// `control` ended the call; the other results have status bad_pose and NaN. Throws
  /// Error(invalid_argument) if the sizes differ.
  std::size_t evaluate(std::span<const Pose> T_world_camera, std::span<ViewGain> results,
                       const BatchControl& control = {}) const;
  /// As above, into a new array.
  [[nodiscard]] std::vector<ViewGain> evaluate(std::span<const Pose> T_world_camera) const;

  /// A custom gain of a batch, result i for pose i in the unit of `measure`, which all threads of
  /// the evaluator call concurrently. Invalid poses get NaN and cameras in an occupied voxel 0
  /// without a call. Returns the number of measured poses, as above; the others are NaN. An
  /// exception of `measure` ends the batch and is rethrown; results are then unspecified. Throws
  /// Error(invalid_argument) if the sizes differ. Cost: 1.4 times evaluate(), plus `measure`.
  std::size_t evaluate(std::span<const Pose> T_world_camera, std::span<double> results,
                       const ViewMeasure& measure, const BatchControl& control = {}) const;

  /// As above for a measure that sees what rays pass in unknown voxels, with any model of the
  /// evaluator. Lists take 80 bytes per thread and voxel that a ray passes, up to 200 MB at full
  /// resolution; a pixel stride reduces them. Also throws Error(capacity) and Error(backend). Cost:
  /// several times evaluate() with the surface gain.
  std::size_t evaluate(std::span<const Pose> T_world_camera, std::span<double> results,
                       const RunMeasure& measure, const BatchControl& control = {}) const;

  /// Explains a gain: one entry per voxel in which rays of the pose end, largest gain first, ties
  /// by the voxel's x, y, z. For surface and combined, one entry per unknown voxel that rays reach.
  /// Gains add up to evaluate()'s to 1e-9 relative (surface, combined: 1e-5), rays to its hits.
  /// Empty for an invalid pose and for a camera in an occupied voxel; does not throw for them. Runs
  /// on the calling thread; takes three times as long as evaluate().
  [[nodiscard]] std::vector<VoxelContribution> contributions(const Pose& T_world_camera) const;

  /// Ends of the rays that evaluate() uses, in pixel order (row-major, strided). Empty for an
  /// invalid pose; does not throw for it. Cost: one trace of the pose.
  [[nodiscard]] std::vector<RayHit> trace(const Pose& T_world_camera) const;

  /// Counts where the rays that evaluate() uses end. A camera in an occupied voxel sees out of it.
  /// All counts are 0 for an invalid pose; does not throw for it. Cost: one trace of the pose and
  /// one PinholeCamera::ray() per ray.
  [[nodiscard]] RayOutcomes outcomes(const Pose& T_world_camera) const;

  /// The k best poses with their results of evaluate(), ties to the lower index. Never chooses
  /// invalid poses or a measure of NaN, and may return fewer. `config` can subtract costs and
  /// replace the gain by a measure. Scores all poses, so it costs as evaluate(). After a stop or
  /// the deadline it returns the best so far, not `complete`. Throws as evaluate() with the
  /// measure, and Error(invalid_argument) for a wrong number of costs, one that is not finite, a
  /// deadline that is not >= 0, or two measures.
  [[nodiscard]] BestViews best(std::span<const Pose> T_world_camera, std::size_t k = 1,
                               const BestConfig& config = {},
                               const BatchControl& control = {}) const;

  /// The k best poses with high probability, in two stages: scores all poses with about 400 rays
  /// each, as approximate() does, then the best max(24, 4 k, 5 %) of them (other gains and
  /// measures: 1.6 %) in full. Reported gains are exact, ties go to the lower index.
  /// perf/results/choosing.md has the probability of a miss: with the paper's gain the best of
  /// 2,000 poses on 3 to 6 of 200 maps. raycast/README.md has the details.
  ///
  /// Images of fewer than 900 rays are scored in full. A measure is scaled to full rays if there
  /// are costs. Deterministic for a seed and any number of threads, unless there is a deadline:
  /// then half of the time goes to estimates of poses from all over the list, and `estimated` and
  /// `scored_indices` report the rest. control.progress counts poses that are eliminated or scored
  /// in full. A stop returns nothing in the first stage and the best so far in the second, not
  /// `complete`. Cost for 2,000 poses with the paper's gain: 0.22 times scoring all. Throws as
  /// best().
  [[nodiscard]] BestViews race(std::span<const Pose> T_world_camera, std::size_t k = 1,
                               const BestConfig& config = {},
                               const BatchControl& control = {}) const;

  /// Up to k different poses of T_world_camera that are good together on the current map, chosen
  /// greedily: each adds most to those before it. raycast/README.md ("Choosing views") defines the
  /// gain of a set. Ties go to the lower index; invalid poses are never chosen; k is clamped. A
  /// stop returns those chosen so far; control.progress counts the chosen poses.
  ///
  /// For surface, combined and log_determinant, poses whose earlier gain cannot win are not scored
  /// again. That is exact for surface and log_determinant, which are submodular; with combined a
  /// refinement can, rarely, grow after another view and be missed. log_diagonal and trace score
  /// all poses in every round. Cost: with the paper's gain up to k batches of about twice
  /// evaluate(); otherwise one batch, and about ten times evaluate() per pose that is scored again
  /// for the first time; up to 256 MB.
  [[nodiscard]] ViewSet best_set(std::span<const Pose> T_world_camera, std::size_t k,
                                 const BatchControl& control = {}) const;

  /// Estimates gains and standard errors from a lattice of each view's rays, the same for all
  /// poses, result i for pose i. Traces every s-th ray of every s-th row, with the smallest s² that
  /// keeps to the share, but at least 100 rays if there are as many. At a share of 1 the result is
  /// the exact gain with standard error 0. raycast/README.md ("Choosing views") describes the
  /// estimator.
  ///
  /// Over maps of objects and of a room, 90 to 97 % of the gains lie within two standard errors; on
  /// one map or lattice 86 % was seen (perf/results/choosing.md). Estimates of poses are
  /// independent of each other and of the number of threads. Invalid poses: NaN. Returns the number
  /// of estimated poses, fewer than all after a stop. Throws Error(invalid_argument) for a share
  /// out of range or if the sizes differ; Error(backend) and Error(capacity) as race().
  std::size_t approximate(std::span<const Pose> T_world_camera, std::span<ApproximateGain> results,
                          const ApproximateConfig& config = {},
                          const BatchControl& control = {}) const;

  /// Rays per pose: one per pixel of the strided image.
  [[nodiscard]] std::size_t rays_per_pose() const noexcept;
  [[nodiscard]] const PinholeCamera& camera() const noexcept;  ///< the sensor's
  /// The model of the gain.
  [[nodiscard]] GainModel model() const noexcept;
  /// The pixel stride s.
  [[nodiscard]] int pixel_stride() const noexcept;
  /// Number of threads of a batch.
  [[nodiscard]] int num_threads() const noexcept;
  [[nodiscard]] double prior_sigma() const noexcept;  ///< [m]
  /// The scene of the evaluator.
  [[nodiscard]] const VoxelScene& scene() const noexcept;

 private:
  struct Impl;
  friend struct detail::EvaluatorAccess;
  explicit GainEvaluator(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Indices of the k best results, one per pose: larger gain first, ties to the lower index, NaN
/// last. k is clamped; never throws. Cost: O(n log n).
[[nodiscard]] VIEWGAIN_EXPORT std::vector<std::size_t> best_indices(
    std::span<const ViewGain> results, std::size_t k);

/// Depths along the optical axis [m] at which the rays of evaluate() end, row-major, to look at the
/// origin of a gain: every s-th pixel of every s-th row for a pixel stride s;
/// DepthFrame::kOutOfRange where a ray hits nothing. `labels`, if given, receives what each ray
/// hits. A camera in an occupied voxel sees out of it. Thread safe. Throws Error(invalid_argument)
/// for a pose that is not finite or not rigid within 1e-3. Cost: one trace of the pose and, with
/// distortion, its removal per pixel.
[[nodiscard]] VIEWGAIN_EXPORT DepthFrame depth_image(const GainEvaluator& evaluator,
                                                     const Pose& T_world_camera,
                                                     std::vector<RayHit::Kind>* labels = nullptr);

}  // namespace viewgain
