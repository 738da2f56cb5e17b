// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "map_file.hpp"

#include <algorithm>
#include <cstdio>
#include <string>
#include <system_error>

#include "viewgain/core/error.hpp"

namespace viewgain::app {
namespace {

/// The name's ending with capital letters made small.
std::string ending(const std::filesystem::path& path) {
  std::string text = path.extension().string();
  std::transform(text.begin(), text.end(), text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text;
}

}  // namespace

bool is_octomap(const std::filesystem::path& path) {
  return ending(path) == ".ot" || ending(path) == ".bt";
}

BeliefGrid load_map(const std::filesystem::path& path, const Sensor* sensor, OctomapConfig config) {
  if (!is_octomap(path)) return load_vdb(path);
  if (sensor != nullptr && !config.prior_sigma) {
    config.prior_sigma = default_prior_sigma(octomap_resolution(path), *sensor);
  }
  return load_octomap(path, config);
}

void check_map_name(const std::filesystem::path& path) {
  const std::string end = ending(path);
  if (end == ".bt") {
    throw Error(ErrorCode::invalid_argument,
                path.string() + ": .bt files are read but not written; .ot ones are");
  }
  if (end == ".vdb" || end == ".ot") return;
  std::error_code code;
  const std::filesystem::file_status status = std::filesystem::status(path, code);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) return;
  throw Error(ErrorCode::invalid_argument,
              path.string() + ": the name of a map to write must end in .vdb or .ot");
}

LostInTree save_map(const BeliefGrid& grid, const std::filesystem::path& path,
                    const VdbWriteConfig& config) {
  check_map_name(path);
  if (!is_octomap(path)) {
    save_vdb(grid, path, config);
    return {};
  }
  save_octomap(grid, path);
  LostInTree lost;
  for (const BeliefBlockAt& block : grid.belief_blocks()) {
    lost.beliefs += block.beliefs->beliefs.size();
  }
  lost.views = grid.views().size();
  lost.T_world_grid = !octomap_keeps_frame(grid);
  if (lost.T_world_grid) {
    std::fprintf(
        stderr,
        "viewgain: warning: %s: the tree is in the map's own frame: T_world_grid, which is "
        "no shift by whole voxels within a tree's space, is lost\n",
        path.string().c_str());
  }
  return lost;
}

}  // namespace viewgain::app
