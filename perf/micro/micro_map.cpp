// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The map: frames in, snapshots and scenes out, files. Times are of the wall, with one thread.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>

#include "measure.hpp"
#include "micro_benchmarks.hpp"
#include "micro_scene.hpp"
#include "scene/brick_table.hpp"
#include "viewgain/grid/hazard.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::bench {
namespace {

constexpr ExecConfig kOneThread{.num_threads = 1};

void scene_build(benchmark::State& state) {
  const BeliefGrid grid =
      test::camel_grid(static_cast<int>(state.range(0)),
                       {MicroScene::get().frames.begin(), MicroScene::get().frames.begin() + 3});
  std::size_t primitives = 0;
  for (auto _ : state) {
    primitives = VoxelScene::build(grid, {}, kOneThread)->primitive_count();
  }
  count(state, "primitives", static_cast<double>(primitives));
}

void snapshot(benchmark::State& state) {
  const MicroScene& micro = MicroScene::get();
  std::size_t leaves = 0;
  for (auto _ : state) leaves = micro.grid.snapshot().leaves.size();
  count(state, "leaves", static_cast<double>(leaves));
}

void hazard_field(benchmark::State& state) {
  const GridSnapshot snapshot = MicroScene::get().grid.snapshot();
  for (auto _ : state) benchmark::DoNotOptimize(HazardField(snapshot).near_box());
  count(state, "leaves", static_cast<double>(snapshot.leaves.size()));
}

void brick_table(benchmark::State& state) {
  const GridSnapshot snapshot = MicroScene::get().grid.snapshot();
  const HazardField hazard(snapshot);
  for (auto _ : state) benchmark::DoNotOptimize(detail::BrickTable(snapshot, hazard).bytes());
  count(state, "leaves", static_cast<double>(snapshot.leaves.size()));
}

// A copy of the map with one frame more; making it is not timed.
BeliefGrid one_more(const MicroScene& micro, FrameIntegrator& integrator, double& seconds) {
  BeliefGrid grid = micro.grid.clone();
  const test::CamelView& view = micro.frames.back();
  seconds = seconds_of([&] { integrator.integrate(grid, view.frame, view.T_world_camera); });
  return grid;
}

void integrate(benchmark::State& state, IntegrationConfig::Carve carve) {
  const MicroScene& micro = MicroScene::get();
  FrameIntegrator integrator(micro.sensor, {.carve = carve}, kOneThread);
  for (auto _ : state) {
    double seconds = 0;
    (void)one_more(micro, integrator, seconds);
    state.SetIterationTime(seconds);
  }
  count(state, "pixels", static_cast<double>(micro.frames.back().frame.depth.size()));
}

void scene_update(benchmark::State& state) {
  const MicroScene& micro = MicroScene::get();
  FrameIntegrator integrator(micro.sensor, {}, kOneThread);
  double seconds = 0;
  const BeliefGrid grid = one_more(micro, integrator, seconds);
  std::size_t primitives = 0;
  for (auto _ : state) {
    const auto scene = VoxelScene::update(micro.scene, grid, kOneThread);
    primitives = scene->primitive_count();
  }
  count(state, "primitives", static_cast<double>(primitives));
}

// A file of this process's own.
class TemporaryFile {
 public:
  TemporaryFile()
      : path_(std::filesystem::temp_directory_path() /
              (std::string("viewgain-micro-") + std::to_string(getpid()) + ".vdb")) {}
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

void vdb_save(benchmark::State& state) {
  const MicroScene& micro = MicroScene::get();
  const TemporaryFile file;
  for (auto _ : state) save_vdb(micro.grid, file.path());
  count(state, "bytes", static_cast<double>(std::filesystem::file_size(file.path())));
}

void vdb_load(benchmark::State& state) {
  const MicroScene& micro = MicroScene::get();
  const TemporaryFile file;
  save_vdb(micro.grid, file.path());
  for (auto _ : state) benchmark::DoNotOptimize(load_vdb(file.path()).voxel_count());
  count(state, "bytes", static_cast<double>(std::filesystem::file_size(file.path())));
}

}  // namespace

void register_map_benchmarks() {
  const auto wall = [](auto* benchmark) {
    return benchmark->Unit(benchmark::kMillisecond)->UseRealTime();
  };
  wall(benchmark::RegisterBenchmark("scene_build", scene_build))->Arg(64)->Arg(128)->Arg(256);
  wall(benchmark::RegisterBenchmark("snapshot", snapshot));
  wall(benchmark::RegisterBenchmark("scene_update", scene_update));
  wall(benchmark::RegisterBenchmark("hazard_field", hazard_field));
  wall(benchmark::RegisterBenchmark("brick_table", brick_table));
  for (const auto& [name, carve] :
       {std::pair("integrate/cones", IntegrationConfig::Carve::cones),
        std::pair("integrate/lines", IntegrationConfig::Carve::lines)}) {
    benchmark::RegisterBenchmark(name, integrate, carve)
        ->Unit(benchmark::kMillisecond)
        ->UseManualTime();
  }
  wall(benchmark::RegisterBenchmark("vdb_save", vdb_save));
  wall(benchmark::RegisterBenchmark("vdb_load", vdb_load));
}

}  // namespace viewgain::bench
