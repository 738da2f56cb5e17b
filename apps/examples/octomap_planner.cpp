// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// A next-best-view planner on octomap::OcTree whose gain, the sum of entropies of the voxels that
// rays end in, is replaced by viewgain's: the same ranking side by side, and the processor time
// of either on one thread.
//
//   octomap_planner [CANDIDATES]        exit codes: 0, 2 for bad input
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <memory>
#include <numbers>
#include <numeric>
#include <string_view>
#include <vector>
#include <viewgain/formats/octomap_tree.hpp>
#include <viewgain/viewgain.hpp>

namespace {

using Eigen::Vector3d;
using viewgain::Pose;

constexpr double kVoxel = 0.02;  // [m]
constexpr double kRoom = 0.9;    // radius of the room, a sphere [m]
const viewgain::Box kMapped{{-0.96, -0.96, -0.96}, {0.96, 0.96, 0.96}};  // holds all of the room
// Of the most likely map [nat]: unknown is 1/2, occupied is 0.97 as where OctoMap clamps.
constexpr double kEntropyUnknown = std::numbers::ln2;
const double kEntropyOccupied = -0.97 * std::log(0.97) - 0.03 * std::log(0.03);

octomap::point3d point(const Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

// The distinct voxels that the rays of a view end in, the first that are not free.
struct Ends {
  octomap::KeySet unknown, occupied;
};

// The planner's own gain: a castRay() a pixel.
Ends cast_view(const octomap::OcTree& tree, const std::vector<Vector3d>& rays, const Pose& view) {
  Ends ends;
  const octomap::point3d eye = point(view.translation());
  const Eigen::Matrix3d R = view.rotation();
  for (const Vector3d& ray : rays) {
    octomap::point3d end;
    const bool is_occupied = tree.castRay(eye, point(R * ray), end, false);
    (is_occupied ? ends.occupied : ends.unknown).insert(tree.coordToKey(end));
  }
  return ends;
}

double entropy(std::size_t unknown, std::size_t occupied) {
  return kEntropyUnknown * static_cast<double>(unknown) +
         kEntropyOccupied * static_cast<double>(occupied);
}

// What the planner asks its gain function: a number a candidate.
using GainFunction = std::function<std::vector<double>(const octomap::OcTree& tree,
                                                       const std::vector<Pose>& candidates)>;

GainFunction octomap_gain(const std::vector<Vector3d>& rays) {
  return [rays](const octomap::OcTree& tree, const std::vector<Pose>& candidates) {
    std::vector<double> gains;
    for (const Pose& view : candidates) {
      const Ends ends = cast_view(tree, rays, view);
      gains.push_back(entropy(ends.unknown.size(), ends.occupied.size()));
    }
    return gains;
  };
}

// The tree as it is now. OctoMap's rays know no least range, so here there is as good as none (one
// of exactly 0 takes several times as long).
viewgain::GainEvaluator evaluator_of(const octomap::OcTree& tree, const viewgain::Sensor& sensor) {
  const auto grid = viewgain::grid_from_octree(
      tree, {.workspace = kMapped, .prior_sigma = viewgain::default_prior_sigma(kVoxel, sensor)});
  return {viewgain::VoxelScene::build(grid, {}, {.num_threads = 1}),
          sensor,
          {.model = viewgain::GainModel::paper, .min_range = 1e-4},
          {.num_threads = 1}};
}

// The same sum from viewgain's counts: what replaces the function above.
GainFunction viewgain_entropy(const viewgain::Sensor& sensor) {
  return [sensor](const octomap::OcTree& tree, const std::vector<Pose>& candidates) {
    std::vector<double> gains;
    for (const auto& view : evaluator_of(tree, sensor).evaluate(candidates)) {
      gains.push_back(entropy(view.unknown_voxels, view.occupied_voxels));
    }
    return gains;
  };
}

// And viewgain's own gain, which asks something else: what readings of this noise would tell.
GainFunction viewgain_gain(const viewgain::Sensor& sensor) {
  return [sensor](const octomap::OcTree& tree, const std::vector<Pose>& candidates) {
    std::vector<double> gains;
    for (const auto& view : evaluator_of(tree, sensor).evaluate(candidates)) {
      gains.push_back(view.gain);
    }
    return gains;
  };
}

// How many voxels are an end of the view for one of the two alone.
std::size_t differing_voxels(const Ends& ends, const std::vector<viewgain::RayHit>& hits) {
  Ends ours;
  for (const viewgain::RayHit& hit : hits) {
    if (hit.kind == viewgain::RayHit::Kind::none) continue;
    const auto key = [](std::int32_t i) { return static_cast<octomap::key_type>(i + 32768); };
    const bool is_occupied = hit.kind == viewgain::RayHit::Kind::occupied;
    (is_occupied ? ours.occupied : ours.unknown)
        .insert({key(hit.voxel.x), key(hit.voxel.y), key(hit.voxel.z)});
  }
  const auto missing = [](const octomap::KeySet& from, const octomap::KeySet& in) {
    return static_cast<std::size_t>(std::count_if(
        from.begin(), from.end(), [&](const auto& key) { return in.count(key) == 0; }));
  };
  return missing(ends.unknown, ours.unknown) + missing(ours.unknown, ends.unknown) +
         missing(ends.occupied, ours.occupied) + missing(ours.occupied, ends.occupied);
}

// Kendall's tau-b: 1 if the two rank all pairs alike.
double rank_correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const auto sign = [](double x) { return (x > 0) - (x < 0); };
  double both = 0, in_a = 0, in_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const int s = sign(a[i] - a[j]), t = sign(b[i] - b[j]);
      both += s * t;
      in_a += s * s;
      in_b += t * t;
    }
  }
  return both / std::sqrt(in_a * in_b);
}

