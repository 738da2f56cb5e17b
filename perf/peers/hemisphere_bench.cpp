// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "hemisphere_bench.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "environment.hpp"
#include "published_object.hpp"
#include "view_choice.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/mesh/mesh_io.hpp"
#include "viewgain/mesh/quality.hpp"
#include "voxel_truth.hpp"

namespace viewgain::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDistance = 0.3;  // of the views from the centre [m]
constexpr double kTheirCoverage = 0.931;
constexpr double kTheirViews = 12.2;
constexpr std::size_t kOurViews = 32;
constexpr std::size_t kPoints = 200'000;  // that the voxels are made of

/// From the centre toward each position of the file, at the protocol's distance.
std::vector<Pose> hemisphere(const HemisphereOptions& options) {
  if (options.views_file.empty()) return dome_poses(kOurViews, kDistance);
  std::vector<Pose> poses;
  for (const Eigen::Vector3d& p : read_view_space(options.views_file)) {
    if (!(p.norm() > 0)) {
      throw Error(ErrorCode::format,
                  options.views_file.string().append(": a view is at the object's centre"));
    }
    poses.push_back(look_at(kDistance * p.normalized(), Eigen::Vector3d::Zero()));
  }
  return poses;
}

std::vector<Eigen::Vector3d> points_on(const std::filesystem::path& path, double size) {
  const TriangleMesh mesh =
      read_mesh(path, {.up = UpAxis::z, .center = true, .longest_side = size});
  const GroundTruth surface(mesh, kPoints);
  std::vector<Eigen::Vector3d> points;
  for (const SurfaceSample& sample : surface.samples()) {
    points.push_back(sample.position);
  }
  return points;
}

/// What the views of the hemisphere show of an object.
struct Shown {
  std::vector<VoxelFrame> frames;
  std::size_t voxels = 0;  ///< that one of them sees
};

Shown show(const VoxelTruth& truth, const std::vector<Pose>& poses, ThreadPool& pool) {
  Shown shown;
  octomap::KeySet all;
  for (const Pose& pose : poses) {
    shown.frames.push_back(truth.acquire(pose, pool));
    all.insert(shown.frames.back().voxels.begin(), shown.frames.back().voxels.end());
  }
  shown.voxels = all.size();
  return shown;
}

/// Coverage after each view of a run.
std::vector<double> run_from(std::size_t first, Ranker ranker, const Shown& shown,
                             const std::vector<Pose>& poses, const Sensor& sensor,
                             const HemisphereOptions& options, const ExecConfig& exec) {
  const double half = 0.5 * options.size * 0.4 / 0.35;  // as Stage has it
  ViewChoice choice(ranker, sensor, Box{{-half, -half, -half}, {half, half, half}}, options.voxel,
                    options.stride, first + 1, exec);
  octomap::KeySet seen;
  std::vector<std::uint8_t> taken(poses.size(), 0);
  std::vector<double> coverage;
  std::optional<std::size_t> at = first;
  while (at && coverage.size() < static_cast<std::size_t>(options.budget)) {
    const VoxelFrame& frame = shown.frames[*at];
    taken[*at] = 1;
    seen.insert(frame.voxels.begin(), frame.voxels.end());
    coverage.push_back(static_cast<double>(seen.size()) / static_cast<double>(shown.voxels));
    choice.add(frame.depth, poses[*at]);
    at = choice.next(poses, taken, 0);
  }
  return coverage;
}

/// Means over runs; a run that never gets there counts as budget + 1 views.
Json means_of(const std::vector<std::vector<double>>& runs) {
  const auto n = static_cast<double>(runs.size());
  std::vector<double> coverage(runs.front().size(), 0.0);
  double views = 0;
  for (const std::vector<double>& run : runs) {
    for (std::size_t i = 0; i < run.size(); ++i) coverage[i] += run[i] / n;
    const auto there =
        std::find_if(run.begin(), run.end(), [](double c) { return c >= kTheirCoverage; });
    views += static_cast<double>(there - run.begin() + 1) / n;
  }
  return {{"runs", runs.size()}, {"views_to_theirs", views}, {"coverage", coverage}};
}

void print(const Json& json) {
  std::printf(
      "Coverage [%%] of the surface that all %zu views together see, in voxels of 2 mm, and number "
      "of views to %.1f %% (MA-SCVP on other objects: %.1f)\n"
      "\n",
      json["views"].get<std::size_t>(), 100 * kTheirCoverage, kTheirViews);
  std::printf("| object | ranked by | number of views | after 1 | 2 | 3 | 4 | 5 | 8 | 12 | 20 |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Json& row : json["rows"]) {
    std::printf("| %s | %s | %.2f |", row["object"].get<std::string>().c_str(),
                row["gain"].get<std::string>().c_str(), row["views_to_theirs"].get<double>());
    for (const std::size_t view : {1, 2, 3, 4, 5, 8, 12, 20}) {
      const Json& coverage = row["coverage"];
      if (view > coverage.size()) {
        std::printf(" |");
      } else {
        std::printf(" %.1f |", 100 * coverage[view - 1].get<double>());
      }
    }
    std::printf("\n");
  }
}

}  // namespace

int run_hemisphere(const HemisphereOptions& options) {
  ThreadPool pool(options.num_threads);
  const ExecConfig exec{pool.num_threads()};
  const std::vector<Pose> poses = hemisphere(options);
  const Sensor sensor = peer_sensor(kDistance, 2 * kDistance);
  Json json{{"views", poses.size()}, {"size", options.size}, {"voxel", options.voxel}};
  add_environment(json, pool.num_threads());
  json["their_coverage"] = kTheirCoverage;
  json["their_views"] = kTheirViews;
  json["rows"] = Json::array();
  std::vector<std::vector<std::vector<double>>> of_all(options.rankers.size());
  const std::size_t starts = std::min(poses.size(), static_cast<std::size_t>(options.first_views));
  const auto add_row = [&](const std::string& object, std::size_t ranker,
                           const std::vector<std::vector<double>>& runs) {
    Json row{{"object", object}, {"gain", options.rankers[ranker]}};
    row.update(means_of(runs));
    json["rows"].push_back(std::move(row));
  };
  for (const std::filesystem::path& mesh : options.meshes) {
    const Shown shown = show(VoxelTruth(points_on(mesh, options.size), sensor), poses, pool);
    for (std::size_t i = 0; i < options.rankers.size(); ++i) {
      const Ranker ranker = parse_ranker(options.rankers[i]);
      std::vector<std::vector<double>> runs;
      for (std::size_t first = 0; first < starts; ++first) {
        runs.push_back(run_from(first, ranker, shown, poses, sensor, options, exec));
      }
      add_row(mesh.stem().string(), i, runs);
      of_all[i].insert(of_all[i].end(), runs.begin(), runs.end());
    }
  }
  for (std::size_t i = 0; i < options.rankers.size(); ++i) add_row("all", i, of_all[i]);
  if (options.json) {
    std::printf("%s\n", json.dump(2).c_str());
  } else {
    print(json);
  }
  return 0;
}

}  // namespace viewgain::bench
