// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "voxel_values.hpp"

#include <cmath>

namespace viewgain::detail {
namespace {

double entropy_of(double p) {
  if (!(p > 0 && p < 1)) return 0;
  return -p * std::log(p) - (1 - p) * std::log(1 - p);
}

std::uint8_t kind_of(const ClassicConfig& config, std::uint8_t code, double p) {
  if (config.semantics == GainSemantics::shipped) {
    if (p > config.occupied_above) return VoxelValues::kIsOccupied;
    return p < config.free_below ? VoxelValues::kIsFree : VoxelValues::kIsUnknown;
  }
  if (code == OccupancyCodes::kUnknown) return VoxelValues::kIsUnknown;
  return OccupancyCodes::is_occupied(code) ? VoxelValues::kIsOccupied : VoxelValues::kIsFree;
}

}  // namespace

VoxelValues::VoxelValues(const ClassicConfig& config)
    : sums(OccupancyCodes::kCount * kRow), powers(OccupancyCodes::kCount * kRow) {
  for (std::size_t i = 0; i < entropy.size(); ++i) {
    const auto code = static_cast<std::uint8_t>(i);
    const double p = code == OccupancyCodes::kUnknown
                         ? config.unknown_prior
                         : 1 / (1 + std::exp(-static_cast<double>(OccupancyCodes::log_odds(code))));
    const double q = config.semantics == GainSemantics::shipped ? p : 1 - p;
    entropy[i] = entropy_of(p);
    kinds[i] = kind_of(config, code, p);
    double sum = 0, power = 1;
    for (std::size_t n = 0; n < kRow; ++n) {
      sums[i * kRow + n] = sum;
      powers[i * kRow + n] = power;
      sum += power * entropy[i];
      power *= q;
    }
  }
}

}  // namespace viewgain::detail
