// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "frames_bench.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <utility>

#include "environment.hpp"
#include "measure.hpp"
#include "model_maps.hpp"
#include "model_scene.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/mesh/quality.hpp"
#include "viewgain/planner/point_arrays.hpp"
#include "viewgain/planner_mesh/truth.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/raycast/view_scorer.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kGoal = 0.90;     // of the samples, within kCovered
constexpr int kStride = 4;         // of the pixels that views are scored on
constexpr double kElongation = 8;  // sigma along the ray over that across it, of the second sensor
constexpr std::array kDecisions{2, 4, 8};  // views after which rankings are compared

struct Turn {
  const char* axis;
  Eigen::Vector3d along;
};
const std::array<Turn, 2> kTurns{Turn{"z", Eigen::Vector3d::UnitZ()},
                                 Turn{"(1,1,1)", Eigen::Vector3d::Ones().normalized()}};

/// The SR4000 with sigmas of a ratio of kElongation, the one across the ray its own.
Sensor elongated(const Sensor& sensor) {
  Sensor result = sensor;
  const double lateral = sensor.sigmas(sensor.working_distance).lateral;
  result.noise = ConstantNoise{.sigma_axial = kElongation * lateral, .sigma_lateral = lateral};
  return result;
}

/// A grid that holds the object however it is turned.
GridConfig turned_grid(const ModelScene& model, double voxel, const Pose& T_world_grid) {
  double radius = 0;
  for (const auto& v : model.stage().scene->mesh().vertices) {
    radius = std::max(radius, (Eigen::Vector3d(v[0], v[1], v[2]) - model.stage().center).norm());
  }
  const double half = radius + 5 * voxel;
  const Eigen::Vector3d c = T_world_grid.inverse() * model.stage().center;
  GridConfig config;
  config.voxel_size = voxel;
  config.workspace = {{c.x() - half, c.y() - half, c.z() - half},
                      {c.x() + half, c.y() + half, c.z() + half}};
  config.T_world_grid = T_world_grid;
  config.prior_sigma = default_prior_sigma(voxel, model.sensor());
  return config;
}

std::vector<double> gains_by(Criterion criterion, const std::shared_ptr<const VoxelScene>& scene,
                             double voxel, const Sensor& sensor, const std::vector<Pose>& poses,
                             const ExecConfig& exec) {
  GainConfig config{.model = GainModel::paper};
  config.criterion = criterion;
  config.pixel_stride = kStride;
  config.prior_sigma = default_prior_sigma(voxel, sensor);
  std::vector<double> gains;
  for (const ViewGain& gain : GainEvaluator(scene, sensor, config, exec).evaluate(poses)) {
    gains.push_back(gain.gain);
  }
  return gains;
}

/// How alike two criteria are on one map.
struct Likeness {
  std::vector<double> rank_correlation;
  std::vector<double> given_away;  ///< of the best by log_determinant, share
  std::vector<double> ratio;       ///< median of log_diagonal / log_determinant

  void add(const std::vector<double>& diagonal, const std::vector<double>& determinant) {
    rank_correlation.push_back(bench::rank_correlation(diagonal, determinant));
    const auto favourite = std::max_element(diagonal.begin(), diagonal.end()) - diagonal.begin();
    const double best = *std::max_element(determinant.begin(), determinant.end());
    given_away.push_back(1 - determinant[static_cast<std::size_t>(favourite)] / best);
    std::vector<double> ratios;
    for (std::size_t i = 0; i < diagonal.size(); ++i)
      ratios.push_back(diagonal[i] / determinant[i]);
    ratio.push_back(median(ratios));
  }
};

/// A run by the paper's gain with this criterion; views to the goal, budget + 1 if it is missed.
template <typename Visit>
int run_to_goal(const ModelScene& model, const GroundTruth& truth, const GridConfig& grid,
                Criterion criterion, std::uint64_t seed, const FramesOptions& options,
                const ExecConfig& exec, Visit&& visit) {
  ScorerConfig config;
  config.gain.model = GainModel::paper;
  ViewScorer map(BeliefGrid(grid, model.sensor()), model.sensor(), config, exec);
  const std::vector<Pose> poses = sphere_poses(static_cast<std::size_t>(options.candidates),
                                               kModelDistance, model.stage().center);
  Pose pose = default_start(model.stage(), kModelDistance, seed, {}, {});
  std::vector<std::uint8_t> taken(poses.size(), 0);
  std::optional<int> there;
  for (int view = 1; view <= options.views; ++view) {
    Measurements measurements;
    measurements.T_world_camera = pose;
    measurements.frames = {model.acquire(pose, static_cast<std::uint64_t>(view - 1))};
    map.add(measurements);
    const auto positions = arrays_of(fused_points(map.grid(), {}, exec)).positions;
    const double covered = coverage(truth.distances_to(positions), kCovered);
    if (!there && covered >= kGoal) there = view;
    visit(view, map.scene(), poses);
    const bool has_more =
        std::any_of(kDecisions.begin(), kDecisions.end(), [&](int d) { return d > view; });
    if (there && !has_more) break;
    const std::vector<double> gains =
        gains_by(criterion, map.scene(), grid.voxel_size, model.sensor(), poses, exec);
    std::size_t best = poses.size();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (taken[i] == 0 && (best == poses.size() || gains[i] > gains[best])) best = i;
    }
    if (best == poses.size()) break;
    taken[best] = 1;
    pose = poses[best];
  }
  return there.value_or(options.views + 1);
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

