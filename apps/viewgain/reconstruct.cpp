// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "formats/reach_toml.hpp"
#include "formats/run_folder.hpp"
#include "formats/sensor_toml.hpp"
#include "formats/values.hpp"
#include "interrupt.hpp"
#include "pictures/view_picture.hpp"
#include "planner/candidate_generation.hpp"
#include "planner/model.hpp"
#include "planner/planning_options.hpp"
#include "planner/policies.hpp"
#include "planner/sensing.hpp"
#include "planner/simulated_acquisition.hpp"
#include "planner/stage.hpp"
#include "planner/stopwatch.hpp"
#include "planner/truth.hpp"
#include "reconstruct_options.hpp"
#include "run_report.hpp"
#include "viewgain/core/atomic_file.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/mesh/mesh_io.hpp"
#include "viewgain/mesh/surface_io.hpp"
#include "viewgain/version.hpp"

namespace viewgain::app {
namespace {

// About what is left when the information of a touched voxel cannot be doubled any more
// (3/2 ln 2 = 1.04 nat). DESIGN.md's 0.15 nat never came on the camel: each view meets voxels of
// the noise shell, and unknown ones behind it, for the first time.
constexpr double kStopGain = 1.2;  // [nat]

// A distance [m] from the centre at which nothing of an object of this size is.
double outside(double size) { return 1.1 * 0.5 * std::sqrt(3.0) * size; }

Pose given_start(const ReconstructOptions& options, const ReachRegion& reach) {
  const Pose pose = parse_pose("--start", options.start);
  const std::optional<double>& plane = options.sensing.support_plane;
  if (plane && pose.translation().z() <= *plane) {
    throw Error(ErrorCode::invalid_argument,
                "--start " + options.start + ": is not above the support plane");
  }
  if (!reach.contains(pose)) {
    throw Error(
        ErrorCode::invalid_argument,
        "--start " + options.start + ": lies outside the reachable region of " + options.reach);
  }
  return pose;
}

ModelConfig model_config(const ReconstructOptions& options, const Sensor& sensor,
                         const Stage& stage) {
  ModelConfig config;
  config.grid.voxel_size = options.voxel;
  config.grid.workspace = stage.workspace;
  config.grid.prior_sigma = default_prior_sigma(options.voxel, sensor);
  config.integration.support_plane = options.sensing.support_plane;
  config.jump_edges = parse_jump_edge_filter(options.jump_edge_filter, false);
  config.criterion = parse_criterion(options.criterion);
  config.refine = !options.no_refine;
  return config;
}

std::vector<std::string> generators(const ReconstructOptions& options, Policy policy) {
  if (!options.generator.empty()) {
    const auto names = parse_names("--generator", options.generator, generator_names());
    if (policy == Policy::kriegel && names != std::vector<std::string>{"boundary"}) {
      throw Error(ErrorCode::invalid_argument,
                  "--policy kriegel chooses among boundary candidates alone");
    }
    return names;
  }
  if (policy == Policy::random) return {"sphere"};
  if (policy == Policy::sequence) return {"sequence"};
  return {"boundary"};
}

GenerationConfig generation_config(const ReconstructOptions& options, const Sensor& sensor,
                                   const Stage& stage, Policy policy, double distance,
                                   const Pose& start, const ReachRegion& reach) {
  GenerationConfig config;
  config.boundary = false;
  config.estimator = default_estimator(options.voxel);
  config.working_distance = sensor.working_distance;
  PoseSetRequest request{stage.center, distance, options.sphere_poses, options.sensing.seed, start};
  for (const std::string& name : generators(options, policy)) {
    if (name == "boundary") {
      config.boundary = true;
    } else {
      config.sets.push_back(make_pose_set(name, request));
    }
  }
  // A list of poses is all that the robot can do: they are candidates themselves.
  if (!reach.poses.empty()) config.sets.push_back({"reach", reach.poses});
  config.feasibility.body.T_flange_camera = sensor.T_flange_camera;
  config.feasibility.reach = reach;
  config.feasibility.support_plane = options.sensing.support_plane;
  config.feasibility.sensor = sensor;
  return config;
}

PlanningConfig planning_config(const ReconstructOptions& options) {
  PlanningConfig config;
  config.max_views = options.max_views;
  config.idle_views = options.stop_idle;
  config.stop_coverage = options.stop_coverage;
  config.stop_gain_is_relative = options.criterion == "trace" && !options.stop_gain;
  config.stop_gain = options.stop_gain.value_or(config.stop_gain_is_relative ? 0.01 : kStopGain);
  return config;
}

nlohmann::ordered_json optional_json(const auto& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}

// What can change the answer; not threads, not where it goes.
nlohmann::ordered_json settings_json(const ReconstructOptions& o, const Sensor& sensor,
                                     const Stage& stage, const ModelConfig& model,
                                     const PlanningConfig& planning,
                                     const GenerationConfig& generation, double distance,
                                     const Pose& start) {
  nlohmann::ordered_json generators = nlohmann::ordered_json::array();
  if (generation.boundary) generators.push_back("boundary");
  for (const PoseSet& set : generation.sets) generators.push_back(set.generator);
  return {{"mesh", o.mesh},
          {"sensor", sensor_toml(sensor)},
          {"voxel", o.voxel},
          {"size", o.size},
          {"workspace", to_json(stage.workspace)},
          {"prior_sigma", model.grid.prior_sigma},
          {"up", o.up},
          {"start", to_json(start)},
          {"distance", distance},
          {"policy", o.policy},
          {"generators", generators},
          {"sphere_poses", optional_json(o.sphere_poses)},
          {"criterion", o.criterion},
          {"max_views", o.max_views},
          {"stop_gain", planning.stop_gain},
          {"stop_gain_is_relative", planning.stop_gain_is_relative},
          {"stop_idle", o.stop_idle},
          {"stop_coverage", optional_json(o.stop_coverage)},
          {"travel_cost", o.travel_cost},
          {"travel_speed", optional_json(o.travel_speed)},
          {"reach", o.reach.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(o.reach)},
          {"support_plane", optional_json(o.sensing.support_plane)},
          {"noise", o.sensing.noise},
          {"flying_pixels", o.sensing.has_flying_pixels(sensor)},
          {"background", o.sensing.background},
          {"wiggling", o.sensing.wiggling},
          {"calibrated", o.sensing.calibrate == "on"},
          {"frames_per_view", o.frames_per_view},
          {"jump_edge_filter", o.jump_edge_filter},
          {"refine", !o.no_refine}};
}

std::vector<float> sigmas_along(const std::vector<std::array<double, 3>>& normals,
                                const std::vector<SymmetricMatrix3>& covariances) {
  std::vector<float> sigmas;
  sigmas.reserve(normals.size());
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Eigen::Vector3d n(normals[i][0], normals[i][1], normals[i][2]);
    sigmas.push_back(static_cast<float>(std::sqrt(n.dot(covariances[i] * n))));
  }
  return sigmas;
}

void write_surfaces(const Model& model, const RunFolder& folder) {
  std::vector<std::array<double, 3>> positions, normals;
  std::vector<SymmetricMatrix3> covariances, of_vertices;
  for (const FusedPoint& point : model.points()) {
    positions.push_back(point.position);
    normals.push_back(point.toward_free);
    covariances.push_back(point.covariance);
  }
  const SurfaceMesh& surface = model.surface();
  for (const std::uint32_t i : surface.source) of_vertices.push_back(covariances[i]);
  write_surface_ply(folder.file("surface.ply"), surface,
                    sigmas_along(surface.normals, of_vertices));
  write_points_ply(folder.file("points.ply"), positions, normals,
                   sigmas_along(normals, covariances));
}

void draw(const RunFolder& folder, const ViewRecord& record, const DepthFrame& frame,
          const Model& model, const CandidateGeneration& generation, const Sensor& sensor,
          const ExecConfig& exec) {
  const GainEvaluator evaluator(model.scene(), sensor, {}, exec);
  const std::vector<Candidate>& candidates = record.proposal.candidates;
  ViewPicture picture{model.surface(), generation.estimated(),
                      candidates,      record.T_world_camera,
                      std::nullopt,    evaluator,
                      sensor};
  if (record.decision) picture.chosen = candidates[record.decision->candidate].T_world_camera;
  write_view_picture(folder.view(record.index, ".png"), picture, exec);
  if (!frame.amplitude.empty()) {
    write_amplitude_picture(folder.view(record.index, ".amplitude.png"), frame);
  }
}

void reconstruct(const ReconstructOptions& options) {
  const ExecConfig exec{options.common.threads};
  check(options);
  const Sensor sensor = load_sensor(options.sensor);
  sensor.validate();
  const Policy policy = parse_policy(options.policy);
  const ReachRegion reach = options.reach.empty() ? ReachRegion{} : read_reach_toml(options.reach);
  const Stage stage = set_stage(
      {options.mesh, options.size,
       options.up == "x"   ? UpAxis::x
       : options.up == "y" ? UpAxis::y
                           : UpAxis::z,
       options.workspace.empty() ? std::nullopt
                                 : std::optional(parse_box("--workspace", options.workspace)),
       options.sensing.support_plane},
      exec);
  const double distance = options.distance.value_or(filling_distance(sensor, 0.5 * options.size));
  const Pose start = options.start.empty() ? default_start(stage, distance, options.sensing.seed,
                                                           reach, options.sensing.support_plane)
                                           : given_start(options, reach);
  const ModelConfig model_settings = model_config(options, sensor, stage);
  const GenerationConfig generation_settings =
      generation_config(options, sensor, stage, policy, distance, start, reach);
  PlanningConfig planning = planning_config(options);

  StageSeconds seconds;
  const Stopwatch truth_watch;
  const auto truth = std::make_shared<const Truth>(
      stage.scene, sensor,
      VisibilityConfig{stage.center, std::max(sensor.working_distance, outside(options.size)),
                       start, reach, options.sensing.support_plane},
      exec);
  seconds["quality"] = truth_watch.seconds();
  const InterruptGuard interrupt;
  planning.stop = interrupt.token();
  SimulatedAcquisition acquisition(
      SimulatedSensor(stage.scene, sensor, simulation_config(options.sensing, sensor), exec),
      options.frames_per_view, planning.stop, seconds["acquire"]);
  Model model(sensor, model_settings, exec, truth, seconds);
  CandidateGeneration generation(model, sensor, generation_settings, exec, seconds);
  PolicyDecision decision(model, generation, sensor,
                          {policy,
                           model_settings.criterion,
                           {options.travel_cost, options.travel_speed, 1.0},
                           options.sensing.seed},
                          exec, seconds);

  RunFolder folder(options.out);
  RunReport report;
  std::vector<Pose> views;
  const PlanningResult result = active_view_planning(
      start, acquisition, model, generation, decision, planning, [&](const ViewRecord& record) {
        views.push_back(record.T_world_camera);
        if (options.save_maps) save_vdb(model.grid(), folder.map(record.index));
        if (!options.no_pictures) {
          const Stopwatch watch;
          draw(folder, record, acquisition.last_frame(), model, generation, sensor, exec);
          seconds["pictures"] += watch.seconds();
        }
        report.add_view(record, model.quality().back(), seconds);
        std::fprintf(stderr, "%s\n", report.progress_line().c_str());
      });

  save_vdb(model.grid(), folder.file("map.vdb"));
  write_surfaces(model, folder);
  write_tum(folder.file("views.txt"), views);
  const nlohmann::ordered_json json = report.json(result.reason);
  nlohmann::ordered_json run{
      {"settings", settings_json(options, sensor, stage, model_settings, planning,
                                 generation_settings, distance, start)},
      {"versions", {{"viewgain", VIEWGAIN_VERSION}, {"compiler", __VERSION__}}},
      {"seed", options.sensing.seed},
      {"map_hash", model.grid().content_hash()}};
  run.update(json);
  write_file_atomically(folder.file("run.json"), json_text(run));
  folder.commit();
  if (options.common.json) {
    print_json(json);
  } else {
    std::printf("%s", report.text(result.reason).c_str());
    std::printf("left in %s: run.json, views.txt, map.vdb, surface.ply, points.ply%s\n",
                options.out.c_str(), options.no_pictures ? "" : ", views/");
  }
}

}  // namespace

Command add_reconstruct(CLI::App& program) {
  auto options = std::make_shared<ReconstructOptions>();
  CLI::App* app = program.add_subcommand(
      "reconstruct",
      "The whole loop on a mesh: acquire with a simulated camera, update map and surface, propose "
      "views, rank them, move, until little is left to gain.");
  add_options(*app, *options);
  return {app, [options] { reconstruct(*options); }};
}

}  // namespace viewgain::app
