// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "picture.hpp"
#include "pose_source.hpp"
#include "sensor_toml.hpp"
#include "terminal.hpp"
#include "values.hpp"
#include "viewgain/core/atomic_file.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::app {
namespace {

struct Options {
  CommonOptions common;
  std::string map;
  PoseOptions poses;
  std::string sensor;
  std::string criterion = "log_diagonal";
  int stride = 1;
  std::vector<std::string> weights;
  std::optional<double> prior_sigma, min_range, max_range;
  std::size_t top = 10;
  std::string out;
  std::string picture;
};

GainConfig gain_config(const Options& options) {
  GainConfig config;
  config.criterion = parse_criterion(options.criterion);
  config.pixel_stride = options.stride;
  config.prior_sigma = options.prior_sigma;
  config.min_range = options.min_range;
  config.max_range = options.max_range;
  for (const std::string& text : options.weights) {
    const std::vector<double> numbers = parse_numbers("--weight", text, 7, 7);
    config.weights.push_back({box_of("--weight", numbers), numbers[6]});
  }
  return config;
}

std::string csv_of(const std::vector<ViewGain>& results) {
  std::string csv =
      "index,gain,exploration,refinement,posterior_entropy,rays,hits,unknown_voxels,"
      "occupied_voxels,status\n";
  for (std::size_t i = 0; i < results.size(); ++i) {
    const ViewGain& r = results[i];
    csv += std::to_string(i);
    for (const double value : {r.gain, r.exploration, r.refinement, r.posterior_entropy}) {
      csv += ',' + exact_text(value);
    }
    for (const std::uint32_t value : {r.rays, r.hits, r.unknown_voxels, r.occupied_voxels}) {
      csv += ',' + std::to_string(value);
    }
    csv += ',';
    csv += view_status_name(r.status);
    csv += '\n';
  }
  return csv;
}

nlohmann::ordered_json entry_of(std::size_t index, const ViewGain& r, const Pose& pose) {
  return {{"index", index},
          {"gain", r.gain},  // a NaN becomes null
          {"exploration", r.exploration},
          {"refinement", r.refinement},
          {"posterior_entropy", r.posterior_entropy},
          {"rays", r.rays},
          {"hits", r.hits},
          {"unknown_voxels", r.unknown_voxels},
          {"occupied_voxels", r.occupied_voxels},
          {"status", view_status_name(r.status)},
          {"T_world_camera", to_json(pose)}};
}

// What was asked and what came out, for the two ways of printing.
struct Report {
  const Options& options;
  const BeliefGrid& grid;
  const Sensor& sensor;
  const PoseSource& source;
  const GainEvaluator& evaluator;
  const std::vector<ViewGain>& results;
  std::vector<std::size_t> best;
  double seconds = 0;