Json to_json(const Likeness& likeness) {
  return {{"rank_correlation", mean(likeness.rank_correlation)},
          {"least_rank_correlation", quantile(likeness.rank_correlation, 0)},
          {"given_away", mean(likeness.given_away)},
          {"most_given_away", quantile(likeness.given_away, 1)},
          {"ratio", mean(likeness.ratio)},
          {"decisions", likeness.given_away.size()}};
}

/// All objects and seeds on grids turned alike.
Json row_of(const Turn& turn, double degrees, const FramesOptions& options,
            const ExecConfig& exec) {
  Likeness ours, longer;
  std::vector<double> by_diagonal, by_determinant;
  for (const std::filesystem::path& mesh : options.meshes) {
    for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(options.seeds); ++seed) {
      const ModelScene model(mesh, seed, exec);
      const GroundTruth truth(model.stage().scene->mesh(), 10'000, 1, exec);
      const Eigen::Matrix3d R =
          Eigen::AngleAxisd(degrees * std::numbers::pi / 180, turn.along).toRotationMatrix();
      const GridConfig grid = turned_grid(model, options.voxel, Pose(R, Eigen::Vector3d::Zero()));
      const Sensor long_sensor = elongated(model.sensor());
      const auto compare = [&](int view, const std::shared_ptr<const VoxelScene>& scene,
                               const std::vector<Pose>& poses) {
        if (std::find(kDecisions.begin(), kDecisions.end(), view) == kDecisions.end()) return;
        for (const auto& [sensor, likeness] :
             {std::pair{&model.sensor(), &ours}, std::pair{&long_sensor, &longer}}) {
          likeness->add(
              gains_by(Criterion::log_diagonal, scene, options.voxel, *sensor, poses, exec),
              gains_by(Criterion::log_determinant, scene, options.voxel, *sensor, poses, exec));
        }
      };
      const auto nothing = [](auto&&...) {};
      by_determinant.push_back(run_to_goal(model, truth, grid, Criterion::log_determinant, seed,
                                           options, exec, compare));
      by_diagonal.push_back(
          run_to_goal(model, truth, grid, Criterion::log_diagonal, seed, options, exec, nothing));
    }
  }
  std::vector<double> lost;
  for (std::size_t i = 0; i < by_diagonal.size(); ++i) {
    lost.push_back(by_diagonal[i] - by_determinant[i]);
  }
  return {{"axis", turn.axis},
          {"degrees", degrees},
          {"runs", lost.size()},
          {"sr4000", to_json(ours)},
          {"elongated", to_json(longer)},
          {"views_by_log_diagonal", mean(by_diagonal)},
          {"views_by_log_determinant", mean(by_determinant)},
          {"views_lost", lost}};
}

void print(const Json& json) {
  std::printf(
      "log_diagonal compared with log_determinant on rotated grids. loss: share of the best gain "
      "by log_determinant that the view chosen by log_diagonal lacks, mean (largest)\n"
      "\n");
  std::printf(
      "| rotated by | SR4000: Spearman (lowest) | loss | ratio of gains | sigmas 8 : 1: Spearman "
      "(lowest) | loss | ratio of gains | views to 90 %% with log_determinant | with log_diagonal "
      "|\n");
  std::printf("|---|---|---|---|---|---|---|---|---|\n");
  for (const Json& row : json["rows"]) {
    std::printf("| %.0f deg about %s |", row["degrees"].get<double>(),
                row["axis"].get<std::string>().c_str());
    for (const char* sensor : {"sr4000", "elongated"}) {
      const Json& r = row[sensor];
      std::printf(" %.4f (%.4f) | %.2f %% (%.1f %%) | %.3f |", r["rank_correlation"].get<double>(),
                  r["least_rank_correlation"].get<double>(), 100 * r["given_away"].get<double>(),
                  100 * r["most_given_away"].get<double>(), r["ratio"].get<double>());
    }
    std::printf(" %.2f | %.2f |\n", row["views_by_log_determinant"].get<double>(),
                row["views_by_log_diagonal"].get<double>());
  }
}

}  // namespace

int run_frames(const FramesOptions& options) {
  const ExecConfig exec{thread_count(options.num_threads)};
  Json json{{"voxel", options.voxel},
            {"candidates", options.candidates},
            {"seeds", options.seeds},
            {"views", options.views}};
  add_environment(json, exec.num_threads);
  json["rows"] = Json::array();
  bool has_unturned = false;
  for (const Turn& turn : kTurns) {
    for (const double degrees : options.degrees) {
      if (degrees == 0 && std::exchange(has_unturned, true)) continue;  // the same about any axis
      json["rows"].push_back(row_of(turn, degrees, options, exec));
    }
  }
  if (options.json) {
    std::printf("%s\n", json.dump(2).c_str());
  } else {
    print(json);
  }
  return 0;
}

}  // namespace viewgain::bench
