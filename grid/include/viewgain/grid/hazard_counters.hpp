// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Counts how often measured rays met the surface in unknown space, and how often the hazard model
/// (HazardConfig::Model) predicted that. Each class of distance from known surface has one pair of
/// counts. A map contains them. They are integers, so all machines get the same result.
/// Arguments are not checked.
struct VIEWGAIN_EXPORT HazardCounters {
  /// Number of distance classes.
  static constexpr std::size_t kClasses = 8;
  /// Upper limits of the classes except the last [decay lengths].
  static constexpr std::array<double, kClasses - 1> kEnds{0.5, 1, 1.5, 2, 3, 4, 5};
  /// Total weight of a frame. It does not depend on the number of rays, because the rays of one
  /// frame are strongly correlated.
  static constexpr std::int64_t kFrame = 1'000'000;
  /// When a frame is added, earlier counts are multiplied by kKeptOf10 / 10, because hazards
  /// decrease as the map grows.
  static constexpr std::int64_t kKeptOf10 = 7;
  /// Weight of the prior in each class [1 / kFrame].
  static constexpr double kPrior = 2.0 * kFrame / kClasses;

  /// Counts of one distance class.
  struct Class {
    std::int64_t expected = 0;  ///< number of meetings that the model predicted [1 / kFrame]
    std::int64_t met = 0;       ///< number of observed meetings [1 / kFrame]
    bool operator==(const Class&) const = default;
  };
  std::array<Class, kClasses> classes{};  ///< smallest distance first

  /// Class of a distance from known surface [decay lengths].
  [[nodiscard]] static constexpr std::size_t class_of(double distance) {
    std::size_t k = 0;
    while (k < kEnds.size() && distance >= kEnds[k]) ++k;
    return k;
  }

  /// Factor for the model's rates in class k: the mean of a Gamma posterior. The prior has mean 1
  /// and, over all classes together, the weight of two frames.
  [[nodiscard]] double factor(std::size_t k) const {
    return (kPrior + static_cast<double>(classes[k].met)) / weight(k);
  }
  /// Weight of the factor of class k: predicted meetings plus the prior's weight.
  [[nodiscard]] double weight(std::size_t k) const {
    return kPrior + static_cast<double>(classes[k].expected);
  }

  /// Whether nothing has been counted.
  [[nodiscard]] bool empty() const { return *this == HazardCounters{}; }
  bool operator==(const HazardCounters&) const = default;
};

}  // namespace viewgain
