// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "voxel_values.hpp"

#include <algorithm>
#include <cmath>

namespace viewgain::detail {
namespace {

constexpr double kPart = 4096;        // first parts of -log2 q are multiples of its reciprocal
constexpr double kAllAbsorbed = 200;  // in place of -log2 0: nothing is left in single precision

double entropy_of(double p) {
  if (!(p > 0 && p < 1)) return 0;
  return -p * std::log(p) - (1 - p) * std::log(1 - p);
}

}  // namespace

VoxelValues::VoxelValues(const ClassicConfig& config) {
  static_assert(kMaxCode < 128 && kZeroCode < kPassed);
  const bool shipped = config.semantics == GainSemantics::shipped;
  for (int i = 0; i <= kMaxCode; ++i) {
    const auto code = static_cast<std::uint8_t>(i);
    const auto at = static_cast<std::size_t>(i);
    const bool is_known = code != kUnknownCode;
    const double p = is_known ? 1 / (1 + std::exp(-static_cast<double>(code_log_odds(code))))
                              : config.unknown_prior;
    // p rises with the code.
    const bool is_occupied = shipped ? p > config.occupied_above : detail::is_occupied(code);
    const bool is_free = shipped ? p < config.free_below : !detail::is_occupied(code);
    if (is_known && is_free) free_end = i + 1;
    if (is_known && is_occupied && occupied_begin > i) occupied_begin = i;
    const double H = entropy_of(p), q = shipped ? p : 1 - p;
    entropy[at] = static_cast<float>(H);
    if (i > kZeroCode) continue;
    passed_entropy[at] = entropy[at];
    const double absorbs = q > 0 ? std::min(-std::log2(q), kAllAbsorbed) : kAllAbsorbed;
    const double first = std::floor(absorbs * kPart) / kPart;
    absorbed[at] = static_cast<float>(first);
    absorbed_rest[at] = static_cast<float>(absorbs - first);
    per_taken[at] = H > 0 ? static_cast<float>(H / (1 - q)) : 0.0F;
  }
}

}  // namespace viewgain::detail
