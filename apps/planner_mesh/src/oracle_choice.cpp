// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/planner_mesh/oracle_choice.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "viewgain/core/error.hpp"
#include "viewgain/planner/point_arrays.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain {
namespace {

const double kLeastCosine = std::cos(72.0 * std::numbers::pi / 180);

const KnownObject& checked(const KnownObject& object) {
  if (!object.mesh || !object.truth) {
    throw Error(ErrorCode::invalid_argument,
                "policy \"oracle\" needs the object's mesh, which only a simulation knows");
  }
  return object;
}

SimulationConfig without_noise(SimulationConfig config) {
  config.noise = config.lateral_noise = false;
  config.scale_error = 0;
  config.sub_rays = 1;
  return config;
}

}  // namespace

OracleChoice::OracleChoice(const SurfaceModel& model, const Sensor& sensor,
                           const KnownObject& object, const ExecConfig& exec)
    : model_(model),
      sensor_(sensor),
      object_(checked(object)),
      exec_(exec),
      camera_(object.mesh, sensor, without_noise(object.simulation), exec) {}

std::vector<std::size_t> OracleChoice::uncovered_in_view(
    std::span<const Candidate> candidates) const {
  const GroundTruth& truth = object_.truth->ground_truth();
  const std::vector<double> distances = truth.distances_to(model_.surface().vertices);
  std::vector<SurfaceSample> uncovered;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    if (!(distances[i] <= object_.truth->tolerance())) uncovered.push_back(truth.samples()[i]);
  }
  std::vector<std::size_t> counts(candidates.size());
  ThreadPool pool(exec_.num_threads);
  pool.for_each_chunk(candidates.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::vector<std::uint8_t> seen(uncovered.size());
      mark_seen(*object_.mesh, object_.simulation.surroundings.get(), sensor_,
                candidates[i].T_world_camera, kLeastCosine, uncovered, seen);
      counts[i] = static_cast<std::size_t>(std::count(seen.begin(), seen.end(), 1));
    }
  });
  return counts;
}

std::size_t OracleChoice::covered_after(const Pose& T_world_camera) const {
  const auto points = model_.points_after({T_world_camera, {camera_.acquire(T_world_camera)}});
  const std::vector<double> distances =
      object_.truth->ground_truth().distances_to(arrays_of(points).positions);
  return static_cast<std::size_t>(std::count_if(distances.begin(), distances.end(), [&](double d) {
    return d <= object_.truth->tolerance();
  }));
}

std::size_t OracleChoice::next(std::span<const Candidate> candidates) const {
  const std::vector<std::size_t> counts = uncovered_in_view(candidates);
  std::vector<std::size_t> ranking(candidates.size());
  std::iota(ranking.begin(), ranking.end(), std::size_t{0});
  std::stable_sort(ranking.begin(), ranking.end(),
                   [&](std::size_t a, std::size_t b) { return counts[a] > counts[b]; });
  ranking.resize(std::min(ranking.size(), kSimulated));
  std::sort(ranking.begin(), ranking.end());
  std::size_t best = ranking.front(), most = 0;
  for (const std::size_t i : ranking) {
    const std::size_t covered = covered_after(candidates[i].T_world_camera);
    if (covered > most) most = covered, best = i;
  }
  return best;
}

}  // namespace viewgain
