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

/// What a view's gain counts (apps/docs/guide/equations.md).
enum class GainModel : std::uint8_t {
  paper,     ///< the paper's: entropy removed where rays first meet what is not free [nat]
  surface,   ///< new surface to be expected, where rays go on through unknown voxels [m²]
  combined,  ///< that in nats, and what refining known surface brings [nat]
};
/// What views are ranked by unless another model is named, here, in the planner, in every program
/// and binding: of the models it finds the surface in the fewest views.
inline constexpr GainModel kDefaultGain = GainModel::combined;
/// Names of the models, in their order.
[[nodiscard]] VIEWGAIN_EXPORT const std::vector<std::string>& gain_model_names();
/// The model's name, as parse_gain_model() reads it. It must be one of them: unchecked.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view gain_model_name(GainModel model);
/// Unit of ViewGain::gain: "nat", or "m^2" of the surface gain and of the paper's by the trace.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view gain_unit(
    GainModel model, Criterion criterion = Criterion::log_diagonal) noexcept;
/// Throws Error(invalid_argument) that lists the valid names.
[[nodiscard]] VIEWGAIN_EXPORT GainModel parse_gain_model(std::string_view name);

/// What changes the answer.
struct VIEWGAIN_EXPORT GainConfig {
  /// A task weight for a part of the workspace: the paper's "selected parts".
  struct WeightRegion {
    Box box;            ///< grid frame [m]; a voxel belongs to it if its centre does
    double weight = 1;  ///< w_v >= 0; the last region that holds a voxel counts, 1 outside all
  };

  GainModel model = kDefaultGain;  ///< what is counted
  /// Of the paper's gain. The combined gain's refinement is by log_diagonal whatever it says, but
  /// not trace.
  Criterion criterion = Criterion::log_diagonal;
  int pixel_stride = 1;                 ///< every s-th pixel of every s-th row, from pixel (0,0)
  std::optional<double> prior_sigma{};  ///< sigma_0 [m]; the map's unless given
  /// Along the ray [m]; the sensor's unless given. Nothing nearer gains, but known surface that a
  /// ray enters before it blocks the ray, as an obstacle does at any range.
  std::optional<double> min_range{};
  std::optional<double> max_range{};    ///< along the ray [m]; the sensor's unless given
  std::vector<WeightRegion> weights{};  ///< task weights; in their order later ones count
  double refinement_weight = 1.0;       ///< combined: w, of refining against finding new surface
  bool posterior_entropy = false;       ///< paper: ViewGain::posterior_entropy too; some 4 % slower
};

/// What a view is expected to bring. Gains in nats, in m² for the criterion trace and for the
/// surface gain. Each part says which models have it; of the others it is NaN, a count 0, and null
/// in JSON.
struct VIEWGAIN_EXPORT ViewGain {
  /// Whether a view could be scored.
  enum class Status : std::uint8_t {
    ok,
    bad_pose,  ///< a number that is not finite, or a rotation off by more than 1e-3: gain NaN
    camera_in_occupied,  ///< the camera's centre lies in an occupied voxel: gain 0
  };

  /// By GainConfig::model: exploration + refinement; area; or area · ΔH_new / voxel² + w ·
  /// refinement_saturated. NaN: a bad pose, or sensor sigmas beyond what double precision can
  /// weigh.
  double gain = std::numeric_limits<double>::quiet_NaN();
  double exploration = std::numeric_limits<double>::quiet_NaN();  ///< paper: unknown voxels' share
  double refinement = std::numeric_limits<double>::quiet_NaN();   ///< paper: occupied voxels' share
  /// surface, combined: new surface to be expected, measured across the rays [m²].
  double area = std::numeric_limits<double>::quiet_NaN();
  /// combined: entropy removed from the points at occupied voxels that have readings, each pooling
  /// those of the voxels around, with a floor (apps/docs/guide/surface_gain.md) [nat]. Labelled
  /// voxels have none.
  double refinement_saturated = std::numeric_limits<double>::quiet_NaN();
  /// If GainConfig asks for it: the paper's eq. (6) over the touched voxels, Σ_v Σ_k ln[(Λ_v +
  /// ΣΛ_r)⁻¹]_kk, lengths in metres.
  double posterior_entropy = std::numeric_limits<double>::quiet_NaN();
  std::uint32_t rays = 0;             ///< of the view
  std::uint32_t hits = 0;             ///< rays that end in a voxel
  std::uint32_t unknown_voxels = 0;   ///< distinct; paper
  std::uint32_t occupied_voxels = 0;  ///< distinct; paper, combined
  Status status = Status::bad_pose;   ///< whether it could be scored
};

