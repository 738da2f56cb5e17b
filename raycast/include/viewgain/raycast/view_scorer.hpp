// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "viewgain/core/box.hpp"
#include "viewgain/core/camera.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/frame_verdict.hpp"
#include "viewgain/core/jump_edge_filter.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/hazard.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/raycast/frame_check.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain {

/// Settings of a ViewScorer. The defaults suit an object at the origin.
struct VIEWGAIN_EXPORT ScorerConfig {
  double voxel_size = GridConfig{}.voxel_size;  ///< [m]
  /// The part of space that is mapped, grid frame [m]. Extended to whole voxels. It should begin at
  /// the table, because the paper's gain counts unknown space below the table.
  Box workspace = GridConfig{}.workspace;
  Pose T_world_grid{};  ///< pose of the grid frame in the world
  /// Standard deviation of the surface position in an unknown voxel [m]. Unset:
  /// default_prior_sigma().
  std::optional<double> prior_sigma{};
  std::optional<double> support_plane{};  ///< height z of an infinite table plane [m], world
  /// Known obstacles, world frame. They block rays and the body. Readings (measured depths) of
  /// obstacles mark free space, but hit no voxel.
  Obstacles obstacles{};
  /// Filter that removes flying pixels from frames; unset: none.
  std::optional<JumpEdgeFilter::Config> jump_edges = JumpEdgeFilter::Config{};
  // The next five members have the meaning of those of IntegrationConfig.
  IntegrationConfig::Carve carve = IntegrationConfig{}.carve;  ///< which voxels a pixel crosses
  IntegrationConfig::Occupancy occupancy = IntegrationConfig{}.occupancy;  ///< how states change
  int coarsest = IntegrationConfig{}.coarsest;  ///< largest scale of a leaf, 0 to 3
  int finest = IntegrationConfig{}.finest;      ///< smallest scale of a leaf outside `fine`
  std::vector<Box> fine{};  ///< leaves that touch one of these boxes keep scale 0; grid frame [m]
  bool refine = true;       ///< false: ignores readings in voxels that already have a reading
  HazardConfig hazard{};    ///< rate at which rays meet the surface in unknown space
  /// Whether each frame updates the map's counts for the hazard (HazardCalibration) and measures
  /// MapUpdate::new_area. Unset: false for the paper's gain, which needs neither; otherwise true.
  std::optional<bool> learn_hazard{};
  bool measure_new_area = true;  ///< false: does not measure MapUpdate::new_area
  GainConfig gain{};             ///< settings of the gain
  double clearance = 0;          ///< margin around the camera's body in best() [m]

  /// The layout of the map.
  [[nodiscard]] GridConfig grid() const {
    return {voxel_size, workspace, T_world_grid, prior_sigma};
  }
  /// The settings of the integration.
  [[nodiscard]] IntegrationConfig integration() const {
    return {carve, occupancy, support_plane, coarsest, fine, finest};
  }
  /// The surroundings of the map.
  [[nodiscard]] Surroundings surroundings() const { return {obstacles, support_plane}; }
};

/// Effect of the frames from one pose on the map.
struct VIEWGAIN_EXPORT MapUpdate {
  /// How the frames were used. Unless is_in_map(verdict), the map is unchanged.
  FrameVerdict verdict = FrameVerdict::used;
  IntegrationReport counts{};     ///< sums over the frames
  std::size_t flying_pixels = 0;  ///< number of pixels that the jump-edge filter removed
  /// Area of new surface in the first frame [m²], measured perpendicular to the rays like
  /// ViewGain::area, with which it can be compared (apps/docs/guide/surface_gain.md). It counts
  /// readings in unknown voxels away from known surface. NaN unless ScorerConfig::learn_hazard and
  /// measure_new_area are true.
  double new_area = std::numeric_limits<double>::quiet_NaN();
  /// Duration of "integrate" (filters and map) and "snapshot" (data for scenes).
  StageSeconds seconds{};
};

/// Takes depth frames or labelled voxels and returns gains of camera poses. Contains a map, and
/// keeps its scene and its evaluator up to date.
///
/// Thread safety: add(), set() and forget() change the map, and wait for one another. evaluate(),
/// best(), scene(), evaluator(), voxels(), sensor(), config() and exec() may run in any thread at
/// any time. They do not wait for a change: they use the map as it is before or after it. If
/// several of them score poses, one uses all threads and the others run on their calling threads.
/// During a change, do not call progress(), consistency(), grid_after() or save(), and do not read
/// grid().
///
/// Cost: the first call that needs the scene after a change updates it in some milliseconds.
/// @code
/// ViewScorer scorer(sensor, {.voxel_size = 0.005, .workspace = box, .support_plane = 0.0});
/// scorer.add(frame, T_world_camera);
/// const BestViews best = scorer.best(poses, 3);  // indices into poses, best first
/// @endcode
class VIEWGAIN_EXPORT ViewScorer {
 public:
  /// Starts with a map in which all voxels are unknown. Throws Error(invalid_argument), naming the
  /// value, if the sensor or a setting is invalid, gain.prior_sigma is set, or voxels are as large
  /// as the workspace or larger than the sensor's range. Throws Error(backend) if Embree fails.
  /// Cost: some passes over the pixels, and tables of about 150 bytes per pixel.
  explicit ViewScorer(const Sensor& sensor, const ScorerConfig& config = {},
                      const ExecConfig& exec = {});
  /// As above, but starts with a given map. Its layout and prior replace those of `config`.
  ViewScorer(BeliefGrid grid, const Sensor& sensor, const ScorerConfig& config = {},
             const ExecConfig& exec = {});
  ~ViewScorer();
  /// A moved-from scorer can only be assigned to or destroyed.
  ViewScorer(ViewScorer&&) noexcept;
  ViewScorer& operator=(ViewScorer&&) noexcept;

