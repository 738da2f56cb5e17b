// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/criterion.hpp"

#include <cmath>
#include <limits>

#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

struct Inverse {
  explicit Inverse(const SymmetricMatrix3& m) : sigma(m.inverse(determinant)) {}

  double determinant = 0;  ///< of the matrix, not of sigma; NaN unless positive definite
  SymmetricMatrix3 sigma;
};

/// tr(a b)
double trace_of_product(const SymmetricMatrix3& a, const SymmetricMatrix3& b) {
  return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + 2.0 * (a.xy * b.xy + a.xz * b.xz + a.yz * b.yz);
}

/// det(I + Λ⁻¹ B) - 1 = tr(Σ B) + (tr(Λ adj B) + det B) / det Λ, which subtracts no nearly equal
/// numbers.
double determinant_ratio_minus_one(const SymmetricMatrix3& before, const Inverse& inverse,
                                   const SymmetricMatrix3& b) {
  const SymmetricMatrix3 adjugate{b.yy * b.zz - b.yz * b.yz, b.xx * b.zz - b.xz * b.xz,
                                  b.xx * b.yy - b.xy * b.xy, b.xz * b.yz - b.xy * b.zz,
                                  b.xy * b.yz - b.xz * b.yy, b.xy * b.xz - b.xx * b.yz};
  const double determinant = b.xx * adjugate.xx + b.xy * adjugate.xy + b.xz * adjugate.xz;
  return trace_of_product(inverse.sigma, b) +
         (trace_of_product(before, adjugate) + determinant) / inverse.determinant;
}

/// Diagonal of Σ_before - Σ_after = Σ_before B Σ_after.
Eigen::Vector3d covariance_drop(const SymmetricMatrix3& s, const SymmetricMatrix3& b,
                                const SymmetricMatrix3& t) {
  const Eigen::Vector3d column_x{t.xx, t.xy, t.xz};
  const Eigen::Vector3d column_y{t.xy, t.yy, t.yz};
  const Eigen::Vector3d column_z{t.xz, t.yz, t.zz};
  return {Eigen::Vector3d(s.xx, s.xy, s.xz).dot(b * column_x),
          Eigen::Vector3d(s.xy, s.yy, s.yz).dot(b * column_y),
          Eigen::Vector3d(s.xz, s.yz, s.zz).dot(b * column_z)};
}

/// Rounding can make a gain of zero slightly negative. NaN stays NaN.
double not_negative(double value) { return value < 0 ? 0.0 : value; }

}  // namespace

const std::vector<std::string>& criterion_names() {
  static const std::vector<std::string> names{"log_diagonal", "log_determinant", "trace"};
  return names;
}

std::string_view criterion_name(Criterion criterion) {
  return criterion_names().at(static_cast<std::size_t>(criterion));
}

Criterion parse_criterion(std::string_view name) {
  return static_cast<Criterion>(place_of_name(name, criterion_names(), "criterion"));
}

double entropy(const SymmetricMatrix3& information, Criterion criterion) {
  const Inverse inverse(information);
  const SymmetricMatrix3& sigma = inverse.sigma;
  switch (criterion) {
    case Criterion::log_diagonal:
      return 0.5 * (std::log(sigma.xx) + std::log(sigma.yy) + std::log(sigma.zz));
    case Criterion::log_determinant:
      return -0.5 * std::log(inverse.determinant);
    case Criterion::trace:
      return sigma.trace();
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double entropy_reduction(const SymmetricMatrix3& before, const SymmetricMatrix3& added,
                         Criterion criterion) {
  const Inverse prior(before);
  if (criterion == Criterion::log_determinant) {
    return not_negative(0.5 * std::log1p(determinant_ratio_minus_one(before, prior, added)));
  }
  const SymmetricMatrix3 after = (before + added).inverse();
  const Eigen::Vector3d drop = covariance_drop(prior.sigma, added, after);
  if (criterion == Criterion::trace) return not_negative(drop.sum());
  // The three ratios Σ_before,kk / Σ_after,kk are 1 + x, 1 + y, 1 + z; their product less one:
  const double x = drop.x() / after.xx, y = drop.y() / after.yy, z = drop.z() / after.zz;
  return not_negative(0.5 * std::log1p(x + y + z + x * y + x * z + y * z + x * y * z));
}

}  // namespace viewgain
