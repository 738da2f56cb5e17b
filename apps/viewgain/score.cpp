// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "formats/map_file.hpp"
#include "formats/pose_source.hpp"
#include "formats/sensor_toml.hpp"
#include "formats/values.hpp"
#include "pictures/picture.hpp"
#include "planner/stopwatch.hpp"
#include "progress.hpp"
#include "viewgain/core/atomic_file.hpp"
#include "viewgain/core/error.hpp"
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
  bool race = false;
  std::optional<double> approximate;  // share of the tiles
  std::optional<std::size_t> set;     // how many
  std::uint64_t seed = 1;
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

// What one way of scoring came to.
struct Scores {
  std::vector<std::size_t> indices;        // of the poses scored in full, in input order
  std::vector<ViewGain> results;           // of those
  std::vector<ApproximateGain> estimates;  // of all poses, or none
  std::vector<std::size_t> best;           // into the poses, best first
  std::vector<ViewGain> best_results;      // of those; marginal for a set; none of estimates
  std::uint64_t rays_traced = 0;
  double set_gain = 0;
};

std::string csv_of(const std::vector<ApproximateGain>& estimates) {
  std::string csv = "index,gain,standard_error\n";
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    csv += std::to_string(i) + ',' + exact_text(estimates[i].gain) + ',' +
           exact_text(estimates[i].standard_error) + '\n';
  }
  return csv;
}