/// Name of a status, as JSON has it; never throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view view_status_name(ViewGain::Status status);

/// Where one ray of a view ends.
struct VIEWGAIN_EXPORT RayHit {
  /// What a ray ends in. A ray that enters known surface before min_range ends there as at an
  /// obstacle.
  enum class Kind : std::uint8_t { none, unknown, occupied, obstacle };
  Kind kind = Kind::none;  ///< what it ends in
  Index3 voxel{};          ///< the voxel it ends in (unknown, occupied)
  double range =
      std::numeric_limits<double>::infinity();  ///< max(range of the entry point, min_range) [m]
};

/// What one voxel adds to the gain of a view; see GainEvaluator::contributions().
struct VIEWGAIN_EXPORT VoxelContribution {
  Index3 voxel{};                          ///< of the map
  VoxelState state = VoxelState::unknown;  ///< unknown or occupied
  std::uint32_t rays = 0;                  ///< that end in it; surface, combined: that reach it
  /// Rays that are expected to end in it: as many as `rays` for the paper's gain, else the sum of
  /// their chances.
  double expected_rays = 0;
  double gain = 0;  ///< its task weight included, in the gain's unit
};

/// Scores camera poses against a scene by expected information gain (apps/docs/guide/equations.md).
///
/// A camera that is more than 1e6 voxels away from the workspace sees nothing of it: gain 0.
///
/// Thread safety: all const members may run from many threads at once on one evaluator. Allocation:
/// none per pose in the steady state: each thread's buffers grow to the largest view that it has
/// scored and are kept. Determinism: the same bits for any number of threads, run after run.
///
/// Cost of evaluate(): grows with the rays; the surface and the combined gain cost some 4 times the
/// paper's (perf/README.md). That of approximate() grows with the rays that it traces.
/// The constructor costs a PinholeCamera::ray() a pixel and, by the surface and the combined gain,
/// the hazard of a scene that has none yet, by the combined gain also what is known of its surface.
/// @code
/// const GainEvaluator evaluator(VoxelScene::build(grid), sensor);
/// const std::vector<ViewGain> gains = evaluator.evaluate(poses);
/// const BestViews best = evaluator.race(poses, 3);
/// @endcode
class VIEWGAIN_EXPORT GainEvaluator {
 public:
  /// What becomes of a view's rays, for asking why its gain is what it is. Each ray counts once, so
  /// that the counts below `rays` add up to it.
  struct RayOutcomes {
    std::uint32_t rays = 0;           ///< of the view
    std::uint32_t too_near = 0;       ///< meet known surface or an obstacle before min_range
    std::uint32_t unknown = 0;        ///< come to unknown space: what may be new
    std::uint32_t known_surface = 0;  ///< end in known surface, with free space before it
    std::uint32_t obstacle =
        0;  ///< end at an obstacle or, but by the paper's gain, on the support plane
    std::uint32_t out_of_range = 0;  ///< are in known free space to max_range
    std::uint32_t out_of_map = 0;    ///< leave the workspace, or never come into it
  };

