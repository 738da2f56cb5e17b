// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Core>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "candidate_generation.hpp"
#include "commands.hpp"
#include "interrupt.hpp"
#include "model.hpp"
#include "planning_options.hpp"
#include "policies.hpp"
#include "reach_toml.hpp"
#include "run_folder.hpp"
#include "run_report.hpp"
#include "sensing.hpp"
#include "sensing_flags.hpp"
#include "sensor_toml.hpp"
#include "simulated_acquisition.hpp"
#include "stage.hpp"
#include "terminal.hpp"
#include "truth.hpp"
#include "values.hpp"
#include "view_picture.hpp"
#include "viewgain/core/atomic_file.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/mesh/mesh_io.hpp"
#include "viewgain/mesh/surface_io.hpp"

namespace viewgain::app {
namespace {

struct Options {
  CommonOptions common;
  std::string mesh;
  std::string sensor;
  double voxel = 0;
  double size = 0.35;
  std::string workspace;
  std::string start;
  std::optional<double> distance;
  std::string policy = "gain";
  std::string generator;
  std::optional<std::size_t> sphere_poses;
  std::string criterion = "log_diagonal";
  std::size_t max_views = 20;
  std::optional<double> stop_gain;
  std::size_t stop_idle = 3;
  std::optional<double> stop_coverage;
  double travel_cost = 0;
  std::optional<double> travel_speed;
  std::string reach;
  std::string up = "z";
  SensingOptions sensing;
  std::size_t frames_per_view = 1;
  std::string jump_edge_filter = "5";
  bool no_refine = false;
  bool save_maps = false;
  bool no_pictures = false;
  std::string out;
};

// A distance [m] from the centre at which nothing of an object of this size is.
double outside(double size) { return 1.1 * 0.5 * std::sqrt(3.0) * size; }

Pose given_start(const Options& options, const ReachRegion& reach) {
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

ModelConfig model_config(const Options& options, const Sensor& sensor, const Stage& stage) {
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

std::vector<std::string> generators(const Options& options, Policy policy) {
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

GenerationConfig generation_config(const Options& options, const Sensor& sensor, const Stage& stage,
                                   Policy policy, double distance, const Pose& start,
                                   const ReachRegion& reach) {
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

PlanningConfig planning_config(const Options& options) {
  PlanningConfig config;
  config.max_views = options.max_views;
  config.idle_views = options.stop_idle;
  config.stop_coverage = options.stop_coverage;
  config.stop_gain_is_relative = options.criterion == "trace" && !options.stop_gain;
  config.stop_gain = options.stop_gain.value_or(config.stop_gain_is_relative ? 0.01 : 0.15);
  return config;
}

nlohmann::ordered_json optional_json(const auto& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}

// What can change the answer; not threads, not where it goes.
nlohmann::ordered_json settings_json(const Options& o, const Sensor& sensor, const Stage& stage,
                                     const ModelConfig& model, const PlanningConfig& planning,
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

void reconstruct(const Options& options) {
  const ExecConfig exec{options.common.threads};
  if (!(options.voxel > 0) || !std::isfinite(options.voxel)) {
    throw Error(ErrorCode::invalid_argument,
                "--voxel " + short_text(options.voxel) + " must be positive and finite");
  }
  const double travel[] = {options.travel_cost, options.travel_speed.value_or(1.0)};
  if (!(travel[0] >= 0 && std::isfinite(travel[0]) && travel[1] > 0 && std::isfinite(travel[1]))) {
    throw Error(ErrorCode::invalid_argument,
                "--travel-cost must be at least 0 and --travel-speed positive, both finite");
  }
  if (options.distance && !(*options.distance > 0 && std::isfinite(*options.distance))) {
    throw Error(ErrorCode::invalid_argument,
                "--distance " + short_text(*options.distance) + " must be positive and finite");
  }
  if (options.sensing.support_plane && !std::isfinite(*options.sensing.support_plane)) {
    throw Error(ErrorCode::invalid_argument, "--support-plane must be finite");
  }
  if (options.stop_coverage && !(*options.stop_coverage >= 0 && *options.stop_coverage <= 1)) {
    throw Error(ErrorCode::invalid_argument,
                "--stop-coverage " + short_text(*options.stop_coverage) + " must be in 0..1");
  }
  if (options.frames_per_view < 1) {
    throw Error(ErrorCode::invalid_argument, "--frames-per-view must be at least 1");
  }
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
                       reach, options.sensing.support_plane},
      exec);
  seconds["quality"] = truth_watch.seconds();
  SimulatedAcquisition acquisition(
      SimulatedSensor(stage.scene, sensor, simulation_config(options.sensing, sensor), exec),
      options.frames_per_view, seconds["acquire"]);
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
  const InterruptGuard interrupt;
  planning.stop = interrupt.token();
  const PlanningResult result = active_view_planning(
      start, acquisition, model, generation, decision, planning, [&](const ViewRecord& record) {
        folder.begin();
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
  write_file_atomically(folder.file("run.json"), run.dump(2) + "\n");
  folder.keep();
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
  auto options = std::make_shared<Options>();
  CLI::App* app = program.add_subcommand(
      "reconstruct",
      "The whole loop on a mesh: acquire with a simulated camera, update map and surface, propose "
      "views, rank them, move, until little is left to gain.");
  Options& o = *options;
  o.sensing.noise = "on";
  app->add_option("MESH", o.mesh, "OFF, OBJ, STL or PLY; scaled and centred")->required();
  app->add_option("--sensor", o.sensor, kSensorHelp)->required();
  app->add_option("--voxel", o.voxel, "voxel size [m]")->required();
  app->add_option("--size", o.size, "longest side of the object [m]")->capture_default_str();
  app->add_option("--workspace", o.workspace,
                  "x0,y0,z0,x1,y1,z1 [m]; default: a cube of size * 0.4/0.35 around the object");
  app->add_option("--up", o.up, "axis of the mesh file that points up")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->capture_default_str();
  app->add_option("--start", o.start,
                  "first camera pose tx,ty,tz,qx,qy,qz,qw [m]; default: 27 deg "
                  "above the object at an azimuth that depends on the seed");
  app->add_option("--distance", o.distance,
                  "of the start and of poses round the object from its centre [m]; default: the "
                  "object fills the view, at least the sensor's working distance");
  app->add_option("--policy", o.policy,
                  "gain, kriegel (left, right, top, bottom), sequence (turntable of 8, then top), "
                  "random, frontier (most unknown voxels in view)")
      ->capture_default_str();
  app->add_option("--generator", o.generator,
                  "where candidates come from: boundary, sphere, dome, rings, shell, sequence, or "
                  "several with commas; default: boundary (random: sphere, sequence: sequence)");
  app->add_option("--sphere-poses", o.sphere_poses,
                  "poses of the sphere, dome or shell (default 500); rings: 48, 80, 288 or 864 "
                  "(default 48)");
  app->add_option("--criterion", o.criterion, "log_diagonal, log_determinant [nat] or trace [m^2]")
      ->capture_default_str();
  app->add_option("--max-views", o.max_views, "view budget")->capture_default_str();
  app->add_option("--stop-gain", o.stop_gain,
                  "stop when the best view gains less per touched voxel [nat, m^2]; default: 0.15 "
                  "(trace: 0.01 of the first view's)");
  app->add_option("--stop-idle", o.stop_idle,
                  "stop after so many views in a row that change entropy and unknown voxels by "
                  "less than 0.1 %; 0: never")
      ->capture_default_str();
  app->add_option("--stop-coverage", o.stop_coverage,
                  "stop at this coverage of the visible surface, 0..1");
  app->add_option("--travel-cost", o.travel_cost, "rank by gain - L * distance [nat/m]")
      ->capture_default_str();
  app->add_option("--travel-speed", o.travel_speed,
                  "rank by gain / (1 s + distance / speed) instead [m/s]");
  app->add_option("--reach", o.reach, "TOML file: boxes, shells, half-spaces, poses in reach");
  add_sensing_options(*app, o.sensing);
  app->add_option("--frames-per-view", o.frames_per_view, "frames from each pose")
      ->capture_default_str();
  app->add_option("--jump-edge-filter", o.jump_edge_filter, "angle of the filter [deg], or off")
      ->capture_default_str();
  app->add_flag("--no-refine", o.no_refine, "the first reading of a voxel wins");
  app->add_flag("--save-maps", o.save_maps, "keep maps/NN.vdb after each view");
  app->add_flag("--no-pictures", o.no_pictures, "do not draw views/NN.png");
  app->add_option("--out", o.out, "folder to write")->required();
  add_common_options(*app, o.common);
  return {app, [options] { reconstruct(*options); }};
}

}  // namespace viewgain::app
