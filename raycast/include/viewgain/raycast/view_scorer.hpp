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

/// Settings of a ViewScorer. Defaults suit an object at the origin.
struct VIEWGAIN_EXPORT ScorerConfig {
  double voxel_size = GridConfig{}.voxel_size;  ///< [m]
  /// The mapped part of the world, in the grid frame [m]; extended to whole voxels. The workspace
  /// should start at the table; otherwise the paper's gain counts unknown space below the table.
  Box workspace = GridConfig{}.workspace;
  Pose T_world_grid{};  ///< pose of the grid frame
  /// Standard deviation of the surface in an unknown voxel [m]. Unset: default_prior_sigma().
  std::optional<double> prior_sigma{};
  std::optional<double> support_plane{};  ///< height z of an infinite table plane [m], world
  /// Known obstacles, world frame. They block rays and bodies. Measured depths of obstacles mark
  /// free space, but never make a voxel occupied.
  Obstacles obstacles{};
  /// Removes flying pixels from frames; unset: no filter.
  std::optional<JumpEdgeFilter::Config> jump_edges = JumpEdgeFilter::Config{};
  // The next five settings are those of IntegrationConfig.
  IntegrationConfig::Carve carve = IntegrationConfig{}.carve;  ///< which voxels a pixel crosses
  IntegrationConfig::Occupancy occupancy = IntegrationConfig{}.occupancy;  ///< how states change
  int coarsest = IntegrationConfig{}.coarsest;  ///< largest scale of a leaf, 0 to 3
  int finest = IntegrationConfig{}.finest;      ///< smallest scale of a leaf outside `fine`
  std::vector<Box> fine{};  ///< leaves that touch one of these boxes keep scale 0; grid's frame [m]
  bool refine = true;       ///< false: ignores readings in voxels that already have one
  HazardConfig hazard{};    ///< rate at which rays meet the surface in unknown space
  /// Whether each frame updates the hazard and measures MapUpdate::new_area. Unset: false for the
  /// paper's gain, which needs neither; otherwise true.
  std::optional<bool> learn_hazard{};
  bool measure_new_area = true;  ///< false: frames that update the hazard do not measure it
  GainConfig gain{};             ///< settings of the gain
  double clearance = 0;          ///< margin around the sensor's body that best() requires [m]

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

/// Effect of the frames from one pose.
struct VIEWGAIN_EXPORT MapUpdate {
  FrameVerdict verdict = FrameVerdict::used;  ///< the map is unchanged unless is_in_map()
  IntegrationReport counts{};                 ///< of all frames together
  std::size_t flying_pixels = 0;              ///< removed by the jump-edge filter
  /// Area of new surface in the first frame, measured perpendicular to the rays [m²], to compare
  /// with ViewGain::area (apps/docs/guide/surface_gain.md). Measured depths count if they lie in
  /// unknown voxels away from known surface. NaN without ScorerConfig::learn_hazard and
  /// measure_new_area.
  double new_area = std::numeric_limits<double>::quiet_NaN();
  StageSeconds seconds{};  ///< "integrate": filters and map; "snapshot": data for scenes
};

/// Takes depth frames or labelled voxels and returns gains of camera poses. Keeps a map, its scene
/// and its evaluator up to date.
///
/// Thread safety: evaluate(), best(), scene(), evaluator(), voxels(), sensor(), config() and exec()
/// may run in any thread at any time. They do not wait for add(), set() or forget(), and use the
/// map before or after that change. One of several concurrent scoring calls uses all threads; the
/// others run on their callers' threads. Changes wait for one another. During a change, do not call
/// progress(), consistency(), grid_after() or save(), and do not read grid().
///
/// Cost: after a change, the first call that needs the scene updates it: some milliseconds.
/// @code
/// ViewScorer scorer(sensor, {.voxel_size = 0.005, .workspace = box, .support_plane = 0.0});
/// scorer.add(frame, T_world_camera);
/// const BestViews best = scorer.best(poses, 3);  // indices into poses, best first
/// @endcode
class VIEWGAIN_EXPORT ViewScorer {
 public:
  /// Starts with an empty map. Throws Error(invalid_argument) naming the value for an invalid
  /// sensor or setting, if gain.prior_sigma is set, and for voxels as large as the workspace or
  /// larger than the sensor's range. Throws Error(backend) if Embree fails. Cost: five
  /// calls of PinholeCamera::ray_table().
  explicit ViewScorer(const Sensor& sensor, const ScorerConfig& config = {},
                      const ExecConfig& exec = {});
  /// Starts from a map, whose layout and prior replace those of the config. Errors as above.
  ViewScorer(BeliefGrid grid, const Sensor& sensor, const ScorerConfig& config = {},
             const ExecConfig& exec = {});
  ~ViewScorer();
  /// A moved-from scorer can only be assigned to or destroyed.
  ViewScorer(ViewScorer&&) noexcept;
  ViewScorer& operator=(ViewScorer&&) noexcept;