std::string csv_of(const Scores& scores) {
  if (!scores.estimates.empty()) return csv_of(scores.estimates);
  std::string csv =
      "index,gain,exploration,refinement,posterior_entropy,rays,hits,unknown_voxels,"
      "occupied_voxels,status\n";
  for (std::size_t i = 0; i < scores.results.size(); ++i) {
    const ViewGain& r = scores.results[i];
    csv += std::to_string(scores.indices[i]);
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
  const Scores& scores;
  double seconds = 0;

  [[nodiscard]] double poses_per_second() const {
    return static_cast<double>(source.poses.size()) / seconds;
  }
  [[nodiscard]] double rays_per_second() const {
    return static_cast<double>(scores.rays_traced) / seconds;
  }
};

void print_json_report(const Report& report) {
  nlohmann::ordered_json json{{"poses", report.source.poses.size()},
                              {"poses_scored", report.scores.results.size()},
                              {"rays_traced", report.scores.rays_traced},
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
  const Scores& scores = report.scores;
  if (report.options.set) json["set_gain"] = scores.set_gain;
  for (std::size_t rank = 0; rank < scores.best.size(); ++rank) {
    const std::size_t i = scores.best[rank];
    const Pose& pose = report.source.poses[i];
    if (scores.estimates.empty()) {
      json["best"].push_back(entry_of(i, scores.best_results[rank], pose));
    } else {
      json["best"].push_back({{"index", i},
                              {"gain", scores.estimates[i].gain},
                              {"standard_error", scores.estimates[i].standard_error},
                              {"T_world_camera", to_json(pose)}});
    }
  }
  print_json(json);
}

// What is not known yet must not count as surer than what a reading would say.
void warn_of_prior(const GainEvaluator& evaluator, const Sensor& sensor) {
  const double axial = sensor.sigmas(sensor.working_distance).axial;
  if (evaluator.prior_sigma() >= axial) return;
  std::fprintf(
      stderr,
      "viewgain: warning: the prior sigma, %.3g m, is below the sensor's along the ray, %.3g "
      "m at %g m: what is unknown counts as surer than a reading (--prior-sigma)\n",
      evaluator.prior_sigma(), axial, sensor.working_distance);
}

void print_speed(const Report& report) {
  const int threads = report.evaluator.num_threads();
  std::printf(
      "%s poses in %.3f s: %.0f poses/s, %s rays/s, %s rays per pose, %s voxels, %d %s, %s\n",
      with_commas(report.source.poses.size()).c_str(), report.seconds, report.poses_per_second(),
      with_unit(report.rays_per_second()).c_str(),
      with_commas(report.evaluator.rays_per_pose()).c_str(),
      with_commas(report.grid.voxel_count()).c_str(), threads, threads == 1 ? "thread" : "threads",
      std::string(report.evaluator.scene().isa()).c_str());
  if (report.scores.results.size() < report.source.poses.size()) {
    std::printf("%s scored in full, %s rays traced\n",
                with_commas(report.scores.results.size()).c_str(),
                with_commas(report.scores.rays_traced).c_str());
  }
}

void print_table(const Report& report) {
  const bool metres = report.options.criterion == "trace";
  std::printf("%s, sensor %s, prior sigma %.4g m, gains in %s\n", report.options.criterion.c_str(),
              report.sensor.name.c_str(), report.evaluator.prior_sigma(), metres ? "m^2" : "nat");
  if (report.source.orthonormalized > 0) {
    std::printf("rotations that were off and were orthonormalised: %zu of %zu\n",
                report.source.orthonormalized, report.source.poses.size());
  }
  const Scores& scores = report.scores;
  if (!scores.estimates.empty()) {
    std::printf("%4s %8s %12s %14s\n", "rank", "index", "gain", "standard error");
    for (std::size_t rank = 0; rank < scores.best.size(); ++rank) {
      const ApproximateGain& r = scores.estimates[scores.best[rank]];
      std::printf("%4zu %8zu %12.6g %14.3g\n", rank + 1, scores.best[rank], r.gain,
                  r.standard_error);
    }
    return print_speed(report);
  }
  std::printf("%4s %8s %12s %12s %12s %8s %9s %9s  %-26s %s\n", "rank", "index", "gain",
              "exploration", "refinement", "hits", "unknown", "occupied", "eye x y z [m]",
              "status");
  for (std::size_t rank = 0; rank < scores.best.size(); ++rank) {
    const std::size_t i = scores.best[rank];
    const ViewGain& r = scores.best_results[rank];
    const Eigen::Vector3d eye = report.source.poses[i].translation();
    std::array<char, 80> position{};
    std::snprintf(position.data(), position.size(), "%8.3f %8.3f %8.3f", eye.x(), eye.y(), eye.z());
    std::printf("%4zu %8zu %12.6g %12.6g %12.6g %8u %9u %9u  %-26s %s\n", rank + 1, i, r.gain,
                r.exploration, r.refinement, r.hits, r.unknown_voxels, r.occupied_voxels,
                position.data(), std::string(view_status_name(r.status)).c_str());
  }
  if (report.options.set) std::printf("together: %.6g\n", scores.set_gain);
  print_speed(report);
}

Scores raced_scores(const Options& options, const GainEvaluator& evaluator,
                    const std::vector<Pose>& poses, const BatchControl& control) {
  RacedViews views = evaluator.race(poses, options.top, {.seed = options.seed}, control);
  Scores scores;
  scores.indices = std::move(views.scored_indices);
  scores.results = std::move(views.scored_gains);
  scores.best = std::move(views.indices);
  scores.best_results = std::move(views.gains);
  scores.rays_traced = views.rays_traced;
  return scores;
}

Scores exhaustive_scores(const Options& options, const GainEvaluator& evaluator,
                         const std::vector<Pose>& poses, const BatchControl& control) {
  Scores scores;
  scores.results.resize(poses.size());
  evaluator.evaluate(poses, scores.results, control);
  scores.indices.resize(poses.size());
  std::iota(scores.indices.begin(), scores.indices.end(), std::size_t{0});
  scores.best = best_indices(scores.results, options.top);
  for (const std::size_t i : scores.best) scores.best_results.push_back(scores.results[i]);
  for (const ViewGain& r : scores.results) scores.rays_traced += r.rays;
  return scores;
}

Scores set_scores(const Options& options, const GainEvaluator& evaluator,
                  const std::vector<Pose>& poses, const BatchControl& control) {
  ViewSet set = evaluator.best_set(poses, *options.set, control);
  Scores scores;
  scores.rays_traced = set.evaluations * evaluator.rays_per_pose();
  scores.set_gain = set.gain;
  scores.indices = set.indices;
  scores.results = set.marginal;
  scores.best = std::move(set.indices);
  scores.best_results = std::move(set.marginal);
  return scores;
}

Scores approximate_scores(const Options& options, const GainEvaluator& evaluator,
                          const std::vector<Pose>& poses, const BatchControl& control) {
  const ApproximateConfig config{.share = *options.approximate, .seed = options.seed};
  Scores scores;
  scores.estimates.resize(poses.size());
  evaluator.approximate(poses, scores.estimates, config, control);
  std::vector<ViewGain> ranked(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) ranked[i].gain = scores.estimates[i].gain;
  scores.best = best_indices(ranked, options.top);
  scores.rays_traced = static_cast<std::uint64_t>(
      config.share * static_cast<double>(poses.size() * evaluator.rays_per_pose()));
  return scores;
}

Scores make_scores(const Options& options, const GainEvaluator& evaluator,
                   const std::vector<Pose>& poses, const BatchControl& control) {
  if (options.race) return raced_scores(options, evaluator, poses, control);
  if (options.set) return set_scores(options, evaluator, poses, control);
  if (options.approximate) return approximate_scores(options, evaluator, poses, control);
  return exhaustive_scores(options, evaluator, poses, control);
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
  const BeliefGrid grid = load_map(options.map, &sensor);
  const GainEvaluator evaluator(VoxelScene::build(grid, {}, exec), sensor, config, exec);

  Scores scores;
  double seconds = 0;
  {
    Progress progress("scoring pose");
    BatchControl control;
    control.progress = [&progress](std::size_t done, std::size_t total) {
      progress.update(done, total);
    };
    const Stopwatch watch;
    scores = make_scores(options, evaluator, source.poses, control);
    seconds = watch.seconds();
  }
  warn_of_prior(evaluator, sensor);
  const Report report{options, grid, sensor, source, evaluator, scores, seconds};
  if (!options.picture.empty()) {
    const std::size_t winner =
        scores.best.empty() ? evaluator.race(source.poses).indices.at(0) : scores.best[0];
    write_picture(options.picture, evaluator, sensor, source.poses[winner], exec);
  }
  if (!options.out.empty()) write_file_atomically(options.out, csv_of(scores));
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
  app->add_option("MAP", options->map, kMapHelp)->required();
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
  auto* selection = app->add_option_group("selection", "at most one of; default: score all poses");
  selection->add_flag("--race", options->race,
                      "the best poses, very probably, by successive halving on parts of the views");
  selection
      ->add_option("--approximate", options->approximate,
                   "SHARE: estimates with standard errors from this share of each view's tiles")
      ->check(CLI::Range(1e-6, 1.0, "share in (0, 1]"));
  selection
      ->add_option(
          "--set", options->set,
          "K views that are good together on this map, with what each adds to those before")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1'000'000}, "count"));
  selection->require_option(0, 1);
  app->add_option("--seed", options->seed, "of --race and --approximate")->capture_default_str();
  app->add_option(
      "--out", options->out,
      "CSV file of all poses, in input order; with a selection, of those scored in full, "
      "of the estimates, or of the set in order");
  app->add_option("--picture", options->picture,
                  "PNG file: the map, the best view's frustum and the voxels where its rays end");
  add_common_options(*app, options->common);
  return {app, [options] { score(*options); }};
}

}  // namespace viewgain::app
