// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/view_scorer.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <mutex>
#include <string>
#include <utility>

#include "scorer/frame_judge.hpp"
#include "scorer/map_version.hpp"
#include "scorer/realised_area.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/grid/hazard_calibration.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/raycast/feasibility.hpp"
#include "viewgain/raycast/obstacle_view.hpp"
#include "viewgain/support/shared_rays.hpp"
#include "viewgain/support/stopwatch.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain {
namespace {

// Voxels as large as the workspace, or larger than the sensor's range, have the wrong unit.
BeliefGrid empty_grid(const GridConfig& config, const Sensor& sensor) {
  BeliefGrid grid(config, sensor);
  const auto& [min, max] = config.workspace;
  const double longest = std::max({max[0] - min[0], max[1] - min[1], max[2] - min[2]});
  if (config.voxel_size < longest && config.voxel_size <= sensor.max_range) return grid;
  refuse("the workspace is " + short_text(longest) + " m long and its voxels are " +
         short_text(config.voxel_size) + " m wide, but the sensor's range ends at " +
         short_text(sensor.max_range) + " m; lengths must be in metres");
}

// The feasible ones of some poses.
struct Possible {
  std::vector<std::size_t> numbers;  // ascending
  bool is_complete = true;           // false: not all poses were checked
};

constexpr std::size_t kChecked = 256;      // poses per step
constexpr double kShareOfDeadline = 0.25;  // largest fraction of the deadline for checking

// Takes poses from all over the list, so that a deadline does not favour the first ones.
Possible possible_ones(const FeasibilityChecker& checker, std::span<const Pose> poses,
                       double seconds, const BatchControl& control) {
  const Stopwatch watch;
  Possible possible;
  const std::size_t passes = (poses.size() + kChecked - 1) / kChecked;
  for (std::size_t pass = 0; pass < passes; ++pass) {
    const bool is_late = pass > 0 && watch.seconds() > seconds;
    if (is_late || (control.is_cancelled && control.is_cancelled())) {
      possible.is_complete = false;
      break;
    }
    std::vector<Pose> some;
    for (std::size_t i = pass; i < poses.size(); i += passes) some.push_back(poses[i]);
    for (const std::size_t number : feasible_poses(checker, some, {}).numbers) {
      possible.numbers.push_back(pass + number * passes);
    }
  }
  std::sort(possible.numbers.begin(), possible.numbers.end());
  return possible;
}

void check_costs(std::span<const double> costs, std::size_t poses) {
  if (costs.empty()) return;
  if (costs.size() != poses) {
    refuse("best: one cost per pose is required; costs: " + std::to_string(costs.size()) +
           ", poses: " + std::to_string(poses));
  }
  for (const double cost : costs) {
    if (!std::isfinite(cost)) refuse("best: a cost is " + short_text(cost) + "; it must be finite");
  }
}

// Replaces the layout by that of the map.
ScorerConfig with_layout(ScorerConfig config, const BeliefGrid& grid) {
  if (config.gain.prior_sigma)
    refuse("gain.prior_sigma cannot be used here; set ScorerConfig::prior_sigma");
  if (!(config.clearance >= 0) || !std::isfinite(config.clearance)) {
    refuse("the clearance is " + short_text(config.clearance) +
           " m; it must be at least 0 and finite");
  }
  config.voxel_size = grid.voxel_size();
  config.workspace = grid.workspace();
  config.T_world_grid = grid.T_world_grid();
  config.prior_sigma = grid.prior_sigma();
  return config;
}

}  // namespace

struct ViewScorer::Impl {
  Sensor sensor;
  ScorerConfig config;
  ExecConfig exec;
  BeliefGrid grid;
  std::optional<JumpEdgeFilter> filter;
  /// Per pixel, (x, y, 1); not finite if the pixel has no ray.
  std::shared_ptr<const std::vector<Eigen::Vector3d>> rays;
  ObstacleView obstacles;
  FrameIntegrator integrator;
  FrameCheck check;
  ThreadPool pool;
  HazardCalibration calibration;
  bool learns;
  std::optional<detail::RealisedArea> new_surface;  ///< if it is measured
  VoxelBox voxels;                                  ///< of the workspace
  std::mutex changing;
  bool is_published = true;    ///< whether `current` shows the grid
  mutable std::mutex reading;  ///< protects `current`
  std::shared_ptr<detail::MapVersion> current;

