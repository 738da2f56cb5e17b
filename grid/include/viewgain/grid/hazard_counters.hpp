// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Counts, per class of distance from known surface, how often real rays met the surface in unknown
/// space, and how often the hazard model predicted it. Part of a map. The counts are integers, so
/// that all machines get the same result. Members check nothing: a class must be below kClasses.
struct VIEWGAIN_EXPORT HazardCounters {
  /// Number of distance classes.
  static constexpr std::size_t kClasses = 8;
  /// Upper limits of the classes [decay lengths]; the last class has none.
  static constexpr std::array<double, kClasses - 1> kEnds{0.5, 1, 1.5, 2, 3, 4, 5};
  /// Total weight of a frame. It does not depend on the number of rays, because the rays of a frame
  /// are strongly correlated.
  static constexpr std::int64_t kFrame = 1'000'000;
  /// When a frame is added, the counts of earlier frames are multiplied by kKeptOf10 / 10, because
  /// hazards decrease as the map grows.
  static constexpr std::int64_t kKeptOf10 = 7;
  /// Weight of the prior per class [1 / kFrame].
  static constexpr double kPrior = 2.0 * kFrame / kClasses;

  /// Counts of one distance class.
  struct Class {
    std::int64_t expected = 0;  ///< number of meetings that the model predicted [1 / kFrame]
    std::int64_t met = 0;       ///< number of observed meetings [1 / kFrame]
    bool operator==(const Class&) const = default;
  };
  std::array<Class, kClasses> classes{};  ///< nearest class first

  /// Class of a distance [decay lengths].
  [[nodiscard]] static constexpr std::size_t class_of(double distance) {
    std::size_t k = 0;
    while (k < kEnds.size() && distance >= kEnds[k]) ++k;
    return k;
  }

  /// Factor for the model's rates in a class. It is the mean of a Gamma posterior. Its prior has
  /// mean 1 and the weight of two frames, summed over all classes.
  [[nodiscard]] double factor(std::size_t k) const {
    return (kPrior + static_cast<double>(classes[k].met)) / weight(k);
  }
  /// Weight of the factor: predicted meetings plus the prior's weight.
  [[nodiscard]] double weight(std::size_t k) const {
    return kPrior + static_cast<double>(classes[k].expected);
  }

  /// Whether nothing has been counted.
  [[nodiscard]] bool empty() const { return *this == HazardCounters{}; }
  bool operator==(const HazardCounters&) const = default;
};

}  // namespace viewgain
