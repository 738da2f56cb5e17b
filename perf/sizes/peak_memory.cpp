// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "peak_memory.hpp"

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "environment.hpp"
#include "resident_memory.hpp"
#include "support/camel_scene.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/raycast/voxel_scene.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::bench {
namespace {

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

}  // namespace

int run_memory(const MemoryOptions& options) {
  const ExecConfig exec{.num_threads = ThreadPool(options.num_threads).num_threads()};
  const auto views = test::camel_views(static_cast<std::size_t>(options.views), options.mesh);
  reset_peak_memory();  // making the frames left something behind
  const std::uint64_t before = resident_bytes();
  BeliefGrid grid = test::empty_camel_grid(options.voxels);
  FrameIntegrator integrator(sensor_preset("sr4000"), {}, exec);
  std::shared_ptr<const VoxelScene> scene;
  for (const test::CamelView& view : views) {
    integrator.integrate(grid, view.frame, view.T_world_camera);
  }
  scene = VoxelScene::build(grid, {}, exec);
  const std::uint64_t peak = peak_resident_bytes();

  nlohmann::ordered_json json{{"scene", "camel-" + std::to_string(options.voxels)},
                              {"views", options.views},
                              {"peak_bytes", peak > before ? peak - before : 0},
                              {"map_bytes", grid.statistics().bytes},
                              {"scene_bytes", scene->bytes()}};
  add_environment(json, exec.num_threads);
  std::printf("%s\n", json.dump(2).c_str());
  return 0;
}

MemoryFigures measure_memory(const MemoryOptions& options) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string command =
      quoted(program) + " memory --voxels " + std::to_string(options.voxels) + " --views " +
      std::to_string(options.views) + " --threads " + std::to_string(options.num_threads) +
      " --mesh " + quoted(options.mesh.string());
  FILE* pipe = popen(command.c_str(), "r");
  std::string out;
  if (pipe != nullptr) {
    std::array<char, 4096> buffer;
    for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
      out.append(buffer.data(), n);
    }
  }
  const int status = pipe == nullptr ? -1 : pclose(pipe);
  if (status == -1 || !WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw Error(ErrorCode::io, command + ": failed");
  }
  const auto json = nlohmann::json::parse(out);
  return {json.at("peak_bytes"), json.at("map_bytes"), json.at("scene_bytes")};
}

}  // namespace viewgain::bench
