// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// A next-best-view planner on octomap::OcTree whose gain, the sum of entropies of the voxels that
// rays end in, is replaced by viewgain's, whose map follows the tree as it grows: side by side the
// best candidates of either, and the processor time on one thread.
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

double entropy(std::size_t unknown, std::size_t occupied) {
  return kEntropyUnknown * static_cast<double>(unknown) +
         kEntropyOccupied * static_cast<double>(occupied);
}

// What the planner asks its gain function: a number a candidate.
using GainFunction = std::function<std::vector<double>(const octomap::OcTree& tree,
                                                       const std::vector<Pose>& candidates)>;

// The planner's own: a castRay() a pixel; each voxel that rays end in counts once.
GainFunction octomap_gain(const std::vector<Vector3d>& rays) {
  return [rays](const octomap::OcTree& tree, const std::vector<Pose>& candidates) {
    std::vector<double> gains;
    for (const Pose& view : candidates) {
      octomap::KeySet unknown, occupied;
      for (const Vector3d& ray : rays) {
        octomap::point3d end;
        const octomap::point3d eye = point(view.translation()),
                               along = point(view.rotation() * ray);
        (tree.castRay(eye, along, end, false) ? occupied : unknown).insert(tree.coordToKey(end));
      }
      gains.push_back(entropy(unknown.size(), occupied.size()));
    }
    return gains;
  };
}

// Follows the tree: a grid that takes over what has changed since it was asked last, and the scene
// of it. OctoMap's rays know no least range, so here there is as good as none (one of exactly 0
// takes several times as long).
class Follower {
 public:
  explicit Follower(const viewgain::Sensor& sensor)
      : grid_({.voxel_size = kVoxel, .workspace = kMapped}, sensor),
        scene_(viewgain::VoxelScene::build(grid_, {}, kOneThread)),
        evaluator_(scene_, sensor, {.model = viewgain::GainModel::paper, .min_range = 1e-4},
                   kOneThread) {}

  const viewgain::GainEvaluator& evaluator(const octomap::OcTree& tree) {
    if (viewgain::update_from_octree(grid_, tree, kMapped) > 0) {
      scene_ = viewgain::VoxelScene::update(scene_, grid_, kOneThread);
      evaluator_ = evaluator_.with_scene(scene_);
    }
    return evaluator_;
  }

 private:
  static constexpr viewgain::ExecConfig kOneThread{.num_threads = 1};
  viewgain::BeliefGrid grid_;
  std::shared_ptr<const viewgain::VoxelScene> scene_;
  viewgain::GainEvaluator evaluator_;
};

// The same sum from viewgain's counts: what replaces the function above.
GainFunction viewgain_entropy(Follower& follower) {
  return [&follower](const octomap::OcTree& tree, const std::vector<Pose>& candidates) {
    std::vector<double> gains;
    for (const auto& view : follower.evaluator(tree).evaluate(candidates)) {
      gains.push_back(entropy(view.unknown_voxels, view.occupied_voxels));
    }
    return gains;
  };
}

// And viewgain's own gain, which asks something else: what readings of this noise would tell.
GainFunction viewgain_gain(Follower& follower) {
  return [&follower](const octomap::OcTree& tree, const std::vector<Pose>& candidates) {
    std::vector<double> gains;
    for (const auto& view : follower.evaluator(tree).evaluate(candidates)) {
      gains.push_back(view.gain);
    }
    return gains;
  };
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
  const viewgain::Obstacles box{{{{-0.15, -0.1, -0.2}, {0.15, 0.1, 0.2}}}, {}};
  return {std::make_shared<viewgain::SurfaceScene>(viewgain::mesh_of(box)),
          sensor,
          {.background_radius = kRoom}};
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

int run(std::size_t candidate_count) {
  const viewgain::Sensor sensor = viewgain::sensor_preset("sr4000");
  const viewgain::SimulatedSensor camera = make_camera(sensor);
  const std::vector<Vector3d> rays = sensor.camera.ray_table();
  Follower follower(sensor);
  const struct {
    const char* name;
    GainFunction gain;
  } methods[] = {{"OctoMap, entropy", octomap_gain(rays)},
                 {"viewgain, entropy", viewgain_entropy(follower)},
                 {"viewgain, expected gain", viewgain_gain(follower)}};

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
    std::vector<std::size_t> order;
    for (const auto& [name, gain] : methods) {
      const std::clock_t start = std::clock();  // processor time, which others do not change
      order = ranking(gain(tree, candidates));
      const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
      std::printf("  %-24s %8.4f s, best:", name, seconds);
      for (std::size_t i = 0; i < std::min<std::size_t>(5, order.size()); ++i) {
        std::printf(" %zu", order[i]);
      }
      std::printf("\n");
    }
    take_view(camera, rays, candidates[order.front()], tree);
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
