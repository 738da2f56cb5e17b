// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::detail {

/// What the measure of `config` says of poses; returns how many it was asked about.
std::size_t measure(const GainEvaluator& evaluator, std::span<const Pose> poses,
                    const RaceConfig& config, std::span<double> values,
                    const BatchControl& control);

/// The k best poses by the measure of `config`, less the costs: all by `coarse`, which has fewer
/// rays, and the best `few` by `full`. All by `full` where coarse is null. With costs the values of
/// few rays are brought to the scale of all by some poses that both score.
[[nodiscard]] RacedViews race_by_measure(const GainEvaluator& full, const GainEvaluator* coarse,
                                         std::span<const Pose> poses, std::size_t k,
                                         std::size_t few, const RaceConfig& config,
                                         const BatchControl& control);

}  // namespace viewgain::detail
