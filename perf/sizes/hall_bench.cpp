// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "hall_bench.hpp"

#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "environment.hpp"
#include "measure.hpp"
#include "resident_memory.hpp"
#include "support/room_scene.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"
#include "viewgain/support/hash64.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::bench {
namespace {

const Box kHall{{-9.8, -9.8, 0.1}, {9.8, 9.8, 2.9}};
constexpr int kAisles = 6;
constexpr double kAisleLength = 18, kAisleDistance = 3.2;  // [m]
constexpr int kThings = 120;
constexpr std::uint64_t kSeed = 17;
constexpr double kScoringRange = 5;  // [m]

double aisle_y(double number) { return kAisleDistance * (number - (kAisles - 1) / 2.0); }

}  // namespace

TriangleMesh hall_mesh() {
  TriangleMesh mesh;
  test::add_box(mesh, kHall);
  std::uint64_t drawn = 0;
  const auto between = [&](double low, double high) {
    return low + (high - low) * unit_number(mix64(mix64(kSeed) + drawn++));
  };
  for (int i = 0; i < kThings; ++i) {
    const double x = between(-9, 9), y = aisle_y(i % (kAisles + 1) - 0.5) + between(-0.3, 0.3);
    const double width = between(0.1, 0.9), depth = between(0.1, 0.7);
    const double bottom = i % 3 == 0 ? between(0.4, 1.6) : kHall.min[2];
    const double top = bottom + between(0.05, i % 3 == 0 ? 0.5 : 2.0);
    test::add_box(mesh, {{x - width, y - depth, bottom}, {x + width, y + depth, top}});
  }
  return mesh;
}

Pose hall_pose(int frame, int frames) {
  const double way = kAisles * (frame + 0.5) / frames;  // [aisle]
  const double aisle = std::floor(way), along = kAisleLength * (way - aisle - 0.5);
  const double heading = std::fmod(aisle, 2) == 0 ? 1 : -1;
  const double turn = 1.3 * std::sin(0.05 * frame), tilt = -0.15 + 0.25 * std::sin(0.031 * frame);
  const Eigen::Vector3d eye(heading * along, aisle_y(aisle), 1.4);
  return look_at(eye, eye + Eigen::Vector3d(heading * std::cos(turn), std::sin(turn), tilt));
}

int run_hall(const HallOptions& options) {
  const ExecConfig exec{.num_threads = ThreadPool(options.num_threads).num_threads()};
  const Sensor sensor = sensor_preset("kinect_v1");
  const SimulatedSensor camera(std::make_shared<const SurfaceScene>(hall_mesh(), exec), sensor,
                               {.noise = true}, exec);
  reset_peak_memory();
  const std::uint64_t before = resident_bytes();
  BeliefGrid grid({.voxel_size = options.voxel, .workspace = kHallWorkspace}, sensor);
  FrameIntegrator integrator(sensor, {.coarsest = options.coarsest}, exec);
  const auto integrate = [&](int i, const Pose& T_world_camera) {
    const DepthFrame frame = camera.acquire(T_world_camera, static_cast<std::uint64_t>(i));
    return seconds_of([&] { integrator.integrate(grid, frame, T_world_camera); });
  };
  std::vector<double> of_frames;
  for (int i = 0; i < options.frames; ++i) {
    of_frames.push_back(integrate(i, hall_pose(i, options.frames)));
  }
  std::shared_ptr<const VoxelScene> scene;
  const double of_build = seconds_of([&] { scene = VoxelScene::build(grid, {}, exec); });
  const std::uint64_t peak_of_map_and_scene = peak_resident_bytes();
  const std::uint64_t map_bytes = grid.statistics().bytes;
  // One more frame, where the camera began.
  (void)integrate(options.frames, hall_pose(0, options.frames));
  const double of_update = seconds_of([&] { scene = VoxelScene::update(scene, grid, exec); });

  Sensor scoring = sensor;
  scoring.max_range = std::min(sensor.max_range, kScoringRange);
  const GainEvaluator evaluator(scene, scoring, {.model = GainModel::paper}, exec);
  const std::vector<Pose> poses =
      test::poses_in(scene->snapshot(), static_cast<std::size_t>(options.poses), kSeed);
  std::vector<ViewGain> gains(poses.size());
  evaluator.evaluate(poses, gains);  // to warm up
  const double of_poses = seconds_of([&] { evaluator.evaluate(poses, gains); });
  const std::uint64_t peak = peak_resident_bytes();

  const BeliefGrid::Statistics known = grid.statistics();
  Box half = kHallWorkspace;
  half.max[0] = 0;
  std::uint64_t forgotten = 0;
  const double of_forgetting = seconds_of([&] { forgotten = grid.forget(half); });
  const BeliefGrid::Statistics left = grid.statistics();
  const bool is_right = left.unknown == known.unknown + forgotten && forgotten > 0;

  nlohmann::ordered_json json{
      {"voxel", options.voxel},
      {"coarsest", options.coarsest},
      {"voxels", known.unknown + known.free + known.occupied},
      {"frames", options.frames},
      {"free", known.free},
      {"occupied", known.occupied},
      {"peak_map_and_scene_mb", static_cast<double>(peak_of_map_and_scene - before) / 1e6},
      {"peak_with_scoring_mb", static_cast<double>(peak - before) / 1e6},
      {"map_mb", static_cast<double>(map_bytes) / 1e6},
      {"scene_mb", static_cast<double>(scene->bytes()) / 1e6},
      {"scene_primitives", scene->primitive_count()},
      {"integrate_ms",
       {{"median", 1e3 * median(of_frames)}, {"p95", 1e3 * quantile(of_frames, 0.95)}}},
      {"build_ms", 1e3 * of_build},
      {"update_ms", 1e3 * of_update},
      {"views_per_second", static_cast<double>(poses.size()) / of_poses},
      {"rays_per_view", sensor.camera.ray_table().size()},
      {"forget_ms", 1e3 * of_forgetting},
      {"forgotten", forgotten},
      {"map_mb_after", static_cast<double>(left.bytes) / 1e6},
      {"agree", is_right}};
  add_environment(json, exec.num_threads);
  if (options.json) {
    std::printf("%s\n", json.dump(2).c_str());
  } else {
    for (const auto& [name, value] : json.items()) {
      std::printf("%-22s %s\n", name.c_str(), value.dump().c_str());
    }
  }
  return is_right ? 0 : 1;
}

}  // namespace viewgain::bench
