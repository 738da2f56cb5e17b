// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The map: snapshots, tables of bricks, files. Times are of the wall, with one thread.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>

#include "micro_benchmarks.hpp"
#include "micro_scene.hpp"
#include "scene/brick_table.hpp"
#include "viewgain/grid/hazard.hpp"
#include "viewgain/grid/vdb_io.hpp"

namespace viewgain::bench {
namespace {

void snapshot(benchmark::State& state) {
  const MicroScene& micro = MicroScene::get();
  std::size_t leaves = 0;
  for (auto _ : state) leaves = micro.grid.snapshot().leaves.size();
  count(state, "leaves", static_cast<double>(leaves));
}

void brick_table(benchmark::State& state) {
  const GridSnapshot snapshot = MicroScene::get().grid.snapshot();
  const HazardField hazard(snapshot);
  for (auto _ : state) benchmark::DoNotOptimize(detail::BrickTable(snapshot, hazard).bytes());
  count(state, "leaves", static_cast<double>(snapshot.leaves.size()));
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
  wall(benchmark::RegisterBenchmark("snapshot", snapshot));
  wall(benchmark::RegisterBenchmark("brick_table", brick_table));
  wall(benchmark::RegisterBenchmark("vdb_save", vdb_save));
  wall(benchmark::RegisterBenchmark("vdb_load", vdb_load));
}

}  // namespace viewgain::bench