  /// Undoes the lens distortion once. By ExecConfig::tracer `embree` the first evaluator of a scene
  /// builds the scene's BVH, 0.5 ms per 1,000 primitives. Throws Error(backend)
  /// if it cannot be built, Error(invalid_argument), naming the value, for a null scene, a sensor
  /// that is not valid or whose sigmas are below 1e-8 m or a factor over 1e3 apart, a stride below
  /// 1, a prior outside 1e-6..1e3 m, a weight or range that is negative or not finite, min_range >=
  /// max_range, or a weight box inside out.
  GainEvaluator(std::shared_ptr<const VoxelScene> scene, const Sensor& sensor,
                const GainConfig& config = {}, const ExecConfig& exec = {});
  ~GainEvaluator();
  GainEvaluator(GainEvaluator&&) noexcept;
  GainEvaluator& operator=(GainEvaluator&&) noexcept;

  /// The evaluator of another scene, for following a map as it grows: the same sensor and
  /// configuration, and shared with this one the ray table, the threads and what they work in.
  /// Takes microseconds. If the gain is surface or combined and the scene is new, its hazard and
  /// pooled information are computed first (some milliseconds). Results have the bits of an
  /// evaluator made for that scene. sigma_0 is the configuration's or, unless given, that of the
  /// new scene's map. This evaluator stays as it is, with its scene. Thread safety: both may be
  /// used, moved and destroyed at the same time; while one's call has the threads, a call of the
  /// other runs on its caller. Throws Error(invalid_argument) for a null scene or a map whose prior
  /// sigma is outside 1e-6..1e3 m, Error(backend), Error(capacity) as VoxelScene::build().
  [[nodiscard]] GainEvaluator with_scene(std::shared_ptr<const VoxelScene> scene) const;

  /// The expected gain of one pose: the paper's on all threads of the evaluator, the others on the
  /// calling one. A bad pose is told by ViewGain::status and not thrown.
  [[nodiscard]] ViewGain evaluate(const Pose& T_world_camera) const;

  /// The expected gains of a batch, result i for pose i, on all threads of the evaluator. A bad
  /// pose spoils only its own result. Returns how many poses were scored: all, or fewer if
  /// `control` ended the call, when the results not reached keep status bad_pose and NaN. Throws
  /// Error(invalid_argument) if the sizes differ.
  std::size_t evaluate(std::span<const Pose> T_world_camera, std::span<ViewGain> results,
                       const BatchControl& control = {}) const;
  /// The same, into a new array.
  [[nodiscard]] std::vector<ViewGain> evaluate(std::span<const Pose> T_world_camera) const;

  /// The user's own gain of a batch, result i for pose i, on all threads of the evaluator, which
  /// call `measure` at once. `results` are in the measure's unit. Bad poses: NaN; a camera in an
  /// occupied voxel: 0; `measure` is asked about neither. Returns how many poses were measured, as
  /// the call above; the results not reached are NaN. What `measure` throws ends the batch and is
  /// thrown again here, and the results are then unspecified. Costs 1.4 times as much as evaluate()
  /// without it, and what `measure` takes. Throws Error(invalid_argument) if the sizes differ.
  std::size_t evaluate(std::span<const Pose> T_world_camera, std::span<double> results,
                       const ViewMeasure& measure, const BatchControl& control = {}) const;

  /// The same for a measure, `results` in its unit, that sees what rays pass on their way through
  /// unknown voxels, whatever the evaluator's model. Lists take 80 bytes for each voxel that a ray
  /// of the view passes and each thread, at full resolution up to 200 MB; a pixel stride makes them
  /// smaller. Costs some times evaluate()'s surface gain. Throws Error(capacity) and
  /// Error(backend), too.
  std::size_t evaluate(std::span<const Pose> T_world_camera, std::span<double> results,
                       const RunMeasure& measure, const BatchControl& control = {}) const;

  /// Why a view is good: one entry for each voxel in which rays of the pose end, the largest gain
  /// first, ties by the voxel's x, y, z. The gains add up to evaluate()'s gain to rounding (1e-9 of
  /// it; surface, combined: 1e-5), the rays to its hits; for surface and combined there is an entry
  /// for each unknown voxel that rays reach, however unlikely they end there. Empty for a bad pose
  /// and for a camera in an occupied voxel: nothing is thrown for them. On the calling thread;
  /// takes three times as long as evaluate().
  [[nodiscard]] std::vector<VoxelContribution> contributions(const Pose& T_world_camera) const;