std::vector<std::size_t> ranking(const std::vector<double>& gains) {
  std::vector<std::size_t> order(gains.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return gains[i] > gains[j]; });
  return order;
}

// The real thing, simulated: a box in the middle of the room.
viewgain::SimulatedSensor make_camera(const viewgain::Sensor& sensor) {
  viewgain::TriangleMesh box;
  for (unsigned i = 0; i < 8; ++i) {
    box.vertices.push_back(
        {(i & 4U) != 0 ? 0.15 : -0.15, (i & 2U) != 0 ? 0.1 : -0.1, (i & 1U) != 0 ? 0.2 : -0.2});
  }
  box.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                   {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return {std::make_shared<viewgain::SurfaceScene>(box), sensor, {.background_radius = kRoom}};
}

void take_view(const viewgain::SimulatedSensor& camera, const std::vector<Vector3d>& rays,
               const Pose& view, octomap::OcTree& tree) {
  const viewgain::DepthFrame frame = camera.acquire(view);
  octomap::Pointcloud cloud;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto depth = static_cast<double>(frame.depth[i]);
    if (depth > 0 && std::isfinite(depth)) cloud.push_back(point(view * (rays[i] * depth)));
  }
  tree.insertPointCloud(cloud, point(view.translation()));
}

// Processor time, which other programs on the machine do not change.
double seconds_since(std::clock_t start) {
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

int run(std::size_t candidate_count) {
  const viewgain::Sensor sensor = viewgain::sensor_preset("sr4000");
  const viewgain::SimulatedSensor camera = make_camera(sensor);
  const std::vector<Vector3d> rays = sensor.camera.ray_table();
  const struct {
    const char* name;
    GainFunction gain;
  } methods[] = {{"OctoMap, entropy", octomap_gain(rays)},
                 {"viewgain, entropy", viewgain_entropy(sensor)},
                 {"viewgain, expected gain", viewgain_gain(sensor)}};

  // The robot turns round once where it stands, then takes one view after the other.
  octomap::OcTree tree(kVoxel);
  const Vector3d stand(0.6, 0.05, 0.1);
  for (int i = 0; i < 12; ++i) {
    const double azimuth = std::numbers::pi * i / 6;
    const Vector3d ahead(std::cos(azimuth), std::sin(azimuth), 0);
    take_view(camera, rays, viewgain::look_at(stand, stand + ahead), tree);
  }
  for (int step = 1; step <= 3; ++step) {
    std::vector<Pose> candidates = viewgain::sphere_poses(candidate_count, 0.55);
    std::erase_if(candidates, [&](const Pose& view) {  // the camera stays in known free space
      const auto* node = tree.search(point(view.translation()));
      return node == nullptr || tree.isNodeOccupied(node);
    });
    if (candidates.size() < 2) {
      std::fprintf(stderr, "octomap_planner: %zu of %zu candidates stand in free space, 2 needed\n",
                   candidates.size(), candidate_count);
      return 2;
    }
    std::printf("view %d, %zu candidates of %zu rays\n", step, candidates.size(), rays.size());
    std::vector<double> gains[3];
    std::vector<std::size_t> rankings[3];
    for (int m = 0; m < 3; ++m) {
      const auto start = std::clock();
      gains[m] = methods[m].gain(tree, candidates);
      const double seconds = seconds_since(start);
      rankings[m] = ranking(gains[m]);
      std::printf("  %-24s %8.4f s, rank correlation with the first %.5f, best:", methods[m].name,
                  seconds, rank_correlation(gains[0], gains[m]));
      for (std::size_t i = 0; i < std::min<std::size_t>(5, candidates.size()); ++i) {
        std::printf(" %zu", rankings[m][i]);
      }
      std::printf("\n");
    }
    const auto start = std::clock();
    const viewgain::GainEvaluator evaluator = evaluator_of(tree, sensor);
    std::printf("  of viewgain's time converting the tree: %.4f s\n", seconds_since(start));
    // Rays that pass an edge within rounding may end in one voxel here and in its neighbour there.
    std::size_t different = 0, all = 0;
    for (const Pose& view : candidates) {
      const Ends ends = cast_view(tree, rays, view);
      different += differing_voxels(ends, evaluator.trace(view));
      all += ends.unknown.size() + ends.occupied.size();
    }
    std::printf("  voxels that only one of the entropies counts: %zu of %zu\n", different, all);
    take_view(camera, rays, candidates[rankings[1].front()], tree);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view text = argc > 1 ? argv[1] : "100";
  std::size_t candidates = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), candidates);
  if (argc > 2 || error != std::errc() || end != text.data() + text.size() || candidates < 1 ||
      candidates > 1'000'000) {
    std::fprintf(stderr, "usage: octomap_planner [CANDIDATES], a whole number from 1 to 1000000\n");
    return 2;
  }
  return run(candidates);
}
