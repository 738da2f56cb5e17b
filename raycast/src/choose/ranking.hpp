// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace viewgain::detail {

/// Throws Error(invalid_argument) if there are costs but not one a pose, or one is not finite.
void check_costs(std::span<const double> costs, std::size_t poses);

/// As best_indices(), of numbers.
[[nodiscard]] std::vector<std::size_t> largest(std::span<const double> values, std::size_t k);

}  // namespace viewgain::detail
