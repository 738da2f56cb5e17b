// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/reconstruct/run.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "program/cli/flags/pose_source.hpp"
#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/flags/stop_rules.hpp"
#include "program/cli/values.hpp"
#include "viewgain/formats/reach_toml.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/raycast/obstacle_view.hpp"

namespace viewgain::app {
namespace {

// A distance from the centre [m] that is outside an object of this size.
double outside(double size) { return 1.1 * 0.5 * std::sqrt(3.0) * size; }

Pose start_pose(const ReconstructOptions& options, const Stage& stage, double distance,
                const ReachRegion& reach) {
  if (options.from.empty()) {
    return default_start(stage, distance, options.sensing.seed, reach,
                         options.sensing.support_plane);
  }
  const Pose pose = parse_pose("--from", options.from);
  const std::optional<double>& plane = options.sensing.support_plane;
  if (plane && pose.translation().z() <= *plane) {
    refuse("--from " + options.from + ": the camera must be above the support plane");
  }
  if (!reach.contains(pose)) {
    refuse("--from " + options.from + ": the pose is not reachable according to " + options.reach);
  }
  return pose;
}

void check_voxel(const ReconstructOptions& options, const Stage& stage) {
  if (options.voxel < stage.size) return;
  refuse("--voxel " + short_text(options.voxel) +
         ": the voxels must be smaller than the object, whose longest side is " +
         short_text(stage.size) + " m (--size)");
}

// A mesh that is far too large is usually in millimetres.
void check_size(const RunSetup& setup) {
  constexpr double kTooLarge = 10;  // relative to the sensor's range
  if (setup.stage.size <= kTooLarge * setup.sensor.max_range) return;
  refuse("the object's longest side is " + short_text(setup.stage.size) +
         " m, but the sensor's range ends at " + short_text(setup.sensor.max_range) +
         " m. Is the mesh in millimetres? (--size)");
}

// Refuses an obstacle at the start of the run.
void check_start(const ReconstructOptions& options, const RunSetup& setup, const ExecConfig& exec) {
  if (options.obstacles.empty()) return;
  const BeliefGrid grid(setup.model.map.grid());
  // Only the obstacles, because the camera may start at the table.
  const FeasibilityChecker checker(VoxelScene::build(grid, {setup.model.map.obstacles}, exec),
                                   feasibility_of(setup.sensor));
  if (checker.check(setup.start) != Infeasibility::obstacle) return;
  const std::string which =
      options.from.empty() ? "the start pose (--from)" : "--from " + options.from;
  refuse(which + ": the camera's housing would overlap an --obstacle");
}

SurfaceModelConfig model_config(const ReconstructOptions& options, const Stage& stage) {
  SurfaceModelConfig model;
  ScorerConfig& config = model.map;
  config.voxel_size = options.voxel;
  config.workspace = stage.workspace;
  config.jump_edges = parse_jump_edge_filter(options.jump_edge_filter);
  config.obstacles = obstacles_of(options.obstacles);
  config.support_plane = options.sensing.support_plane;
  config.gain.criterion = parse_criterion(options.criterion);
  options.scales.set(config);
  const BeliefGrid empty(config.grid());
  warn_of_few_voxels(empty);
  config.hazard = hazard_source(options.hazard, empty);
  return model;
}

// The obstacles for the simulated camera.
std::shared_ptr<const SurfaceScene> surroundings_of(const Obstacles& obstacles,
                                                    const ExecConfig& exec) {
  TriangleMesh mesh = mesh_of(obstacles);
  if (mesh.triangles.empty()) return nullptr;
  return std::make_shared<const SurfaceScene>(std::move(mesh), exec);
}

std::vector<std::string> generators(const ReconstructOptions& options, Policy policy) {
  if (!options.generator.empty()) {
    const std::vector<std::string> names = names_in(options.generator);
    if (policy == Policy::kriegel && names != std::vector<std::string>{"boundary"}) {
      refuse("--policy kriegel requires --generator boundary");
    }
    return names;
  }
  if (policy == Policy::random || policy == Policy::fibonacci) return {"sphere"};
  if (!options.poses.empty()) return {};
  if (policy == Policy::sequence) return {"sequence"};
  return {"boundary"};
}

GenerationConfig generation_config(const ReconstructOptions& options, const RunSetup& setup) {
  GenerationConfig config = default_generation(setup.sensor, options.voxel);
  config.at_boundaries = false;
  // Kriegel's rule chooses by class alone.
  config.boundary.classes_by_sight = setup.policy.policy == Policy::kriegel;
  const bool spread_out = setup.policy.policy == Policy::fibonacci;
  PoseSetRequest request{setup.stage.center,   setup.distance, options.count,
                         options.sensing.seed, setup.start,    spread_out};
  if (!options.distance) request.reach = setup.reach;
  if (!options.poses.empty()) config.sets.push_back({kGivenPoses, poses_in(options.poses)});
  for (const std::string& name : generators(options, setup.policy.policy)) {
    if (name == "boundary") {
      config.at_boundaries = true;
    } else {
      request.count = options.count;
      if (spread_out && name == "sphere" && !request.count) request.count = options.max_views;
      config.sets.push_back(make_pose_set(name, request));
    }
  }
  config.feasibility.reach = setup.reach;
  return config;
}

PlanningConfig planning_config(const ReconstructOptions& options, const PolicyConfig& policy) {
  PlanningConfig config;
  config.max_views = options.max_views;
  const StopLimits stop = stop_limits(options.stop);
  config.idle_views = stop.idle;
  config.broken_promises = stop.promises;
  config.stop_coverage = stop.coverage;
  set_stop_rules(config, policy, stop.gain, stop.area);
  return config;
}

StageConfig stage_config(const ReconstructOptions& options) {
  StageConfig config{options.mesh, options.size, placement_of({}, "", options.up).up, std::nullopt,
                     options.sensing.support_plane};
  if (!options.workspace.empty()) config.workspace = parse_box("--workspace", options.workspace);
  return config;
}

// Settings that can affect the results, for run.json, as given or as derived. Excludes threads and
// output paths.
Json settings_json(const ReconstructOptions& o, const RunSetup& setup) {
  Json generators = Json::array();
  if (setup.generation.at_boundaries) generators.push_back("boundary");
  for (const PoseSet& set : setup.generation.sets) generators.push_back(set.generator);
  if (!setup.reach.poses.empty()) generators.push_back("reach");
  Json json{{"mesh", o.mesh},
            {"sensor", sensor_toml(setup.sensor)},
            {"voxel", o.voxel},
            {"size", setup.stage.size},
            {"workspace", to_json(setup.stage.workspace)},
            {"prior_sigma", default_prior_sigma(o.voxel, setup.sensor)},
            {"up", o.up},
            {"start", to_json(setup.start)},
            {"distance", setup.distance},
            {"policy", o.policy},
            {"generators", generators},
            {"sphere_poses", o.count},
            {"gain", setup.policy.registered.empty() ? gain_model_name(setup.policy.model)
                                                     : std::string_view(setup.policy.registered)},
            {"hazard", or_null(o.hazard)},
            {"criterion", o.criterion},
            {"max_views", o.max_views},
            {"stop_gain", setup.planning.stop_gain},
            {"stop_gain_is_relative", setup.planning.stop_gain_is_relative},
            {"stop_area", setup.planning.stop_area},
            {"stop_idle", setup.planning.idle_views},
            {"stop_promises", setup.planning.broken_promises},
            {"stop_coverage", setup.planning.stop_coverage},
            {"tolerance", o.coverage_tolerance()},
            {"cost_per_metre", o.cost_per_metre},
            {"reach", or_null(o.reach)},
            {"support_plane", o.sensing.support_plane},
            {"noise", setup.noise.readings ? "on" : "off"},
            {"flying_pixels", setup.noise.has_flying_pixels(setup.sensor)},
            {"background", o.sensing.background},
            {"scale_error", setup.noise.scale_error},
            {"pose_noise", pose_sigma_json(setup.noise.pose)},
            {"register", setup.registration.has_value()},
            {"pose_sigma", setup.registration ? pose_sigma_json(*setup.registration) : Json()},
            {"frames_per_view", o.frames_per_view},
            {"jump_edge_filter", o.jump_edge_filter}};
  if (!o.obstacles.empty()) json["obstacles"] = o.obstacles;
  if (!o.poses.empty()) json["poses"] = o.poses;
  json.update(o.scales.settings());
  if (const PlanAhead& ahead = setup.policy.ahead; ahead.is_on()) {
    json.update(Json{{"plan", ahead.plan}, {"take", ahead.take}});
  }
  return json;
}

PolicyConfig with_object(PolicyConfig policy, const RunSetup& setup,
                         const std::shared_ptr<const Truth>& truth) {
  policy.object = {setup.stage.scene, truth, setup.simulation};
  return policy;
}

}  // namespace

PolicyConfig policy_config(const ReconstructOptions& options) {
  PolicyConfig policy;
  policy.policy = parse_policy(options.policy);
  policy.criterion = parse_criterion(options.criterion);
  policy.cost_per_metre = options.cost_per_metre;
  policy.ahead = parse_plan(options.plan);
  if (const auto area = stop_limits(options.stop).area; area.value_or(0) > 0) {
    policy.ahead.least_share = *area;
  }
  policy.seed = options.sensing.seed;
  if (options.gain.empty()) return policy;
  if (is_registered_gain(options.gain)) {
    policy.registered = options.gain;
  } else {
    policy.model = parse_gain_model(options.gain);
  }
  return policy;
}

RunSetup set_up(const ReconstructOptions& options, const ExecConfig& exec) {
  check(options);
  RunSetup setup;
  setup.sensor = load_sensor(options.sensor);
  if (!options.body.empty()) setup.sensor.body_size = parse_size("--body", options.body);
  setup.sensor.validate();
  setup.policy = policy_config(options);
  if (!options.reach.empty()) setup.reach = read_reach_toml(options.reach);
  setup.stage = set_stage(stage_config(options), exec);
  warn_of_repairs(options.mesh, setup.stage.repairs);
  check_voxel(options, setup.stage);
  check_size(setup);
  setup.distance =
      options.distance.value_or(filling_distance(setup.sensor, 0.5 * setup.stage.size));
  setup.start = start_pose(options, setup.stage, setup.distance, setup.reach);
  setup.visibility = {setup.stage.center,
                      std::max(setup.sensor.working_distance, outside(setup.stage.size)),
                      setup.start,
                      setup.reach,
                      options.sensing.support_plane,
                      nullptr,
                      options.coverage_tolerance()};
  setup.noise = parse_noise(options.sensing.noise, true);
  setup.simulation = simulation_config(options.sensing, setup.noise, setup.sensor);
  setup.registration = registration_sigma(options.registration, setup.noise.pose);
  setup.model = model_config(options, setup.stage);
  check_start(options, setup, exec);
  setup.visibility.surroundings = setup.simulation.surroundings =
      surroundings_of(setup.model.map.obstacles, exec);
  setup.generation = generation_config(options, setup);
  setup.planning = planning_config(options, setup.policy);
  setup.settings = settings_json(options, setup);
  return setup;
}

RunParts::RunParts(RunSetup from, std::size_t frames_per_view, const ExecConfig& exec)
    : setup(std::move(from)),
      truth(std::make_shared<const Truth>(setup.stage.scene, setup.sensor, setup.visibility, exec)),
      camera(SimulatedSensor(setup.stage.scene, setup.sensor, setup.simulation, exec),
             frames_per_view, setup.planning.stop),
      acquisition(camera, setup.noise.pose, setup.simulation.seed),
      model(setup.sensor, setup.model, truth, exec),
      generation(model, setup.generation, exec),
      decision(model, generation, setup.sensor, with_object(setup.policy, setup, truth), exec) {
  if (setup.registration) registered.emplace(model, *setup.registration, exec);
}

}  // namespace viewgain::app