  [[nodiscard]] double poses_per_second() const {
    return static_cast<double>(results.size()) / seconds;
  }
  [[nodiscard]] double rays_per_second() const {
    return poses_per_second() * static_cast<double>(evaluator.rays_per_pose());
  }
};

void print_json_report(const Report& report) {
  nlohmann::ordered_json json{{"poses", report.results.size()},
                              {"rays_per_pose", report.evaluator.rays_per_pose()},
                              {"threads", report.evaluator.num_threads()},
                              {"isa", report.evaluator.scene().isa()},
                              {"voxel_size", report.grid.voxel_size()},
                              {"voxels", report.grid.voxel_count()},
                              {"sensor", report.sensor.name},
                              {"criterion", report.options.criterion},
                              {"prior_sigma", report.evaluator.prior_sigma()},
                              {"orthonormalized_poses", report.source.orthonormalized},
                              {"seconds", report.seconds},
                              {"poses_per_second", report.poses_per_second()},
                              {"rays_per_second", report.rays_per_second()},
                              {"best", nlohmann::ordered_json::array()}};
  for (const std::size_t i : report.best) {
    json["best"].push_back(entry_of(i, report.results[i], report.source.poses[i]));
  }
  print_json(json);
}

void print_table(const Report& report) {
  const bool metres = report.options.criterion == "trace";
  std::printf("%s, sensor %s, prior sigma %.4g m, gains in %s\n", report.options.criterion.c_str(),
              report.sensor.name.c_str(), report.evaluator.prior_sigma(), metres ? "m^2" : "nat");
  if (report.source.orthonormalized > 0) {
    std::printf("rotations that were off and were orthonormalised: %zu of %zu\n",
                report.source.orthonormalized, report.source.poses.size());
  }
  std::printf("%4s %8s %12s %12s %12s %8s %9s %9s  %-26s %s\n", "rank", "index", "gain",
              "exploration", "refinement", "hits", "unknown", "occupied", "eye x y z [m]",
              "status");
  for (std::size_t rank = 0; rank < report.best.size(); ++rank) {
    const std::size_t i = report.best[rank];
    const ViewGain& r = report.results[i];
    const Eigen::Vector3d eye = report.source.poses[i].translation();
    std::array<char, 80> position{};
    std::snprintf(position.data(), position.size(), "%8.3f %8.3f %8.3f", eye.x(), eye.y(), eye.z());
    std::printf("%4zu %8zu %12.6g %12.6g %12.6g %8u %9u %9u  %-26s %s\n", rank + 1, i, r.gain,
                r.exploration, r.refinement, r.hits, r.unknown_voxels, r.occupied_voxels,
                position.data(), std::string(view_status_name(r.status)).c_str());
  }
  const int threads = report.evaluator.num_threads();
  std::printf(
      "%s poses in %.3f s: %.0f poses/s, %s rays/s, %s rays per pose, %s voxels, %d %s, %s\n",
      with_commas(report.results.size()).c_str(), report.seconds, report.poses_per_second(),
      with_unit(report.rays_per_second()).c_str(),
      with_commas(report.evaluator.rays_per_pose()).c_str(),
      with_commas(report.grid.voxel_count()).c_str(), threads, threads == 1 ? "thread" : "threads",
      std::string(report.evaluator.scene().isa()).c_str());
}

void score(const Options& options) {
  const ExecConfig exec{options.common.threads};
  const GainConfig config = gain_config(options);
  const Sensor sensor = load_sensor(options.sensor);
  const PoseSource source = make_poses(options.poses);
  for (const std::string& path : {options.out, options.picture}) {
    if (path.empty()) continue;
    for (const std::string& input : {options.map, options.poses.file}) {
      std::error_code error;
      if (!input.empty() && std::filesystem::equivalent(path, input, error)) {
        throw Error(ErrorCode::invalid_argument, path + ": is an input of this command");
      }
    }
    const AtomicFile writable(path);  // known now rather than after the work
  }
  const BeliefGrid grid = load_vdb(options.map);
  const GainEvaluator evaluator(VoxelScene::build(grid, {}, exec), sensor, config, exec);

  std::vector<ViewGain> results(source.poses.size());
  double seconds = 0;
  {
    Progress progress("scoring pose");
    BatchControl control;
    control.progress = [&progress](std::size_t done, std::size_t total) {
      progress.update(done, total);
    };
    const Stopwatch watch;
    evaluator.evaluate(source.poses, results, control);
    seconds = watch.seconds();
  }
  const Report report{
      options, grid, sensor, source, evaluator, results, best_indices(results, options.top),
      seconds};
  if (!options.picture.empty()) {
    const std::size_t winner = best_indices(results, 1).at(0);
    write_picture(options.picture, evaluator, sensor, source.poses[winner], exec);
  }
  if (!options.out.empty()) write_file_atomically(options.out, csv_of(results));
  if (options.common.json) {
    print_json_report(report);
  } else {
    print_table(report);
  }
}

}  // namespace

Command add_score(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* app = program.add_subcommand(
      "score",
      "Candidate poses by expected information gain against a map: the best ones, and how "
      "fast it went.");
  app->add_option("MAP", options->map, "map (.vdb)")->required();
  auto* poses = app->add_option_group("candidates", "exactly one of");
  poses->add_option("--poses", options->poses.file,
                    "TUM file of camera-to-world poses: time tx ty tz qx qy qz qw [s, m]");
  poses->add_option(
      "--sphere", options->poses.sphere,
      "N,RADIUS[,CX,CY,CZ]: Fibonacci lattice on a sphere, looking at its centre [m]");
  poses->add_option("--dome", options->poses.dome,
                    "N,RADIUS[,CX,CY,CZ]: the lattice's upper half, with N points [m]");
  poses->add_option("--rings", options->poses.rings,
                    "N,RADIUS[,CX,CY,CZ]: cylinder and dome rings of the literature, N is 48, 80, "
                    "288 or 864 [m]");
  poses->add_option("--shell", options->poses.shell,
                    "N,RMIN,RMAX,SEED[,CX,CY,CZ]: at random between two spheres, looking at their "
                    "centre [m]");
  poses->require_option(1);
  app->add_option("--sensor", options->sensor, kSensorHelp)->required();
  app->add_option("--criterion", options->criterion,
                  "log_diagonal (the paper's), log_determinant [nat] or trace [m^2]")
      ->capture_default_str();
  app->add_option("--stride", options->stride, "every s-th pixel of every s-th row")
      ->capture_default_str();
  app->add_option(
         "--weight", options->weights,
         "x0,y0,z0,x1,y1,z1,W: task weight W >= 0 of a box in the grid's frame [m]; may be "
         "repeated, the last box that holds a voxel counts, 1 outside")
      ->allow_extra_args(false);
  app->add_option("--prior-sigma", options->prior_sigma,
                  "sigma of an unknown voxel [m]; default: the map's");
  app->add_option("--min-range", options->min_range, "along the ray [m]; default: the sensor's");
  app->add_option("--max-range", options->max_range, "along the ray [m]; default: the sensor's");
  app->add_option("--top", options->top, "how many of the best to print")
      ->check(CLI::Range(std::size_t{0}, std::size_t{1'000'000'000}, "count"))
      ->capture_default_str();
  app->add_option("--out", options->out, "CSV file of all poses, in input order");
  app->add_option("--picture", options->picture,
                  "PNG file: the map, the best view's frustum and the voxels where its rays end");
  add_common_options(*app, options->common);
  return {app, [options] { score(*options); }};
}

}  // namespace viewgain::app
