// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "decision_bench.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "environment.hpp"
#include "measure.hpp"
#include "methods/octomap_integrate.hpp"
#include "methods/octomap_methods.hpp"
#include "model_maps.hpp"
#include "model_scene.hpp"
#include "sizes/hall_bench.hpp"
#include "support/room_scene.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/literature/classic_gains.hpp"
#include "viewgain/planner_mesh/candidate_generation.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/raycast/feasibility.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::bench {
namespace {

using Json = nlohmann::ordered_json;
using Frames = std::function<std::pair<DepthFrame, Pose>(std::size_t)>;

constexpr std::size_t kViews = 8;  // of the camel before the frame that is timed
constexpr std::size_t kHallFrames = 60;
constexpr double kHallVoxel = 0.05;       // [m]
constexpr double kScoringRange = 5;       // [m], in room and hall
constexpr std::size_t kOctomapViews = 8;  // that OctoMap's gain is timed on
constexpr std::uint64_t kSeed = 17;

// A map before a frame, and that frame.
struct World {
  std::string name;
  Sensor sensor;
  BeliefGrid before;
  DepthFrame frame;
  Pose T_world_camera;
};

World world_of(std::string name, Sensor sensor, const GridConfig& config, std::size_t frames,
               const Frames& frame_at, const ExecConfig& exec) {
  World world{std::move(name), std::move(sensor), BeliefGrid(config), {}, {}};
  FrameIntegrator integrator(world.sensor, {}, exec);
  for (std::size_t i = 0; i + 1 < frames; ++i) {
    const auto [frame, T_world_camera] = frame_at(i);
    integrator.integrate(world.before, frame, T_world_camera);
  }
  std::tie(world.frame, world.T_world_camera) = frame_at(frames - 1);
  world.sensor.max_range = std::min(world.sensor.max_range, kScoringRange);
  return world;
}

World camel(const std::string& name, const DecisionOptions& options, const ExecConfig& exec) {
  const int voxels = std::stoi(name.substr(name.find('-') + 1));
  const ModelScene model(options.mesh, 1, exec);
  const std::vector<Pose> views = sphere_poses(kViews + 1, kModelDistance);
  const BeliefGrid empty = model.empty_grid(0.4 / voxels);
  const GridConfig config{.voxel_size = empty.voxel_size(),
                          .workspace = empty.workspace(),
                          .prior_sigma = empty.prior_sigma()};
  return world_of(
      name, model.sensor(), config, views.size(),
      [&](std::size_t i) { return std::pair(model.acquire(views[i], i), views[i]); }, exec);
}

World hall(const ExecConfig& exec) {
  const Sensor sensor = sensor_preset("kinect_v1");
  const SimulatedSensor camera(std::make_shared<const SurfaceScene>(hall_mesh(), exec), sensor,
                               {.noise = true}, exec);
  return world_of(
      "hall", sensor,
      {.voxel_size = kHallVoxel,
       .workspace = kHallWorkspace,
       .prior_sigma = default_prior_sigma(kHallVoxel, sensor)},
      kHallFrames,
      [&](std::size_t i) {
        const Pose pose = hall_pose(static_cast<int>(i), kHallFrames);
        return std::pair(camera.acquire(pose, i), pose);
      },
      exec);
}

World room(const DecisionOptions& options, const ExecConfig& exec) {
  if (options.recording.empty()) {
    throw Error(ErrorCode::invalid_argument, "the map room requires --recording FOLDER");
  }
  const FrameSequence recording = open_frames(options.recording, "kinect_v1");
  Eigen::AlignedBox3d seen;
  for (const Pose& pose : recording.poses) {
    seen.extend(pose.translation()), seen.extend(pose * Eigen::Vector3d(0, 0, 3));
  }
  const Eigen::Vector3d low = seen.min().array() - 1, high = seen.max().array() + 1;
  return world_of(
      "room", recording.sensor,
      {.voxel_size = options.room_voxel,
       .workspace = {{low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}},
       .prior_sigma = default_prior_sigma(options.room_voxel, recording.sensor)},
      recording.images.size(),
      [&](std::size_t i) { return std::pair(load_frame(recording, i), recording.poses[i]); }, exec);
}

// Boundary candidates that are possible, thinned evenly or filled up to `count`.
std::vector<Pose> exactly(const std::vector<Pose>& candidates, const GridSnapshot& map,
                          std::size_t count) {
  std::vector<Pose> all = candidates, result;
  if (all.size() < count) {
    const std::vector<Pose> more = test::poses_in(map, count - all.size(), kSeed);
    all.insert(all.end(), more.begin(), more.end());
  }
  for (std::size_t i = 0; i < count; ++i) result.push_back(all[i * all.size() / count]);
  return result;
}

// Seconds by stage, of all repetitions.
using Seconds = nlohmann::ordered_map<std::string, std::vector<double>>;  // as they come

void time_once(const World& world, const DecisionOptions& options, const ExecConfig& exec,
               const std::shared_ptr<const VoxelScene>& scene_before, Seconds& seconds,
               std::size_t& boundary) {
  const auto timed = [&](const std::string& stage, auto&& call) {
    seconds[stage].push_back(seconds_of(call));
  };
  BeliefGrid grid = world.before.clone();
  FrameIntegrator integrator(world.sensor, {}, exec);
  timed("integrate", [&] { integrator.integrate(grid, world.frame, world.T_world_camera); });
  std::shared_ptr<const VoxelScene> scene;
  timed("scene", [&] { scene = VoxelScene::update(scene_before, grid, exec); });
  timed("hazard", [&] { (void)scene->hazard(); });
  SurfaceMesh surface;
  timed("surface", [&] { surface = surface_of(fused_points(grid, {}, exec), exec); });
  std::vector<Pose> possible;
  timed("candidates", [&] {
    const EstimatedViews estimated =
        estimate_views(surface, grid.views(), world.sensor, world.sensor.working_distance,
                       default_estimator(grid.voxel_size()));
    const FeasibilityChecker checker(scene, {});
    for (const BoundaryCandidate& c : estimated.candidates) {
      if (checker.check(c.T_world_camera, grid.views()) == Infeasibility::none) {
        possible.push_back(c.T_world_camera);
      }
    }
  });
  boundary = possible.size();
  std::shared_ptr<const ClassicMap> map;
  timed("classic_map", [&] { map = ClassicMap::build(scene, grid, {}, exec); });
  for (const std::size_t count : options.candidates) {
    const std::vector<Pose> poses = exactly(possible, scene->snapshot(), count);
    for (const GainModel model : {GainModel::paper, GainModel::surface, GainModel::combined}) {
      const std::string name = std::string(gain_model_name(model)) + " " + std::to_string(count);
      // The evaluator's rays are made once a session; what it knows of a scene is made here.
      const GainEvaluator made(scene_before, world.sensor, {.model = model}, exec);
      timed(name, [&] { (void)made.with_scene(scene).best(poses, 1); });
      timed(name + " two stages", [&] { (void)made.with_scene(scene).race(poses, 1); });
    }
    const ClassicGainEvaluator classic(map, world.sensor,
                                       {.gains = {ClassicGain::surface_frontier_count}}, exec);
    timed("surface_frontier_count " + std::to_string(count), [&] {
      const std::vector<double> counts = classic.evaluate(poses);
      (void)std::max_element(counts.begin(), counts.end());
    });
  }
}

// The same frame into an octree, and a view's gain by it, on one thread [s].
void time_octomap(const World& world, Seconds& seconds) {
  const oracle::DenseMap dense(world.before);
  const auto tree = octree_of(dense);
  OctomapIntegrator integrator(world.sensor, dense);
  seconds["octomap_integrate"].push_back(
      seconds_of([&] { integrator.integrate(*tree, world.frame, world.T_world_camera); }));
  const std::vector<Pose> poses = sphere_poses(kOctomapViews, kModelDistance);
  const auto methods = make_octomap_methods({world.before, dense, world.sensor, poses});
  std::vector<Ending> endings(world.sensor.camera.ray_table().size());
  seconds["octomap_gain_of_a_view"].push_back(seconds_of([&] {
                                                for (const Pose& pose : poses) {
                                                  methods.back()->trace(pose, endings);
                                                }
                                              }) /
                                              static_cast<double>(poses.size()));
}

Seconds measured(const World& world, const DecisionOptions& options, const ExecConfig& exec,
                 std::size_t& boundary) {
  const auto scene_before = VoxelScene::build(world.before, {}, exec);
  (void)scene_before->hazard();
  Seconds seconds;
  for (int repetition = -1; repetition < options.repetitions; ++repetition) {
    time_once(world, options, exec, scene_before, seconds, boundary);
    if (repetition < 0) seconds.clear();  // that was to warm up
  }
  return seconds;
}

Json report(const World& world, const Seconds& seconds, std::size_t boundary, bool json) {
  Json result{{"map", world.name},
              {"voxel", world.before.voxel_size()},
              {"rays", world.sensor.camera.ray_table().size()},
              {"boundary_candidates", boundary}};
  if (!json) {
    std::printf(
        "\n"
        "%s, voxels of %g m, %zu rays per view, %zu boundary candidates\n",
        world.name.c_str(), world.before.voxel_size(), world.sensor.camera.ray_table().size(),
        boundary);
    std::printf("%-36s %10s %10s %10s\n", "", "ms", "p05", "p95");
  }
  for (const auto& [stage, s] : seconds) {
    const double middle = 1e3 * median(s), low = 1e3 * quantile(s, 0.05),
                 high = 1e3 * quantile(s, 0.95);
    result["milliseconds"][stage] = {{"median", middle}, {"p05", low}, {"p95", high}};
    if (!json) std::printf("%-36s %10.2f %10.2f %10.2f\n", stage.c_str(), middle, low, high);
  }
  return result;
}

}  // namespace

