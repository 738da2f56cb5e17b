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
  paper,     ///< Foix et al. (2012): entropy removed in each ray's first non-free voxel [nat]
  surface,   ///< expected new surface, where rays continue through unknown voxels [m²]
  combined,  ///< expected new surface in nats, and refinement of known surface [nat]
};
/// Default model of the library, the planner, the program and all bindings. Of the three models, it
/// needs the fewest views to find the surface.
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
  /// Task weight of a part of the workspace ("selected parts" in Foix et al. 2012).
  struct WeightRegion {
    Box box;            ///< grid frame [m]; applies to voxels whose centre lies in it
    double weight = 1;  ///< w_v >= 0; the last region with the voxel counts; 1 outside all regions
  };

  GainModel model = kDefaultGain;  ///< what the gain measures
  /// Criterion of the paper's gain. The refinement of the combined gain always uses log_diagonal;
  /// trace cannot be used with it.
  Criterion criterion = Criterion::log_diagonal;
  int pixel_stride = 1;  ///< traces every s-th pixel of every s-th row, from pixel (0,0)
  std::optional<double> prior_sigma{};  ///< sigma_0 [m]; defaults to the map's
  /// Minimum range along the ray [m]; defaults to the sensor's. Voxels nearer than this have no
  /// gain. Known surface and obstacles nearer than this block the ray.
  std::optional<double> min_range{};
  std::optional<double> max_range{};  ///< along the ray [m]; defaults to the sensor's
  /// Task weights; where regions overlap, the last one counts.
  std::vector<WeightRegion> weights{};
  double refinement_weight = 1.0;  ///< combined gain: weight w of refinement
  /// Paper's gain: also computes ViewGain::posterior_entropy; about 4 % slower.
  bool posterior_entropy = false;
};

/// Expected gain of a view, in nats, or in m² for the criterion trace and the surface gain. Some
/// members exist only for the gain models that their comments name. For other models they are NaN
/// (null in JSON), and counts are 0.
struct VIEWGAIN_EXPORT ViewGain {
  /// Whether the view could be scored.
  enum class Status : std::uint8_t {
    ok,
    bad_pose,            ///< not finite, or a rotation that deviates by more than 1e-3: gain NaN
    camera_in_occupied,  ///< the camera centre lies in an occupied voxel: gain 0
  };

  /// paper: exploration + refinement. surface: area. combined: area · ΔH_new / voxel_size² + w ·
  /// refinement_saturated, where w is GainConfig::refinement_weight and ΔH_new the entropy that a
  /// new surface point loses (apps/docs/guide/surface_gain.md). NaN for an invalid pose, or for
  /// sensor sigmas outside the range of double precision.
  double gain = std::numeric_limits<double>::quiet_NaN();
  /// paper: the part of the gain from unknown voxels.
  double exploration = std::numeric_limits<double>::quiet_NaN();
  /// paper: the part of the gain from occupied voxels.
  double refinement = std::numeric_limits<double>::quiet_NaN();
  /// surface, combined: expected new surface, measured perpendicular to the rays [m²].
  double area = std::numeric_limits<double>::quiet_NaN();
  /// combined: entropy removed from known surface [nat] (apps/docs/guide/surface_gain.md). Voxels
  /// without measured depths, such as labelled ones, add nothing.
  double refinement_saturated = std::numeric_limits<double>::quiet_NaN();
  /// paper, if enabled in GainConfig: eq. (6) of Foix et al. (2012), Σ_v Σ_k ln[(Λ_v + Σ_r
  /// Λ_r)⁻¹]_kk. v are the voxels that the rays hit, r the rays that end in v, and k the three
  /// axes. Lengths are in metres.
  double posterior_entropy = std::numeric_limits<double>::quiet_NaN();
  std::uint32_t rays = 0;             ///< rays of the view
  std::uint32_t hits = 0;             ///< rays that end in a voxel
  std::uint32_t unknown_voxels = 0;   ///< number of distinct voxels hit; paper
  std::uint32_t occupied_voxels = 0;  ///< number of distinct voxels hit; paper, combined
  Status status = Status::bad_pose;   ///< whether it could be scored
};

/// Name of the status as used in JSON; never throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view view_status_name(ViewGain::Status status);

/// The end of one ray of a view.
struct VIEWGAIN_EXPORT RayHit {
  /// What the ray ends in. Known surface that the ray enters at a range below min_range
  /// counts as an obstacle.
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
  std::uint32_t rays = 0;  ///< rays that end in the voxel; surface, combined: rays that reach it
  /// Expected number of rays that end in the voxel: `rays` for the paper's gain, otherwise the sum
  /// of the rays' probabilities.
  double expected_rays = 0;
  double gain = 0;  ///< including its task weight, in the gain's unit
};

