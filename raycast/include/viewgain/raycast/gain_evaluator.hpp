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

/// What the gain of a view measures (apps/docs/guide/equations.md). A view is a camera at a pose.
enum class GainModel : std::uint8_t {
  paper,     ///< Foix et al. (2012): entropy removed where rays meet the first non-free voxel [nat]
  surface,   ///< expected new surface; rays continue through unknown voxels [m²]
  combined,  ///< expected new surface, converted to nats, plus refinement of known surface [nat]
};
/// Default model everywhere. Of the three models, it needs the fewest views to find the surface.
inline constexpr GainModel kDefaultGain = GainModel::combined;
/// Names of the models, in enumeration order.
[[nodiscard]] VIEWGAIN_EXPORT const std::vector<std::string>& gain_model_names();
/// Name of the model, as parse_gain_model() reads it. The argument is not checked.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view gain_model_name(GainModel model);
/// Unit of ViewGain::gain: "m^2" for the surface gain, and for the paper's gain with
/// Criterion::trace; otherwise "nat".
[[nodiscard]] VIEWGAIN_EXPORT std::string_view gain_unit(
    GainModel model, Criterion criterion = Criterion::log_diagonal) noexcept;
/// The model of this name. Throws Error(invalid_argument) listing the valid names.
[[nodiscard]] VIEWGAIN_EXPORT GainModel parse_gain_model(std::string_view name);

/// Settings that affect gains.
struct VIEWGAIN_EXPORT GainConfig {
  /// A part of the workspace and its task weight ("selected parts" in Foix et al. 2012).
  struct WeightRegion {
    Box box;            ///< applies to voxels whose centre lies in it; grid frame [m]
    double weight = 1;  ///< w_v >= 0; factor of the gain of its voxels
  };

  GainModel model = kDefaultGain;  ///< what gains measure
  /// Measure of entropy in the paper's gain. The combined gain always uses log_diagonal, and
  /// requires that this is not trace.
  Criterion criterion = Criterion::log_diagonal;
  int pixel_stride = 1;  ///< s: traces every s-th pixel of every s-th row, from pixel (0,0)
  std::optional<double> prior_sigma{};  ///< sigma_0 [m]; unset: the map's
  /// Minimum range along the ray [m]; unset: the sensor's. Voxels nearer than this have no gain,
  /// but known surface and obstacles there block the ray.
  std::optional<double> min_range{};
  std::optional<double> max_range{};  ///< along the ray [m]; unset: the sensor's
  /// Task weights. Where regions overlap, the last one counts. Outside all regions the weight is 1.
  std::vector<WeightRegion> weights{};
  double refinement_weight = 1.0;  ///< combined gain: w, the weight of refinement
  /// Paper's gain: whether to compute ViewGain::posterior_entropy, which takes about 4 % longer.
  bool posterior_entropy = false;
};

/// Expected gain of a view, in the unit gain_unit(). If the comment of a member begins with names
/// of gain models, it is only computed for these models. For other models it is NaN (null in JSON),
/// and counts are 0.
struct VIEWGAIN_EXPORT ViewGain {
  /// Whether the view could be scored.
  enum class Status : std::uint8_t {
    ok,
    bad_pose,            ///< the pose is not finite, or not rigid within 1e-3: gain NaN
    camera_in_occupied,  ///< the camera centre lies in an occupied voxel: gain 0
  };

  /// paper: exploration + refinement. surface: area. combined: area · ΔH_new / voxel_size² + w ·
  /// refinement_saturated. w is GainConfig::refinement_weight, and ΔH_new is the entropy that a new
  /// surface point loses (apps/docs/guide/surface_gain.md). NaN for an invalid pose, or if sensor
  /// sigmas exceed double precision.
  double gain = std::numeric_limits<double>::quiet_NaN();
  /// paper: gain from unknown voxels.
  double exploration = std::numeric_limits<double>::quiet_NaN();
  /// paper: gain from occupied voxels.
  double refinement = std::numeric_limits<double>::quiet_NaN();
  /// surface, combined: expected new surface, measured perpendicular to the rays [m²].
  double area = std::numeric_limits<double>::quiet_NaN();
  /// combined: entropy removed from known surface [nat] (apps/docs/guide/surface_gain.md). Voxels
  /// without a Belief, such as labelled ones, add nothing.
  double refinement_saturated = std::numeric_limits<double>::quiet_NaN();
  /// paper, if enabled in GainConfig: eq. (6) of Foix et al. (2012), Σ_v Σ_k ln[(Λ_v + Σ_r
  /// Λ_r)⁻¹]_kk. The sums run over the voxels v in which rays end, the rays r that end in v, and
  /// the three axes k. Lengths are in metres.
  double posterior_entropy = std::numeric_limits<double>::quiet_NaN();
  std::uint32_t rays = 0;             ///< number of rays of the view
  std::uint32_t hits = 0;             ///< number of rays that end in an unknown or occupied voxel
  std::uint32_t unknown_voxels = 0;   ///< paper: number of unknown voxels in which rays end
  std::uint32_t occupied_voxels = 0;  ///< paper, combined: the same for occupied voxels
  Status status = Status::bad_pose;   ///< whether the view could be scored
};

