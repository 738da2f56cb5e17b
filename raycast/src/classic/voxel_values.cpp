// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "voxel_values.hpp"

#include <cmath>

#include "classic_table.hpp"

namespace viewgain::detail {
namespace {

double entropy_of(double p) {
  if (!(p > 0 && p < 1)) return 0;
  return -p * std::log(p) - (1 - p) * std::log(1 - p);
}

}  // namespace

VoxelValues::VoxelValues(const ClassicConfig& config)
    : runs(std::size_t{OccupancyCodes::kCount} << kRowBits),
      occupied_begin(OccupancyCodes::kCount) {
  static_assert(sizeof(Run) == kRunDoubles * sizeof(double));
  static_assert((3U << ClassicTable::kLargestShift) - 2 < 1U << kRowBits);
  const bool shipped = config.semantics == GainSemantics::shipped;
  for (int i = 0; i < OccupancyCodes::kCount; ++i) {
    const auto code = static_cast<std::uint8_t>(i);
    const bool is_known = code != OccupancyCodes::kUnknown;
    const double p = is_known
                         ? 1 / (1 + std::exp(-static_cast<double>(OccupancyCodes::log_odds(code))))
                         : config.unknown_prior;
    // p rises with the code.
    const bool is_occupied =
        shipped ? p > config.occupied_above : OccupancyCodes::is_occupied(code);
    const bool is_free = shipped ? p < config.free_below : !OccupancyCodes::is_occupied(code);
    if (is_known && is_free) free_end = i + 1;
    if (is_known && is_occupied && occupied_begin > i) occupied_begin = i;
    const double H = entropy_of(p), q = shipped ? p : 1 - p;
    double sum = 0, power = 1;
    Run* row = &runs[static_cast<std::size_t>(i) << kRowBits];
    for (std::size_t n = 0; n < std::size_t{1} << kRowBits; ++n) {
      row[n] = {sum, power, static_cast<double>(n) * H, 0};
      sum += power * H;
      power *= q;
    }
  }
}

}  // namespace viewgain::detail
