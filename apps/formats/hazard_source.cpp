// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "hazard_source.hpp"

#include <cmath>
#include <memory>

#include "file_names.hpp"
#include "values.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/text.hpp"
#include "viewgain/grid/vdb_io.hpp"

namespace viewgain::app {

bool is_hazard_file(const std::string& value) { return small_ending(value) == ".vdb"; }

HazardConfig hazard_source(const std::string& hazard, std::optional<double> object_size,
                           const BeliefGrid& grid) {
  if (object_size && !(*object_size > 0 && std::isfinite(*object_size))) {
    throw Error(ErrorCode::invalid_argument,
                "--object-size " + short_text(*object_size) + " must be positive and finite");
  }
  HazardConfig config;
  config.object_size = object_size;
  if (hazard.empty()) return config;
  if (is_hazard_file(hazard)) {
    config.volume = std::make_shared<const HazardVolume>(load_hazard_vdb(hazard, grid));
    return config;
  }
  const double rate = parse_numbers("--hazard", hazard, 1, 1)[0];
  if (!(rate >= 0 && std::isfinite(rate))) {
    throw Error(ErrorCode::invalid_argument,
                "--hazard " + hazard + " must be at least 0 and finite");
  }
  return constant_hazard(rate, grid, object_size);
}

}  // namespace viewgain::app