  /// Filters a frame, marks obstacles in it, updates the hazard and integrates the frame. A frame
  /// that cannot be used does not throw; the verdict gives the reason. `pose_sigma` [m], [rad] is
  /// the pose's uncertainty in addition to Sensor::pose_sigma. Throws Error(invalid_argument)
  /// for an invalid sigma or frame identity; the map then stays unchanged. If learn_hazard is on,
  /// also throws whatever scene() throws. Cost: FrameIntegrator::integrate(), and a snapshot.
  MapUpdate add(const DepthFrame& frame, const Pose& T_world_camera,
                const PoseSigma& pose_sigma = {});
  /// As above, for several frames from one pose.
  MapUpdate add(const Measurements& measurements);

  /// Labels the voxels of a box, [x][y][z] with z fastest: 0 unknown, 1 free, 2 occupied. Returns
  /// how many voxels changed. Labelled voxels add no refinement to the combined gain. Throws like
  /// BeliefGrid::update_box(). Cost: a pass over the labels, and a snapshot.
  std::uint64_t set(const VoxelBox& box, std::span<const std::uint8_t> labels);

  /// Resets a region of the grid frame [m] to unknown, for example after an object has moved.
  /// Returns how many voxels were known. Throws like BeliefGrid::forget(). Cost: one pass over the
  /// map's blocks.
  std::uint64_t forget(const Box& region);

  /// GainEvaluator::evaluate() on the current map: one gain per pose, in order.
  [[nodiscard]] std::vector<ViewGain> evaluate(std::span<const Pose> T_world_camera) const;
  /// As above with a custom gain, in its unit.
  [[nodiscard]] std::vector<double> evaluate(std::span<const Pose> T_world_camera,
                                             const ViewMeasure& measure) const;
  /// As above with a custom gain that sees all voxels that rays pass.
  [[nodiscard]] std::vector<double> evaluate(std::span<const Pose> T_world_camera,
                                             const RunMeasure& measure) const;

  /// The k best poses with high probability: GainEvaluator::race(). Indices refer to
  /// T_world_camera, best first. If Sensor::body_size is set, omits poses where the body has no
  /// room or surface is too near (FeasibilityConfig::sensor). The deadline includes this check. A
  /// gain of 0 means that nothing new would be seen. Throws like race() and scene(). Cost: race(),
  /// and FeasibilityChecker::check().
  [[nodiscard]] BestViews best(std::span<const Pose> T_world_camera, std::size_t k = 1,
                               const BestConfig& config = {},
                               const BatchControl& control = {}) const;

  /// The current scene, a snapshot that later changes of the map do not affect. Throws like
  /// VoxelScene::build().
  [[nodiscard]] std::shared_ptr<const VoxelScene> scene() const;
  /// The evaluator of the current scene, which later changes of the map do not affect.
  [[nodiscard]] std::shared_ptr<const GainEvaluator> evaluator() const;
  /// The map. Not a copy: do not read it while add(), set() or forget() runs. Valid until the
  /// scorer is assigned to or destroyed.
  [[nodiscard]] const BeliefGrid& grid() const noexcept;
  [[nodiscard]] const VoxelBox& voxels() const noexcept;      ///< of the workspace, constant
  [[nodiscard]] const Sensor& sensor() const noexcept;        ///< sensor of the frames
  [[nodiscard]] const ScorerConfig& config() const noexcept;  ///< with the map's layout and prior
  [[nodiscard]] const ExecConfig& exec() const noexcept;      ///< as constructed

  /// Entropy removed and number of unknown voxels; no coverage, no surface. Cost:
  /// BeliefGrid::statistics().
  [[nodiscard]] ModelProgress progress() const;
  /// How well the frames added so far agree. Cost: FrameCheck::result().
  [[nodiscard]] FrameConsistency consistency() const;
  /// A copy of the map with these measurements integrated; the scorer does not change. Throws
  /// Error(invalid_argument) for a wrong image size or a pose that is not rigid. Also throws
  /// whatever add() throws. Cost: a copy of the map, and FrameIntegrator::integrate() per frame.
  [[nodiscard]] BeliefGrid grid_after(const Measurements& measurements) const;

  /// Writes the map with save_vdb(). A scorer loaded from the file gives the same gains, but its
  /// consistency() starts without frames. Throws like save_vdb().
  void save(const std::filesystem::path& path) const;
  /// Continues from a file written by save(), or from any other .vdb map. Throws like load_vdb()
  /// and the constructor.
  [[nodiscard]] static ViewScorer load(const std::filesystem::path& path, const Sensor& sensor,
                                       const ScorerConfig& config = {},
                                       const ExecConfig& exec = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
