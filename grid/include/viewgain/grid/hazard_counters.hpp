// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// How often real rays met the surface in unknown space, against how often the hazard model said
/// that they would, by class of distance from known surface. Part of a map. Integers, so that every
/// machine has the same. Members check nothing: a class must be below kClasses.
struct VIEWGAIN_EXPORT HazardCounters {
  /// Classes of distance from known surface.
  static constexpr std::size_t kClasses = 8;
  /// Where the classes end [decay lengths]; the last has no end.
  static constexpr std::array<double, kClasses - 1> kEnds{0.5, 1, 1.5, 2, 3, 4, 5};
  /// What a frame counts for in all. Its rays say much the same, so their number does not count.
  static constexpr std::int64_t kFrame = 1'000'000;
  /// What earlier frames are left with when one is added, as late hazards are lower than early
  /// ones.
  static constexpr std::int64_t kKeptOf10 = 7;
  /// Weight of the prior in each class [1 / kFrame].
  static constexpr double kPrior = 2.0 * kFrame / kClasses;

  /// What was counted at one class of distance.
  struct Class {
    std::int64_t expected = 0;  ///< meetings by the model [1 / kFrame]
    std::int64_t met = 0;       ///< meetings
    bool operator==(const Class&) const = default;
  };
  std::array<Class, kClasses> classes{};  ///< the nearest first

  /// Class of a distance [decay lengths].
  [[nodiscard]] static constexpr std::size_t class_of(double distance) {
    std::size_t k = 0;
    while (k < kEnds.size() && distance >= kEnds[k]) ++k;
    return k;
  }

  /// What the model's rates in a class are multiplied by: mean of the Gamma posterior, with a prior
  /// at 1 that is worth two frames over all classes.
  [[nodiscard]] double factor(std::size_t k) const {
    return (kPrior + static_cast<double>(classes[k].met)) / weight(k);
  }
  /// What it is worth: meetings expected, with the prior's.
  [[nodiscard]] double weight(std::size_t k) const {
    return kPrior + static_cast<double>(classes[k].expected);
  }

  /// Has nothing been counted?
  [[nodiscard]] bool empty() const { return *this == HazardCounters{}; }
  bool operator==(const HazardCounters&) const = default;
};

}  // namespace viewgain