  Impl(BeliefGrid map, const Sensor& of, const ScorerConfig& with, const ExecConfig& by)
      : sensor(of),
        config(with_layout(with, map)),
        exec(by),
        grid(std::move(map)),
        rays(shared_rays(of.camera)),
        obstacles(with.obstacles, of, by),
        integrator(of, with.integration(), by),
        check(of, with.support_plane, by),
        pool(by.num_threads),
        calibration(of, with.support_plane, by),
        learns(with.learn_hazard.value_or(with.gain.model != GainModel::paper)),
        voxels(VoxelBox::from_dims(grid.min_index(), grid.dims())),
        current(std::make_shared<detail::MapVersion>(grid, of, config, by)) {
    if (learns && with.measure_new_area) {
      new_surface.emplace(of, grid.voxel_size(), with.support_plane);
    }
    if (with.jump_edges) filter.emplace(of.camera, *with.jump_edges, by);
  }

  [[nodiscard]] std::shared_ptr<detail::MapVersion> now() const {
    const std::lock_guard lock(reading);
    return current;
  }

  /// To be called after each change of the grid.
  void publish() {
    auto next = std::make_shared<detail::MapVersion>(*now(), grid);
    is_published = true;
    const std::lock_guard lock(reading);
    current.swap(next);  // the old version is destroyed without the lock
  }

  /// change() must return the number of changed voxels.
  template <typename Change>
  std::uint64_t change(const Change& change) {
    const std::lock_guard lock(changing);
    const std::uint64_t count = change();
    if (count > 0) is_published = false;
    if (!is_published) publish();
    return count;
  }

  [[nodiscard]] bool shows_workspace(const DepthFrame& frame, const Pose& T_world_camera) const {
    const auto shows = [&](std::size_t i) {
      const Eigen::Vector3d p = static_cast<double>(frame.depth[i]) * (*rays)[i];
      const double range = p.norm();
      // False for pixels without a depth or without a ray.
      if (!(range >= sensor.min_range && range <= sensor.max_range)) return false;
      return !frame.shows_known(i) && grid.index_of(T_world_camera * p).has_value();
    };
    // First a few pixels of the whole image, because one is enough.
    constexpr std::size_t kPasses = 61;
    for (std::size_t pass = 0; pass < kPasses; ++pass) {
      for (std::size_t i = pass; i < rays->size(); i += kPasses) {
        if (shows(i)) return true;
      }
    }
    return false;
  }

  void drop_known_readings(DepthFrame& frame, const Pose& T_world_camera) const {
    for (std::size_t i = 0; i < frame.depth.size(); ++i) {
      const float z = frame.depth[i];
      if (z == DepthFrame::kInvalid || z == DepthFrame::kOutOfRange || !(*rays)[i].allFinite())
        continue;
      const auto voxel =
          grid.index_of(T_world_camera * Eigen::Vector3d((*rays)[i] * static_cast<double>(z)));
      if (voxel && grid.belief(*voxel)) frame.depth[i] = DepthFrame::kInvalid;
    }
  }

  /// The frames as they are integrated: filtered, with known objects marked.
  [[nodiscard]] std::vector<DepthFrame> filtered(const Measurements& measurements,
                                                 std::size_t& flying_pixels) const {
    std::vector<DepthFrame> frames = measurements.frames;
    for (DepthFrame& frame : frames) {
      if (filter) flying_pixels += filter->apply(frame);
      if (!config.refine) drop_known_readings(frame, measurements.T_world_camera);
      obstacles.mark(frame, measurements.T_world_camera);
    }
    return frames;
  }