/// Name of the status, as used in JSON. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view view_status_name(ViewGain::Status status);

/// The end of one ray of a view.
struct VIEWGAIN_EXPORT RayHit {
  /// What the ray ends in. Known surface nearer than min_range counts as an obstacle.
  enum class Kind : std::uint8_t { none, unknown, occupied, obstacle };
  Kind kind = Kind::none;  ///< what the ray ends in
  Index3 voxel{};          ///< the voxel, if kind is unknown or occupied
  /// Range at which the ray enters the voxel or obstacle, at least min_range [m].
  double range = std::numeric_limits<double>::infinity();
};

/// Contribution of one voxel to the gain of a view; see GainEvaluator::contributions().
struct VIEWGAIN_EXPORT VoxelContribution {
  Index3 voxel{};                          ///< the voxel
  VoxelState state = VoxelState::unknown;  ///< unknown or occupied
  /// Number of rays that end in the voxel. surface, combined: number of rays that reach it.
  std::uint32_t rays = 0;
  /// Expected number of rays that end in it. paper: `rays`. surface, combined: the sum of the
  /// probabilities of the rays.
  double expected_rays = 0;
  double gain = 0;  ///< its contribution, with its task weight, in the gain's unit
};

/// Scores camera poses in a scene by expected information gain (apps/docs/guide/equations.md). A
/// camera more than 1e6 voxels away from the workspace has gain 0.
///
/// Thread safety: const members may run from many threads at once. Results are bit-identical for
/// any number of threads. Buffers are kept, so later calls allocate no memory.
///
/// Cost of evaluate(): linear in the number of rays. Surface and combined gains cost about 4 times
/// as much as the paper's (perf/README.md). The constructor calls PinholeCamera::ray() per pixel.
/// For surface and combined gains, it computes VoxelScene::hazard() if the scene does not have it
/// yet.
/// @code
/// const GainEvaluator evaluator(VoxelScene::build(grid), sensor);
/// const std::vector<ViewGain> gains = evaluator.evaluate(poses);
/// const BestViews best = evaluator.race(poses, 3);
/// @endcode
class VIEWGAIN_EXPORT GainEvaluator {
 public:
  /// Where the rays of a view end, to explain its gain. Each member is a number of rays. Each ray
  /// counts in exactly one other member besides `rays`, so the others add up to `rays`.
  struct RayOutcomes {
    std::uint32_t rays = 0;           ///< number of rays of the view
    std::uint32_t too_near = 0;       ///< end on known surface or an obstacle nearer than min_range
    std::uint32_t unknown = 0;        ///< reach unknown space, where they may show new surface
    std::uint32_t known_surface = 0;  ///< end on known surface after free space
    /// End on an obstacle or, except for the paper's gain, on the support plane.
    std::uint32_t obstacle = 0;
    std::uint32_t out_of_range = 0;  ///< stay in known free space up to max_range
    std::uint32_t out_of_map = 0;    ///< leave the workspace, or never enter it
  };

  /// Throws Error(invalid_argument), naming the value, for a null scene or an invalid sensor or
  /// setting. The sensor's sigmas must be at least 1e-8 m, and within a factor of 1e3 of each
  /// other. prior_sigma must be in 1e-6..1e3 m. With ExecConfig::Tracer::embree, the first
  /// evaluator of a scene builds the BVH (0.5 ms per 1,000 leaves and tiles), and throws
  /// Error(backend) if Embree fails.
  GainEvaluator(std::shared_ptr<const VoxelScene> scene, const Sensor& sensor,
                const GainConfig& config = {}, const ExecConfig& exec = {});
  ~GainEvaluator();
  GainEvaluator(GainEvaluator&&) noexcept;
  GainEvaluator& operator=(GainEvaluator&&) noexcept;

