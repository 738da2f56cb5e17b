// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace viewgain::bench {

struct MemoryOptions {
  int num_threads = 0;  ///< 0: all hardware threads
  int voxels = 512;     ///< a side
  int views = 8;        ///< noise-free views of the camel
  std::filesystem::path mesh;
};

/// What a map and its scene take [byte].
struct MemoryFigures {
  std::uint64_t peak = 0;   ///< VmHWM, from the frames being there to the scene being built
  std::uint64_t map = 0;    ///< BeliefGrid::Statistics::bytes
  std::uint64_t scene = 0;  ///< VoxelScene::bytes: without what it shares with the map and the BVH
};

/// Integrates the views into camel-N and builds the scene in a child process, this program's
/// subcommand `memory`, and reports how far the child's VmHWM rose above its VmRSS before: peak of
/// map, scene, BVH and all temporaries, the frames and the programs' code not counted. Throws
/// Error(io) if the child fails.
[[nodiscard]] MemoryFigures measure_memory(const MemoryOptions& options);

/// The child's part: prints the figures as JSON. Returns the exit code.
int run_memory(const MemoryOptions& options);

}  // namespace viewgain::bench
