// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace viewgain::bench {

struct MemoryOptions {
  int num_threads = 0;  ///< 0: all hardware threads
  int voxels = 512;     ///< per side
  int views = 8;        ///< number of noise-free views of the camel
  std::filesystem::path mesh;
};

/// Memory of a map and its scene [byte].
struct MemoryFigures {
  std::uint64_t peak = 0;   ///< increase of VmHWM from the ready frames to the built scene
  std::uint64_t map = 0;    ///< BeliefGrid::Statistics::bytes
  std::uint64_t scene = 0;  ///< VoxelScene::bytes, without the BVH and parts shared with the map
};

/// Integrates the views into camel-N and builds the scene in a child process, the subcommand
/// `memory`. Returns by how much the child's VmHWM rose above its earlier VmRSS. This is the peak
/// of map, scene, BVH and all temporaries, without the frames and the program's code. Throws
/// Error(io) if the child fails.
[[nodiscard]] MemoryFigures measure_memory(const MemoryOptions& options);

/// The part of the child: prints the figures as JSON. Returns the exit code.
int run_memory(const MemoryOptions& options);

}  // namespace viewgain::bench