std::vector<std::pair<std::string, double>> stage_milliseconds(const DecisionOptions& options) {
  const ExecConfig exec{ThreadPool(options.num_threads).num_threads()};
  std::size_t boundary = 0;
  std::vector<std::pair<std::string, double>> medians;
  for (auto& [stage, s] : measured(camel("camel-128", options, exec), options, exec, boundary)) {
    medians.emplace_back(stage, 1e3 * median(s));
  }
  return medians;
}

int run_decision(const DecisionOptions& options) {
  const ExecConfig exec{ThreadPool(options.num_threads).num_threads()};
  Json all = Json::array();
  if (!options.json) {
    std::printf("time from a new frame to the best pose, %d threads, %s\n", exec.num_threads,
                cpu_name().c_str());
  }
  for (const std::string& name : options.maps) {
    const World world = name == "hall"   ? hall(exec)
                        : name == "room" ? room(options, exec)
                                         : camel(name, options, exec);
    std::size_t boundary = 0;
    Seconds seconds = measured(world, options, exec, boundary);
    if (name == "camel-128") time_octomap(world, seconds);
    all.push_back(report(world, seconds, boundary, options.json));
    add_environment(all.back(), exec.num_threads);
  }
  if (options.json) std::printf("%s\n", all.dump(2).c_str());
  return 0;
}

}  // namespace viewgain::bench
