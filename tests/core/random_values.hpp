// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "viewgain/core/covariance.hpp"

namespace viewgain::test {

/// Seeded source of what the property tests need.
class RandomValues {
 public:
  explicit RandomValues(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  double normal() { return std::normal_distribution<double>()(engine_); }

  /// Uniform in the logarithm.
  double magnitude(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  Eigen::Vector3d vector() { return {normal(), normal(), normal()}; }
  Eigen::Vector3d unit_vector() { return vector().normalized(); }
  Eigen::Matrix3d rotation() {
    const Eigen::Quaterniond q(normal(), normal(), normal(), normal());
    return q.normalized().toRotationMatrix();
  }

  /// Symmetric positive definite, eigenvalues in [low, high], random axes.
  Eigen::Matrix3d spd(double low, double high) {
    const Eigen::Vector3d eigenvalues(magnitude(low, high), magnitude(low, high),
                                      magnitude(low, high));
    const Eigen::Matrix3d R = rotation();
    const Eigen::Matrix3d m = R * eigenvalues.asDiagonal() * R.transpose();
    return 0.5 * (m + m.transpose());
  }

 private:
  std::mt19937_64 engine_;
};

/// m turned by R: R m Rᵀ.
inline SymmetricMatrix3 turned(const SymmetricMatrix3& m, const Eigen::Matrix3d& R) {
  return SymmetricMatrix3::from(R * m.matrix() * R.transpose());
}

}  // namespace viewgain::test