/// Scores camera poses against a scene by expected information gain (apps/docs/guide/equations.md).
/// A camera more than 1e6 voxels away from the workspace has gain 0.
///
/// Thread safety: all const members may run from many threads at once on one evaluator. Results are
/// bit-identical for any number of threads. Each thread keeps its buffers, which grow to the
/// largest view; later poses then allocate no memory.
///
/// Cost of evaluate(): grows with the number of rays; surface and combined gains cost about 4 times
/// the paper's (perf/README.md). The constructor calls PinholeCamera::ray() per pixel. For surface
/// and combined gains it also computes the scene's hazard, unless the scene already has it.
/// @code
/// const GainEvaluator evaluator(VoxelScene::build(grid), sensor);
/// const std::vector<ViewGain> gains = evaluator.evaluate(poses);
/// const BestViews best = evaluator.race(poses, 3);
/// @endcode
class VIEWGAIN_EXPORT GainEvaluator {
 public:
  /// Where a view's rays end, to explain its gain. Each ray counts once, so the counts after `rays`
  /// add up to `rays`.
  struct RayOutcomes {
    std::uint32_t rays = 0;           ///< rays of the view
    std::uint32_t too_near = 0;       ///< hit known surface or an obstacle nearer than min_range
    std::uint32_t unknown = 0;        ///< reach unknown space: possible new surface
    std::uint32_t known_surface = 0;  ///< end on known surface after free space
    /// End on an obstacle or, except for the paper's gain, on the support plane.
    std::uint32_t obstacle = 0;
    std::uint32_t out_of_range = 0;  ///< stay in known free space up to max_range
    std::uint32_t out_of_map = 0;    ///< leave the workspace, or never enter it
  };

  /// Removes the lens distortion once. With ExecConfig::tracer `embree`, the first evaluator of a
  /// scene builds its BVH (0.5 ms per 1,000 primitives) and throws Error(backend) on failure.
  /// Throws Error(invalid_argument) naming the value for a null scene or an invalid sensor or
  /// setting. The sensor's standard deviations must be at least 1e-8 m and within a factor of 1e3
  /// of each other. A prior must be within 1e-6..1e3 m.
  GainEvaluator(std::shared_ptr<const VoxelScene> scene, const Sensor& sensor,
                const GainConfig& config = {}, const ExecConfig& exec = {});
  ~GainEvaluator();
  GainEvaluator(GainEvaluator&&) noexcept;
  GainEvaluator& operator=(GainEvaluator&&) noexcept;

  /// An evaluator with the same sensor and configuration for another scene, to follow a growing
  /// map. The new evaluator shares rays, threads and buffers with this one. The call takes
  /// microseconds, or some milliseconds if the scene's hazard must be computed first. Results are
  /// bit-identical to those of a new evaluator. Both evaluators may be used, moved and destroyed
  /// concurrently; while one uses the threads, a call of the other runs on its calling thread.
  /// Throws like the constructor and VoxelScene::build().
  [[nodiscard]] GainEvaluator with_scene(std::shared_ptr<const VoxelScene> scene) const;

  /// Expected gain of one pose, on all threads of the evaluator; with task weights, `surface` and
  /// `combined` use the calling thread alone. ViewGain::status reports an invalid pose; nothing is
  /// thrown.
  [[nodiscard]] ViewGain evaluate(const Pose& T_world_camera) const;

  /// Expected gains of a batch, result i for pose i, on all threads of the evaluator. An invalid
  /// pose affects only its own result. Returns the number of scored poses, which is less than all
  /// if `control` ended the call. The remaining results have status bad_pose and NaN. Throws
  /// Error(invalid_argument) if the sizes differ.
  std::size_t evaluate(std::span<const Pose> T_world_camera, std::span<ViewGain> results,
                       const BatchControl& control = {}) const;
  /// As above, into a new array.
  [[nodiscard]] std::vector<ViewGain> evaluate(std::span<const Pose> T_world_camera) const;

  /// A custom gain of a batch, result i for pose i, in the unit of `measure`. All threads of the
  /// evaluator call `measure` concurrently. Invalid poses get NaN, and cameras in an occupied voxel
  /// get 0, without a call. Returns the number of measured poses, as above; the remaining results
  /// are NaN. An exception of `measure` ends the batch and is rethrown; results are then
  /// unspecified. Throws Error(invalid_argument) if the sizes differ. Cost: 1.4 times evaluate(),
  /// plus `measure`.
  std::size_t evaluate(std::span<const Pose> T_world_camera, std::span<double> results,
                       const ViewMeasure& measure, const BatchControl& control = {}) const;

  /// As above for a measure that sees all unknown voxels that rays pass, whatever the evaluator's
  /// model. Each thread needs 80 bytes per voxel that a ray passes, up to 200 MB at full
  /// resolution. A pixel stride reduces the memory. Also throws Error(capacity) and Error(backend).
  /// Cost: several times evaluate() with the surface gain.
  std::size_t evaluate(std::span<const Pose> T_world_camera, std::span<double> results,
                       const RunMeasure& measure, const BatchControl& control = {}) const;

