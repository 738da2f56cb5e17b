// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "armadillo_bench.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "environment.hpp"
#include "measure.hpp"
#include "peer_map.hpp"
#include "point_coverage.hpp"
#include "published_object.hpp"
#include "view_choice.hpp"
#include "voxel_truth.hpp"

namespace viewgain::bench {
namespace {

using Json = nlohmann::ordered_json;

// Armadillo_example_Ours/quantitative: voxels that it counted after each view, of 526.
constexpr std::array kTheirVoxels{253, 389, 458, 456, 481, 492, 504, 507, 507, 507};
constexpr double kTheirAll = 526;
constexpr double kTheirGoal = 481 / kTheirAll;
constexpr double kRangeInSizes = 6;
constexpr double kDistanceInSizes = 2.5;  // of the start

Eigen::Vector3d up_of(const Pose& T_world_camera) { return -T_world_camera.rotation().col(1); }

/// They look at the centre, the image's vertical as near as it can be to that of the camera before.
std::vector<Pose> poses_of_eyes(const PublishedObject& object, const Eigen::Vector3d& up_before) {
  std::vector<Pose> poses;
  for (const Eigen::Vector3d& eye : object.eyes) {
    poses.push_back(look_at(eye, object.center, up_before));
  }
  return poses;
}

struct Case {
  std::string ranker;
  double travel = 0;
};

/// One run: what was counted after each view.
Json run_case(const Case& which, const PublishedObject& object, const Sensor& sensor,
              const VoxelTruth& truth, const ArmadilloOptions& options, ThreadPool& pool) {
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(object.size);
  Box workspace;
  Eigen::Vector3d::Map(workspace.min.data()) = object.center - half;
  Eigen::Vector3d::Map(workspace.max.data()) = object.center + half;
  ViewChoice choice(parse_ranker(which.ranker), sensor, workspace, options.voxel, options.stride, 1,
                    {pool.num_threads()});
  PeerMap map(object.center, object.size);
  PointCoverage covered(object.points);
  const auto all = static_cast<double>(PeerMap::voxels_of(object.points));
  std::vector<std::uint8_t> taken(object.eyes.size(), 0);
  std::vector<double> seconds;
  Json views = Json::array();
  Json goal = nullptr;
  // The camera before the first is the world's frame: y down.
  std::vector<Pose> poses = poses_of_eyes(object, -Eigen::Vector3d::UnitY());
  double travelled = 0;
  std::size_t at = 0;
  for (int view = 1; view <= options.views; ++view) {
    const Pose pose = poses[at];
    taken[at] = 1;
    const VoxelFrame frame = truth.acquire(pose, pool);
    std::vector<octomap::point3d> hits;
    for (const auto& voxel : frame.voxels) hits.push_back(truth.center_of(voxel));
    map.insert(hits, pose.translation());
    covered.add(hits);
    const std::size_t occupied = map.occupied();
    const double share = static_cast<double>(occupied) / all;
    if (goal.is_null() && share >= kTheirGoal) goal = view;
    views.push_back({{"candidate", at},
                     {"occupied", occupied},
                     {"counted", share},
                     {"covered", covered.share()},
                     {"travelled", travelled}});
    if (view == options.views) break;
    poses = poses_of_eyes(object, up_of(pose));
    std::optional<std::size_t> next;
    seconds.push_back(seconds_of([&] {
      choice.add(frame.depth, pose);
      next = choice.next(poses, taken, which.travel);
    }));
    if (!next) break;
    travelled += (poses[*next].translation() - pose.translation()).norm();
    at = *next;
  }
  Json result{{"gain", which.ranker}, {"travel", which.travel}, {"views", views}};
  result["views_to_theirs"] = goal;
  result["decision_seconds"] = seconds.empty() ? Json(nullptr) : Json(median(seconds));
  return result;
}

std::string name_of(const Json& run) {
  std::string name = run["gain"];
  if (run["travel"] > 0) name.append(" - way");
  return name;
}

void print(const Json& json) {
  std::printf(
      "%zu points, %zu candidates; the complete model has %zu voxels of 1 cm (526 in "
      "NBV-Simulation)\n",
      json["points"].get<std::size_t>(), json["candidates"].get<std::size_t>(),
      json["voxels"].get<std::size_t>());
  std::printf(
      "share of the model's voxels in the OctoMap / share of points with a measured point within "
      "%.1f mm [%%]\n"
      "\n",
      1e3 * kCoveredWithin);
  std::printf("| view | their log |");
  for (const Json& run : json["runs"]) std::printf(" %s |", name_of(run).c_str());
  std::printf("\n|---|---|");
  for (std::size_t i = 0; i < json["runs"].size(); ++i) std::printf("---|");
  for (std::size_t view = 0; view < json["views"]; ++view) {
    const bool has_log = view < kTheirVoxels.size();
    std::printf("\n| %zu | ", view + 1);
    if (has_log) std::printf("%.1f", 100 * kTheirVoxels[view] / kTheirAll);
    std::printf(" |");
    for (const Json& run : json["runs"]) {
      if (view >= run["views"].size()) {
        std::printf(" |");
        continue;
      }
      const Json& v = run["views"][view];
      std::printf(" %.1f / %.1f |", 100 * v["counted"].get<double>(),
                  100 * v["covered"].get<double>());
    }
  }
  const auto row = [&](const char* name, const char* theirs, auto&& cell) {
    std::printf("\n| %s | %s |", name, theirs);
    for (const Json& run : json["runs"]) std::printf(" %s |", cell(run).c_str());
  };
  row("views to 91.4 %", "5", [](const Json& run) {
    return run["views_to_theirs"].is_null() ? std::string("-") : run["views_to_theirs"].dump();
  });
  row("way [m]", "", [](const Json& run) {
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), "%.2f", run["views"].back()["travelled"].get<double>());
    return std::string(text.data());
  });
  row("frame in, 5,000 scored [s]", "", [](const Json& run) {
    if (run["decision_seconds"].is_null()) return std::string("-");
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), "%.2f", run["decision_seconds"].get<double>());
    return std::string(text.data());
  });
  std::printf("\n");
}

}  // namespace

int run_armadillo(const ArmadilloOptions& options) {
  const PublishedObject object = read_published_object(options.data);
  ThreadPool pool(options.num_threads);
  const Sensor sensor = peer_sensor(kDistanceInSizes * object.size, kRangeInSizes * object.size);
  const VoxelTruth truth(object.points, sensor);
  Json json{{"data", options.data.string()},
            {"points", object.points.size()},
            {"candidates", object.eyes.size()},
            {"size", object.size},
            {"voxels", PeerMap::voxels_of(object.points)},
            {"lens_error_px", peer_lens_error(sensor)},
            {"voxel", options.voxel},
            {"stride", options.stride},
            {"views", options.views}};
  add_environment(json, pool.num_threads());
  json["their_log"] = Json::array();
  for (const int voxels : kTheirVoxels) json["their_log"].push_back(voxels / kTheirAll);
  json["runs"] = Json::array();
  for (const double travel : options.travel) {
    for (const std::string& ranker : options.rankers) {
      json["runs"].push_back(run_case({ranker, travel}, object, sensor, truth, options, pool));
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
