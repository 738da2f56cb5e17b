// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "viewgain/literature/classic_gains.hpp"
#include "viewgain/support/log_odds_code.hpp"

namespace viewgain::detail {

/// What voxels weigh by the code of their log-odds, for one semantics; q is what each lets through.
struct VoxelValues {
  /// Codes of voxels that rays go on through are below this.
  static constexpr std::size_t kPassed = 64;
  /// -log2 q in two parts. Multiples of the first by numbers of voxels, and sums of such, are exact
  /// in single precision; the second is small, so that its rounding does not matter.
  alignas(64) std::array<float, kPassed> absorbed{}, absorbed_rest{};
  /// H / (1 - q): n voxels in a row have Σ P H = this times what they take of P.
  alignas(64) std::array<float, kPassed> per_taken{};
  alignas(64) std::array<float, kPassed> passed_entropy{};  ///< H of these [nat]
  alignas(64) std::array<float, 128> entropy{};             ///< H of all codes [nat]
  /// Known voxels count as free below, as occupied from there on; others, and those that no reading
  /// told of, as unknown.
  std::int32_t free_end = 0, occupied_begin = kMaxCode + 1;

  explicit VoxelValues(const ClassicConfig& config);
};

}  // namespace viewgain::detail