  /// Explains a gain: one entry per voxel in which rays of the pose end, largest gain first, ties
  /// by the voxel's x, y, z. For surface and combined: one entry per unknown voxel that rays reach.
  /// The sum of the gains equals the gain of evaluate(), up to a relative error of 1e-9 (surface,
  /// combined: 1e-5). Empty, without an exception, for an invalid pose and for a camera in an
  /// occupied voxel. Runs on the calling thread; takes three times as long as evaluate().
  [[nodiscard]] std::vector<VoxelContribution> contributions(const Pose& T_world_camera) const;

  /// Ends of the rays that evaluate() uses, in pixel order (row-major, strided). Empty for an
  /// invalid pose; does not throw for it. Cost: one trace of the pose.
  [[nodiscard]] std::vector<RayHit> trace(const Pose& T_world_camera) const;

  /// Counts where the rays that evaluate() uses end. If the camera is in an occupied voxel, that
  /// voxel does not block its rays. All counts are 0 for an invalid pose; does not throw for it.
  /// Cost: one trace of the pose and one PinholeCamera::ray() per ray.
  [[nodiscard]] RayOutcomes outcomes(const Pose& T_world_camera) const;

  /// The k best poses with their results of evaluate(), ties to the lower index. Returns fewer if
  /// not enough poses are valid. `config` can subtract costs and replace the gain by a measure.
  /// Scores all poses, so it costs the same as evaluate(). After a stop or the deadline it returns
  /// the best so far, and `complete` is false. Throws Error(invalid_argument) for an invalid
  /// `config`. Also throws whatever evaluate() throws.
  [[nodiscard]] BestViews best(std::span<const Pose> T_world_camera, std::size_t k = 1,
                               const BestConfig& config = {},
                               const BatchControl& control = {}) const;

  /// The k best poses with high probability, in two stages. The first scores all poses with about
  /// 400 rays each, like approximate(). The second scores the best of them in full: at least 24
  /// poses, at least 4 k, and at least 1.6 % of all poses (5 % with the paper's gain). Reported
  /// gains are exact; ties go to the lower index. perf/results/choosing.md has the probability that
  /// the best pose is missed.
  ///
  /// Images of fewer than 900 rays are scored in full. Without a deadline, results are
  /// deterministic for a seed and any number of threads. With a deadline, `estimated` and
  /// `scored_indices` report how far each stage came. control.progress counts poses that are
  /// eliminated or scored in full. After a stop, `complete` is false. If the call was stopped in
  /// the first stage, the result is empty; in the second stage, it is the best so far. Throws like
  /// best().
  [[nodiscard]] BestViews race(std::span<const Pose> T_world_camera, std::size_t k = 1,
                               const BestConfig& config = {},
                               const BatchControl& control = {}) const;

  /// Up to k different poses of T_world_camera with a large gain together, chosen greedily: each
  /// pose has the largest marginal gain given the earlier ones. raycast/README.md ("Choosing
  /// views") defines the gain of a set. Ties go to the lower index; invalid poses are never chosen;
  /// k is clamped. A stop returns the poses chosen so far; control.progress counts them.
  ///
  /// In later rounds, a pose is skipped if its gain in an earlier round shows that it cannot win.
  /// This is exact for surface and log_determinant, which are submodular. With combined, the best
  /// pose can, rarely, be missed. With log_diagonal and trace, no pose is skipped. Cost with the
  /// paper's gain: up to k batches, each about twice evaluate(). Cost otherwise: one batch, and
  /// about ten times evaluate() when a pose is scored again for the first time. Memory: up to 256
  /// MB.
  [[nodiscard]] ViewSet best_set(std::span<const Pose> T_world_camera, std::size_t k,
                                 const BatchControl& control = {}) const;

  /// Estimates gains and standard errors from some of each view's rays, result i for pose i. Traces
  /// a regular lattice of pixels: at most `share` of the rays, but at least 100 rays, or all if
  /// there are fewer. At a share of 1 the result is the exact gain with standard error 0.
  /// raycast/README.md ("Choosing views") describes the estimator, perf/results/choosing.md its
  /// accuracy.
  ///
  /// The estimate of a pose does not depend on other poses or on the number of threads. Invalid
  /// poses: NaN. Returns the number of estimated poses, which is less than all after a stop. Throws
  /// Error(invalid_argument) for a share out of range or if the sizes differ; Error(backend) and
  /// Error(capacity) like race().
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

/// Depths along the optical axis [m] at which the rays of evaluate() end, row-major, to show where
/// a gain comes from. With a pixel stride s, the image has every s-th pixel of every s-th row.
/// Pixels whose ray hits nothing have DepthFrame::kOutOfRange. `labels`, if given, receives what
/// each ray hits. Thread safe. Throws Error(invalid_argument) for a pose that is not finite or not
/// rigid within 1e-3. Cost: one trace of the pose and, with distortion, its removal per pixel.
[[nodiscard]] VIEWGAIN_EXPORT DepthFrame depth_image(const GainEvaluator& evaluator,
                                                     const Pose& T_world_camera,
                                                     std::vector<RayHit::Kind>* labels = nullptr);

}  // namespace viewgain