  /// Filters a frame, marks obstacles in it, updates the counts for the hazard and integrates the
  /// frame. Does not throw for a frame that cannot be used; MapUpdate::verdict gives the reason.
  /// `pose_sigma` is the uncertainty of this pose in addition to Sensor::pose_sigma. Throws
  /// Error(invalid_argument), and changes nothing, if a sigma or the identity of the frame is
  /// invalid. With learn_hazard, also throws whatever scene() throws. Cost:
  /// FrameIntegrator::integrate(), and a snapshot.
  MapUpdate add(const DepthFrame& frame, const Pose& T_world_camera,
                const PoseSigma& pose_sigma = {});
  /// As above, for several frames from one pose.
  MapUpdate add(const Measurements& measurements);

  /// Sets the states of the voxels in a box. `labels` are [x][y][z] with z fastest: 0 unknown, 1
  /// free, 2 occupied. Returns the number of changed voxels. Labelled voxels add no refinement to
  /// the combined gain. Throws whatever BeliefGrid::update_box() throws. Cost: one pass over the
  /// labels, and a snapshot.
  std::uint64_t set(const VoxelBox& box, std::span<const std::uint8_t> labels);

  /// Makes a region of the grid frame [m] unknown again, for example when an object has moved.
  /// Returns the number of voxels that were known. Throws whatever BeliefGrid::forget() throws.
  /// Cost: one pass over the map's leaves.
  std::uint64_t forget(const Box& region);

  /// Gains of poses on the current map, in order; see GainEvaluator::evaluate().
  [[nodiscard]] std::vector<ViewGain> evaluate(std::span<const Pose> T_world_camera) const;
  /// As above, with a custom gain.
  [[nodiscard]] std::vector<double> evaluate(std::span<const Pose> T_world_camera,
                                             const ViewMeasure& measure) const;
  /// As above, with a custom gain that sees all unknown voxels that rays pass.
  [[nodiscard]] std::vector<double> evaluate(std::span<const Pose> T_world_camera,
                                             const RunMeasure& measure) const;

  /// The k best poses on the current map, with high probability; see GainEvaluator::race(). If
  /// Sensor::body_size is set, omits poses at which the body has no room or surface is too near
  /// (FeasibilityConfig::sensor). The deadline includes this check. A gain of 0 means that the view
  /// would show nothing new. Throws whatever race() and scene() throw. Cost: race(), and
  /// FeasibilityChecker::check().
  [[nodiscard]] BestViews best(std::span<const Pose> T_world_camera, std::size_t k = 1,
                               const BestConfig& config = {},
                               const BatchControl& control = {}) const;

  /// The current scene. Later changes of the map do not affect it. Throws whatever
  /// VoxelScene::build() throws.
  [[nodiscard]] std::shared_ptr<const VoxelScene> scene() const;
  /// The evaluator of the current scene. Later changes of the map do not affect it.
  [[nodiscard]] std::shared_ptr<const GainEvaluator> evaluator() const;
  /// The map. It is not a copy: do not read it while add(), set() or forget() runs. Valid until the
  /// scorer is assigned to or destroyed.
  [[nodiscard]] const BeliefGrid& grid() const noexcept;
  [[nodiscard]] const VoxelBox& voxels() const noexcept;      ///< voxels of the workspace; constant
  [[nodiscard]] const Sensor& sensor() const noexcept;        ///< sensor of the frames
  [[nodiscard]] const ScorerConfig& config() const noexcept;  ///< with the map's layout and prior
  [[nodiscard]] const ExecConfig& exec() const noexcept;      ///< threads and tracer

  /// The removed entropy and the number of unknown voxels. The other members are unset. Cost:
  /// BeliefGrid::statistics().
  [[nodiscard]] ModelProgress progress() const;
  /// How well the frames added so far agree. Cost: FrameCheck::result().
  [[nodiscard]] FrameConsistency consistency() const;
  /// A copy of the map into which these measurements are integrated. The scorer does not change.
  /// Throws Error(invalid_argument) if a frame has a wrong size or the pose is not rigid within
  /// 1e-3. Also throws whatever add() throws. Cost: a copy of the map, and
  /// FrameIntegrator::integrate() per frame.
  [[nodiscard]] BeliefGrid grid_after(const Measurements& measurements) const;

  /// Writes the map with save_vdb(), and throws whatever it throws. A scorer that is loaded from
  /// the file gives the same gains, but its consistency() starts without frames.
  void save(const std::filesystem::path& path) const;
  /// A scorer that starts with the map from a file of save(), or from any other .vdb map. Throws
  /// whatever load_vdb() and the constructor throw.
  [[nodiscard]] static ViewScorer load(const std::filesystem::path& path, const Sensor& sensor,
                                       const ScorerConfig& config = {},
                                       const ExecConfig& exec = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