  /// Integrates the filtered frames into `map`, the grid or a copy of it.
  void integrate(BeliefGrid& map, const std::vector<DepthFrame>& frames,
                 const Measurements& measurements, MapUpdate& update) {
    const Pose& T_world_camera = measurements.T_world_camera;
    if (new_surface) update.new_area = 0;
    if (learns && !frames.empty()) {
      const HazardProbe hazard = now()->hazard_probe(config.hazard);
      if (new_surface) {
        update.new_area = new_surface->of(frames.front(), T_world_camera, map, &hazard, pool);
      }
      calibration.count(map, hazard, frames.front(), T_world_camera);
    }
    for (const DepthFrame& frame : frames) {
      if (&map == &grid) check.look(map, frame, T_world_camera, measurements.pose_sigma);
      update.counts += integrator.integrate(map, frame, T_world_camera, measurements.pose_sigma);
    }
  }

  MapUpdate add(const Measurements& measurements) {
    MapUpdate update;
    update.verdict = detail::judged(measurements, sensor);
    for (const DepthFrame& frame : measurements.frames) {
      check.see(frame, measurements.T_world_camera);
    }
    if (update.verdict != FrameVerdict::used) return update;
    const Stopwatch watch;
    const std::vector<DepthFrame> frames = filtered(measurements, update.flying_pixels);
    const bool has_readings =
        std::any_of(frames.begin(), frames.end(), [&](const DepthFrame& frame) {
          return shows_workspace(frame, measurements.T_world_camera);
        });
    if (has_readings) {
      is_published = false;
      integrate(grid, frames, measurements, update);
      if (update.counts.readings_inside == 0) update.verdict = FrameVerdict::carved;
    } else {
      // Whether the frame marks any free space is known only after integrating it into a copy.
      BeliefGrid carved = grid.clone();
      integrate(carved, frames, measurements, update);
      const IntegrationReport& counts = update.counts;
      if (counts.voxels_crossed + counts.voxels_hit > 0) {
        update.verdict = FrameVerdict::carved;
        for (const DepthFrame& frame : frames) {
          check.look(grid, frame, measurements.T_world_camera, measurements.pose_sigma);
        }
        is_published = false;
        grid = std::move(carved);
      } else {
        const bool says_something =
            counts.readings + counts.plane_readings + counts.out_of_range > 0;
        update.verdict = says_something ? FrameVerdict::outside : FrameVerdict::nothing_in_range;
      }
    }
    update.seconds["integrate"] = watch.seconds();
    if (is_published) return update;
    const Stopwatch snapshot_watch;
    publish();
    update.seconds["snapshot"] = snapshot_watch.seconds();
    return update;
  }
};

ViewScorer::ViewScorer(const Sensor& sensor, const ScorerConfig& config, const ExecConfig& exec)
    : ViewScorer(empty_grid(config.grid(), sensor), sensor, config, exec) {}

ViewScorer::ViewScorer(BeliefGrid grid, const Sensor& sensor, const ScorerConfig& config,
                       const ExecConfig& exec)
    : impl_(std::make_unique<Impl>(std::move(grid), sensor, config, exec)) {}

ViewScorer::~ViewScorer() = default;
ViewScorer::ViewScorer(ViewScorer&&) noexcept = default;
ViewScorer& ViewScorer::operator=(ViewScorer&&) noexcept = default;

MapUpdate ViewScorer::add(const DepthFrame& frame, const Pose& T_world_camera,
                          const PoseSigma& pose_sigma) {
  return add({T_world_camera, {frame}, pose_sigma});
}

MapUpdate ViewScorer::add(const Measurements& measurements) {
  const std::lock_guard lock(impl_->changing);
  return impl_->add(measurements);
}

std::uint64_t ViewScorer::set(const VoxelBox& box, std::span<const std::uint8_t> labels) {
  return impl_->change([&] { return impl_->grid.update_box(box, labels); });
}

std::uint64_t ViewScorer::forget(const Box& region) {
  return impl_->change([&] { return impl_->grid.forget(region); });
}

std::vector<ViewGain> ViewScorer::evaluate(std::span<const Pose> T_world_camera) const {
  return evaluator()->evaluate(T_world_camera);
}

