// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::bench {

// The calls of the library that some bars wait for, each in one place. A library that does not have
// a call gives nothing, and the bars that need it are left out.

/// Exact search with pruning.
template <typename Evaluator>
concept Prunes = requires(const Evaluator& evaluator, std::span<const Pose> poses) {
  evaluator.best(poses, std::size_t{1}).indices.at(0);
};

/// Racing.
template <typename Evaluator>
concept Races = requires(const Evaluator& evaluator, std::span<const Pose> poses) {
  evaluator.race(poses, std::size_t{1}).indices.at(0);
};

/// The best pose by exact search with pruning.
template <typename Evaluator>
[[nodiscard]] std::optional<std::size_t> pruned_best(const Evaluator& evaluator,
                                                     std::span<const Pose> poses) {
  if constexpr (Prunes<Evaluator>) return evaluator.best(poses, 1).indices.at(0);
  return std::nullopt;
}

/// The best pose by racing.
template <typename Evaluator>
[[nodiscard]] std::optional<std::size_t> raced_best(const Evaluator& evaluator,
                                                    std::span<const Pose> poses) {
  if constexpr (Races<Evaluator>) return evaluator.race(poses, 1).indices.at(0);
  return std::nullopt;
}

/// The scene of what a grid is now, made from an earlier one; null if the library cannot.
template <typename Scene>
[[nodiscard]] std::shared_ptr<const Scene> updated_scene(const std::shared_ptr<const Scene>& before,
                                                         const BeliefGrid& grid,
                                                         const ExecConfig& exec) {
  if constexpr (requires { Scene::update(before, grid.snapshot(), exec); }) {
    return Scene::update(before, grid.snapshot(), exec);
  } else if constexpr (requires { Scene::update(before, grid.snapshot()); }) {
    return Scene::update(before, grid.snapshot());
  } else {
    return nullptr;
  }
}

}  // namespace viewgain::bench
