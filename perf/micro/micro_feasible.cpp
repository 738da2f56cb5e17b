// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Which poses are possible: bodies alone, and bodies and what the views would show, of poses at
// some distance from the object, where nothing is within the sensor's least range, and near it.
#include <benchmark/benchmark.h>

#include <string>

#include "micro_benchmarks.hpp"
#include "micro_scene.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/raycast/feasibility.hpp"

namespace viewgain::bench {
namespace {

constexpr std::size_t kPoses = 500;
constexpr double kFar = 0.6, kNear = 0.35;  // of the camera from the object's middle [m]

std::shared_ptr<const VoxelScene> scene_with(int obstacles) {
  Obstacles walls;
  if (obstacles > 0) walls.boxes.push_back({{-1, -1, -0.52}, {1, 1, -0.5}});
  if (obstacles > 1) walls.boxes.push_back({{0.5, -1, -1}, {0.52, 1, 1}});
  return VoxelScene::build(MicroScene::get().grid, {walls}, {.num_threads = 1});
}

FeasibilityConfig config_of(bool with_sight) {
  FeasibilityConfig config;
  if (with_sight) config.sensor = MicroScene::get().sensor;
  return config;
}

void check(benchmark::State& state, bool with_sight, double radius, int obstacles) {
  const FeasibilityChecker checker(scene_with(obstacles), config_of(with_sight),
                                   {.num_threads = 1});
  const std::vector<Pose> poses = sphere_poses(kPoses, radius);
  std::size_t next = 0;
  for (auto _ : state) benchmark::DoNotOptimize(checker.check(poses[next++ % poses.size()]));
  count(state, "poses", 1);
}

void follow(benchmark::State& state) {
  const MicroScene& micro = MicroScene::get();
  const FeasibilityChecker checker(micro.scene, config_of(true), {.num_threads = 1});
  for (auto _ : state) benchmark::DoNotOptimize(&checker.with_scene(micro.scene).scene());
  count(state, "scenes", 1);
}

}  // namespace

void register_feasible_benchmarks() {
  for (const int obstacles : {0, 2}) {
    const std::string count =
        std::string(1, '/').append(std::to_string(obstacles)).append("_obstacles");
    const auto add = [&](const std::string& name, bool with_sight, double radius) {
      benchmark::RegisterBenchmark((name + count).c_str(), check, with_sight, radius, obstacles)
          ->Unit(benchmark::kMicrosecond);
    };
    add("feasible/body", false, kNear);
    add("feasible/view_from_afar", true, kFar);
    add("feasible/view_from_near", true, kNear);
  }
  benchmark::RegisterBenchmark("feasible/with_scene", follow)->Unit(benchmark::kMicrosecond);
}

}  // namespace viewgain::bench