  /// An evaluator with the same sensor and settings for another scene, for example of a growing
  /// map. It shares rays, threads and buffers with this one. Both may be used, moved and destroyed
  /// concurrently; while one uses the threads, calls of the other run on their calling threads.
  /// Results are those of a new evaluator. Throws whatever the constructor and VoxelScene::build()
  /// throw. Cost: microseconds, or some milliseconds if the scene's hazard must be computed.
  [[nodiscard]] GainEvaluator with_scene(std::shared_ptr<const VoxelScene> scene) const;

  /// Expected gain of one pose. Uses all threads of the evaluator, except for surface and combined
  /// gains with task weights. Does not throw for an invalid pose; ViewGain::status reports it.
  [[nodiscard]] ViewGain evaluate(const Pose& T_world_camera) const;

  /// Expected gains of a batch of poses, on all threads of the evaluator; result i is that of pose
  /// i. An invalid pose affects only its own result. Returns the number of scored poses. If
  /// `control` stops the call, this is less than all, and the remaining results have the status
  /// bad_pose. Throws Error(invalid_argument) if the sizes differ.
  std::size_t evaluate(std::span<const Pose> T_world_camera, std::span<ViewGain> results,
                       const BatchControl& control = {}) const;
  /// As above, into a new array.
  [[nodiscard]] std::vector<ViewGain> evaluate(std::span<const Pose> T_world_camera) const;

  /// As above with a custom gain, in its unit. All threads call `measure` concurrently. For invalid
  /// poses the result is NaN, and for cameras in an occupied voxel 0, without a call of `measure`.
  /// An exception of `measure` ends the batch and is rethrown; the results are then unspecified.
  /// After a stop, the remaining results are NaN. Cost: 1.4 times evaluate(), plus `measure`.
  std::size_t evaluate(std::span<const Pose> T_world_camera, std::span<double> results,
                       const ViewMeasure& measure, const BatchControl& control = {}) const;

  /// As above, for a custom gain that sees all unknown voxels that rays pass, whatever the
  /// evaluator's model. Also throws Error(capacity) and Error(backend). Cost: several times that of
  /// the surface gain, and 80 bytes per thread for each voxel that a ray passes, up to 200 MB at
  /// full resolution. A pixel stride reduces the memory.
  std::size_t evaluate(std::span<const Pose> T_world_camera, std::span<double> results,
                       const RunMeasure& measure, const BatchControl& control = {}) const;

  /// Explains a gain by the contribution of each voxel in which rays end. Surface and combined
  /// gains also have contributions of all unknown voxels that rays reach. Largest gain first, ties
  /// ordered by x, y, z. The sum of the contributions is the gain of evaluate(), up to a relative
  /// error of 1e-9 (surface, combined: 1e-5). Empty for an invalid pose and for a camera in an
  /// occupied voxel. Runs on the calling thread. Cost: three times evaluate().
  [[nodiscard]] std::vector<VoxelContribution> contributions(const Pose& T_world_camera) const;

  /// Where each ray of evaluate() ends, in row-major order of the traced pixels. Empty for an
  /// invalid pose. Cost: tracing the rays once.
  [[nodiscard]] std::vector<RayHit> trace(const Pose& T_world_camera) const;

  /// Counts where the rays of evaluate() end. If the camera is in an occupied voxel, this voxel
  /// does not block its rays. All counts are 0 for an invalid pose. Cost: tracing the rays once,
  /// and one PinholeCamera::ray() per ray.
  [[nodiscard]] RayOutcomes outcomes(const Pose& T_world_camera) const;

  /// The k best poses, with their results of evaluate(). Fewer if not enough poses are valid. If
  /// gains are equal, the lower index comes first. `config` can subtract costs, and replace the
  /// gain by a custom one. After a stop or the deadline, returns the best so far, with `complete`
  /// false. Throws Error(invalid_argument) if `config` is invalid, and whatever evaluate() throws.
  /// Cost: evaluate() for all poses.
  [[nodiscard]] BestViews best(std::span<const Pose> T_world_camera, std::size_t k = 1,
                               const BestConfig& config = {},
                               const BatchControl& control = {}) const;

