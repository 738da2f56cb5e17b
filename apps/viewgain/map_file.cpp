// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "map_file.hpp"

#include "viewgain/core/error.hpp"

namespace viewgain::app {

bool is_octomap(const std::filesystem::path& path) {
  return path.extension() == ".ot" || path.extension() == ".bt";
}

BeliefGrid load_map(const std::filesystem::path& path, const Sensor* sensor, OctomapConfig config) {
  if (!is_octomap(path)) return load_vdb(path);
  if (sensor != nullptr && !config.prior_sigma) {
    config.prior_sigma = default_prior_sigma(octomap_resolution(path), *sensor);
  }
  return load_octomap(path, config);
}

void check_map_name(const std::filesystem::path& path) {
  if (path.extension() == ".bt") {
    throw Error(ErrorCode::invalid_argument,
                path.string() + ": .bt files are read but not written; .ot ones are");
  }
}

void save_map(const BeliefGrid& grid, const std::filesystem::path& path,
              const VdbWriteConfig& config) {
  check_map_name(path);
  if (is_octomap(path)) {
    save_octomap(grid, path);
  } else {
    save_vdb(grid, path, config);
  }
}

}  // namespace viewgain::app