std::vector<double> ViewScorer::evaluate(std::span<const Pose> T_world_camera,
                                         const ViewMeasure& measure) const {
  std::vector<double> results(T_world_camera.size());
  evaluator()->evaluate(T_world_camera, results, measure);
  return results;
}

std::vector<double> ViewScorer::evaluate(std::span<const Pose> T_world_camera,
                                         const RunMeasure& measure) const {
  std::vector<double> results(T_world_camera.size());
  evaluator()->evaluate(T_world_camera, results, measure);
  return results;
}

BestViews ViewScorer::best(std::span<const Pose> T_world_camera, std::size_t k,
                           const BestConfig& config, const BatchControl& control) const {
  const std::shared_ptr<detail::MapVersion> now = impl_->now();
  const auto evaluator = now->evaluator();
  const auto checker = now->checker();
  if (!checker) return evaluator->race(T_world_camera, k, config, control);
  check_costs(config.costs, T_world_camera.size());
  const Stopwatch watch;
  const Possible possible =
      possible_ones(*checker, T_world_camera, kShareOfDeadline * config.deadline, control);
  std::vector<Pose> poses;
  std::vector<double> costs;
  for (const std::size_t i : possible.numbers) {
    poses.push_back(T_world_camera[i]);
    if (!config.costs.empty()) costs.push_back(config.costs[i]);
  }
  BestConfig of_possible = config;
  of_possible.costs = costs;
  if (config.deadline > 0) {
    of_possible.deadline = std::max(0.0, config.deadline - watch.seconds());
  }
  BatchControl of_all = control;
  if (control.progress) {
    of_all.progress = [&](std::size_t done, std::size_t) {
      control.progress(T_world_camera.size() - poses.size() + done, T_world_camera.size());
    };
  }
  BestViews best = evaluator->race(poses, k, of_possible, of_all);
  best.complete = best.complete && possible.is_complete;
  for (std::vector<std::size_t>* indices : {&best.indices, &best.scored_indices}) {
    for (std::size_t& index : *indices) index = possible.numbers[index];
  }
  return best;
}

std::shared_ptr<const VoxelScene> ViewScorer::scene() const { return impl_->now()->scene(); }
std::shared_ptr<const GainEvaluator> ViewScorer::evaluator() const {
  return impl_->now()->evaluator();
}
const BeliefGrid& ViewScorer::grid() const noexcept { return impl_->grid; }
const VoxelBox& ViewScorer::voxels() const noexcept { return impl_->voxels; }
const Sensor& ViewScorer::sensor() const noexcept { return impl_->sensor; }
const ScorerConfig& ViewScorer::config() const noexcept { return impl_->config; }
const ExecConfig& ViewScorer::exec() const noexcept { return impl_->exec; }

ModelProgress ViewScorer::progress() const {
  const BeliefGrid::Statistics statistics = grid().statistics(impl_->config.gain.criterion);
  ModelProgress progress;
  progress.entropy_removed = statistics.entropy_removed;
  progress.unknown_voxels = statistics.unknown;
  return progress;
}

FrameConsistency ViewScorer::consistency() const { return impl_->check.result(impl_->grid); }

BeliefGrid ViewScorer::grid_after(const Measurements& measurements) const {
  const Impl& m = *impl_;
  const FrameVerdict verdict = detail::judged(measurements, m.sensor);
  if (verdict != FrameVerdict::used) {
    refuse("the frames cannot be used; their verdict is " +
           std::string(frame_verdict_name(verdict)));
  }
  BeliefGrid after = m.grid.clone();
  FrameIntegrator integrator(m.sensor, m.config.integration(), m.exec);
  std::size_t flying_pixels = 0;
  for (const DepthFrame& frame : m.filtered(measurements, flying_pixels)) {
    integrator.integrate(after, frame, measurements.T_world_camera, measurements.pose_sigma);
  }
  return after;
}

void ViewScorer::save(const std::filesystem::path& path) const { save_vdb(grid(), path); }

ViewScorer ViewScorer::load(const std::filesystem::path& path, const Sensor& sensor,
                            const ScorerConfig& config, const ExecConfig& exec) {
  return {load_vdb(path, exec), sensor, config, exec};
}

}  // namespace viewgain