  /// As best(), but faster: finds the k best poses with high probability
  /// (perf/results/choosing.md), in two stages. The first estimates the gains of all poses with
  /// about 400 rays each, as approximate() does. The second scores the best of them with all their
  /// rays: at least 24 poses, at least 4 times k poses, and at least 1.6 % of all poses (5 % with
  /// the paper's gain). Returned gains are exact. Poses with fewer than 900 rays skip the first
  /// stage.
  ///
  /// Without a deadline, results only depend on the seed. With a deadline, BestViews::estimated and
  /// scored_indices tell how much each stage did. control.progress counts poses that are eliminated
  /// or scored with all rays. A stop in the first stage gives an empty result, and in the second
  /// stage the best so far; `complete` is then false. Throws whatever best() throws.
  [[nodiscard]] BestViews race(std::span<const Pose> T_world_camera, std::size_t k = 1,
                               const BestConfig& config = {},
                               const BatchControl& control = {}) const;

  /// A set of up to k poses with a large gain together. raycast/README.md ("Choosing views")
  /// defines the gain of a set. Poses are chosen greedily: each has the largest marginal gain,
  /// which is the increase of the set's gain. If gains are equal, the lower index is chosen.
  /// Invalid poses are never chosen. control.progress counts the chosen poses; a stop returns them.
  ///
  /// A pose is not scored again for a choice if its earlier marginal gain shows that it cannot be
  /// the best. This is exact for the surface gain, and for the paper's gain with log_determinant,
  /// because these gains are submodular. With the combined gain, the best pose can rarely be
  /// missed. With log_diagonal and trace, all poses are scored for each choice. Cost with the
  /// paper's gain: up to k batches, each about twice evaluate(). Cost otherwise: one batch, and
  /// about ten times evaluate() the first time that a pose is scored again. Memory: up to 256 MB.
  [[nodiscard]] ViewSet best_set(std::span<const Pose> T_world_camera, std::size_t k,
                                 const BatchControl& control = {}) const;

  /// Estimates gains and their standard errors from some rays of each view; result i is that of
  /// pose i. Traces a regular lattice of pixels: at most the fraction `share` of the rays, but at
  /// least 100 rays, or all if there are fewer. With a share of 1, results are exact and standard
  /// errors 0. raycast/README.md ("Choosing views") describes the estimator,
  /// perf/results/choosing.md its accuracy.
  ///
  /// The estimate of a pose does not depend on the other poses or on the number of threads. It is
  /// NaN for an invalid pose. Returns the number of estimated poses, which is less than all after a
  /// stop. Throws Error(invalid_argument) if share is out of range or the sizes differ. Also throws
  /// Error(backend) and Error(capacity).
  std::size_t approximate(std::span<const Pose> T_world_camera, std::span<ApproximateGain> results,
                          const ApproximateConfig& config = {},
                          const BatchControl& control = {}) const;

  /// Number of rays per pose: one for every s-th pixel of every s-th row.
  [[nodiscard]] std::size_t rays_per_pose() const noexcept;
  [[nodiscard]] const PinholeCamera& camera() const noexcept;  ///< the sensor's
  /// The model of the gain.
  [[nodiscard]] GainModel model() const noexcept;
  /// GainConfig::pixel_stride.
  [[nodiscard]] int pixel_stride() const noexcept;
  /// Number of threads for batches.
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

/// Indices of the k best results, or of all if there are fewer. Larger gains come first and NaN
/// last; if gains are equal, the lower index comes first. Never throws. Cost: O(n log n).
[[nodiscard]] VIEWGAIN_EXPORT std::vector<std::size_t> best_indices(
    std::span<const ViewGain> results, std::size_t k);

/// Depth image of the points at which the rays of evaluate() end, to show where a gain comes from.
/// With a pixel stride s, the image has every s-th pixel of every s-th row. Pixels whose ray ends
/// nowhere have DepthFrame::kOutOfRange. `labels`, if not null, receives what each ray ends in.
/// Thread safe. Throws Error(invalid_argument) if the pose is not rigid within 1e-3. Cost: tracing
/// the rays once, and with distortion one PinholeCamera::ray() per pixel.
[[nodiscard]] VIEWGAIN_EXPORT DepthFrame depth_image(const GainEvaluator& evaluator,
                                                     const Pose& T_world_camera,
                                                     std::vector<RayHit::Kind>* labels = nullptr);

}  // namespace viewgain