  /// Where the rays of a pose end, in pixel order (row by row, strided); the hits that evaluate()
  /// uses. Empty for a bad pose: nothing is thrown for it. Costs a trace of the pose.
  [[nodiscard]] std::vector<RayHit> trace(const Pose& T_world_camera) const;

  /// Why a view's gain is what it is: what becomes of each of the rays that evaluate() uses. A
  /// camera in an occupied voxel sees from there. All counts are 0 for a bad pose: nothing is
  /// thrown for it. Costs a trace of the pose and a PinholeCamera::ray() for each ray.
  [[nodiscard]] RayOutcomes outcomes(const Pose& T_world_camera) const;

  /// The k best poses and evaluate()'s results of them, ties to the lower index; fewer where fewer
  /// have a gain: bad poses, and those of which a measure says NaN, are never chosen. `config` may
  /// subtract costs and put a measure of the user's own in the gain's place. All poses are scored,
  /// so it costs what evaluate() does. If a stop is requested or the deadline passes the result is
  /// the best of those scored so far, and not `complete`. Throws Error(invalid_argument) if there
  /// are costs but not one a pose, for one that is not finite, for a deadline that is not >= 0 and
  /// for two measures; and as evaluate() with the measure.
  [[nodiscard]] BestViews best(std::span<const Pose> T_world_camera, std::size_t k = 1,
                               const BestConfig& config = {},
                               const BatchControl& control = {}) const;

  /// The k best poses, very probably, in two stages: all poses are scored by about 400 of their
  /// rays, every s-th pixel and row, as approximate() does, and the best max(24, 4 k, 5 %) of
  /// them in full (by the other gains and measures 1.6 %), so gains reported are exact; best first,
  /// ties to the lower index. A view is lost if its 400 rays make it look worse than that many
  /// others: by the paper's gain the best of 2,000 poses on 3 to 6 of 200 maps of objects, 0.4 % of
  /// its gain at most (perf/results/choosing.md). Images of under 900 rays are all scored in full.
  /// A measure of the user's own is asked about few rays in the first stage; where there are costs
  /// it is brought to the scale of all rays by the median ratio of eight poses that are measured by
  /// both. Works with obstacles, weights and distortion. Without a deadline deterministic for a
  /// seed and any number of threads. With one, the best that can be said by then: poses from all
  /// over the list are estimated in half of the time, then the most promising ones scored in full;
  /// `estimated` and `scored_indices` say how many of each, the others were not looked at.
  /// control.progress counts poses that are out or scored in full. Stopped in the first stage it
  /// returns nothing, in the second the best of those that were scored; either is not `complete`.
  /// Of 2,000 poses it costs 0.22 times what scoring all takes, by the paper's gain
  /// (perf/README.md). Throws as best().
  [[nodiscard]] BestViews race(std::span<const Pose> T_world_camera, std::size_t k = 1,
                               const BestConfig& config = {},
                               const BatchControl& control = {}) const;

  /// Up to k different poses of T_world_camera, in the order of their choice, that are good
  /// together on the map as it stands, greedily: each is the one that adds most to those before it.
  /// By the paper's gain the expected information ΣΛ_r of those is then part of the voxels' (an
  /// unknown voxel goes on blocking rays as unknown). By surface and combined a set is worth
  /// Σ_c a_c p_c [1 - Π_v (1 - R_vc)] over hazard cells c: a_c p_c is the new surface to be
  /// expected there, R_vc the share of it that view v shows, 1 at most, so that one view is worth
  /// no more than its gain but for rounding; combined adds the refinement by all information
  /// together. Ties go to the lower index, bad poses are never chosen, k is clamped. By surface,
  /// combined and log_determinant poses whose earlier gain cannot win are not scored anew. That
  /// gives the same choice for surface and log_determinant, which are submodular; by combined a
  /// refinement may, rarely, grow after another view and then be missed. By log_diagonal and trace
  /// all are scored in every round. control.progress counts those chosen. A stop returns those
  /// chosen so far. Costs by the paper's gain up to k batches of about twice the time of
  /// evaluate(), by the others one batch and some ten times evaluate() for each pose that is scored
  /// anew for the first time; memory for the voxels touched and at most 256 MB of what views reach.
  [[nodiscard]] ViewSet best_set(std::span<const Pose> T_world_camera, std::size_t k,
                                 const BatchControl& control = {}) const;

