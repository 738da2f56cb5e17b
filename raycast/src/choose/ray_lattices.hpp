// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "gain/evaluator_core.hpp"

namespace viewgain::detail {

/// The step of a lattice that leaves about so many of a view's rays; at least 1.
[[nodiscard]] int step_for_rays(const EvaluatorCore& core, double rays);
/// The smallest step of a lattice that has at most this share of a view's rays, but not under 100.
[[nodiscard]] int step_for_share(const EvaluatorCore& core, double share);

/// In the middle of the image.
[[nodiscard]] RayLattice centred_lattice(const EvaluatorCore& core, int step);
/// Somewhere: any ray has the same chance to be in it.
[[nodiscard]] RayLattice random_lattice(const EvaluatorCore& core, int step, std::uint64_t seed);

}  // namespace viewgain::detail