  /// Estimates of the gains from a lattice of each view's rays, the same for all poses, with
  /// standard errors, result i for pose i. Traced is every s-th ray of every s-th row, s² the least
  /// that keeps to the share; of images of few rays more, 100 if there are as many. At a share of 1
  /// the result is the gain itself, bit for bit, standard error 0. A ray stands for s². In a voxel
  /// that is wider than s pixels rays meet in the sample as they do in the view. Of narrower ones
  /// few are met: each counts as often as its exposed faces, seen from the camera, fit into s × s
  /// pixels, and is seen by as many rays as they cover pixels. What the surface gain counts are
  /// areas, which simply add up. The standard error has three parts: the scatter of sixteen coarser
  /// lattices, the estimate of how much is seen of narrow voxels, and larger voxels that one ray
  /// met where several should, as they are partly hidden. It is fitted so that 90 to 97 % of the
  /// gains lie within two of them over maps of objects and of a room; on one map or lattice 86 %
  /// was seen (perf/results/choosing.md). No pose's estimate depends on others. Bad poses: NaN.
  /// Same for a seed and any number of threads. Returns how many poses were estimated: fewer than
  /// all if a stop was requested. Throws Error(invalid_argument) for a share out of range or if the
  /// sizes differ; Error(backend), Error(capacity) as race().
  std::size_t approximate(std::span<const Pose> T_world_camera, std::span<ApproximateGain> results,
                          const ApproximateConfig& config = {},
                          const BatchControl& control = {}) const;

  /// One for each pixel of the strided image.
  [[nodiscard]] std::size_t rays_per_pose() const noexcept;
  [[nodiscard]] const PinholeCamera& camera() const noexcept;  ///< the sensor's
  /// What a view's gain counts.
  [[nodiscard]] GainModel model() const noexcept;
  /// s, where every s-th pixel of every s-th row has a ray.
  [[nodiscard]] int pixel_stride() const noexcept;
  /// Threads that a batch runs on.
  [[nodiscard]] int num_threads() const noexcept;
  [[nodiscard]] double prior_sigma() const noexcept;  ///< [m]
  /// What poses are scored against.
  [[nodiscard]] const VoxelScene& scene() const noexcept;

 private:
  struct Impl;
  friend struct detail::EvaluatorAccess;
  explicit GainEvaluator(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Indices of the k best results, which are one a pose: larger gain first, ties to the lower index,
/// NaN last. k is clamped; never throws. Costs O(n log n).
[[nodiscard]] VIEWGAIN_EXPORT std::vector<std::size_t> best_indices(
    std::span<const ViewGain> results, std::size_t k);

/// The depths along the optical axis [m] at which the rays that evaluate() uses end, row by row,
/// for looking at what a gain comes from: every s-th pixel of every s-th row for a pixel stride s;
/// DepthFrame::kOutOfRange where a ray meets nothing. `labels`, if given, becomes what each meets.
/// A camera in an occupied voxel sees from there. Costs a trace of the pose and, with lens
/// distortion, its undoing for every pixel. Thread safe. Throws Error(invalid_argument) for a pose
/// that is not finite or off by more than 1e-3.
[[nodiscard]] VIEWGAIN_EXPORT DepthFrame depth_image(const GainEvaluator& evaluator,
                                                     const Pose& T_world_camera,
                                                     std::vector<RayHit::Kind>* labels = nullptr);

}  // namespace viewgain
