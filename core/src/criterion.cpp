// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/criterion.hpp"

#include <cmath>
#include <limits>

#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

/// det / (xx yy zz) is in (0, 1] and bounds the cancellation in cofactors: above this they are good
/// to about 1e-12, below it a factorisation is worth its divisions.
constexpr double kWellScaled = 1e-4;

struct Inverse {
  SymmetricMatrix3 sigma;
  double determinant;  ///< of the matrix, not of sigma; NaN unless positive definite
};

/// LDLᵀ without pivoting, backward stable for positive definite matrices.
Inverse inverse_by_factorisation(const SymmetricMatrix3& m) {
  const double d1 = m.xx;
  const double l21 = m.xy / d1, l31 = m.xz / d1;
  const double d2 = m.yy - l21 * m.xy;
  const double s32 = m.yz - l21 * m.xz;
  const double l32 = s32 / d2;
  const double d3 = m.zz - l31 * m.xz - l32 * s32;
  if (!(d1 > 0 && d2 > 0 && d3 > 0)) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    return {{kNan, kNan, kNan, kNan, kNan, kNan}, kNan};
  }
  // L⁻¹ is lower triangular with ones on the diagonal.
  const double k21 = -l21, k32 = -l32, k31 = l21 * l32 - l31;
  const double i1 = 1.0 / d1, i2 = 1.0 / d2, i3 = 1.0 / d3;
  return {{i1 + k21 * k21 * i2 + k31 * k31 * i3, i2 + k32 * k32 * i3, i3, k21 * i2 + k31 * k32 * i3,
           k31 * i3, k32 * i3},
          d1 * d2 * d3};
}

Inverse invert(const SymmetricMatrix3& m) {
  const double c_xx = m.yy * m.zz - m.yz * m.yz;
  const double c_xy = m.xz * m.yz - m.xy * m.zz;
  const double c_xz = m.xy * m.yz - m.xz * m.yy;
  const double determinant = m.xx * c_xx + m.xy * c_xy + m.xz * c_xz;
  if (!(m.xx > 0 && m.yy > 0 && determinant > kWellScaled * (m.xx * m.yy * m.zz))) {
    return inverse_by_factorisation(m);
  }
  const double s = 1.0 / determinant;
  return {{c_xx * s, (m.xx * m.zz - m.xz * m.xz) * s, (m.xx * m.yy - m.xy * m.xy) * s, c_xy * s,
           c_xz * s, (m.xy * m.xz - m.xx * m.yz) * s},
          determinant};
}

/// tr(a b)
double trace_of_product(const SymmetricMatrix3& a, const SymmetricMatrix3& b) {
  return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + 2.0 * (a.xy * b.xy + a.xz * b.xz + a.yz * b.yz);
}

/// det(I + Λ⁻¹ B) - 1 = tr(Σ B) + (tr(Λ adj B) + det B) / det Λ: no difference of near-equal
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

/// Rounding may leave a gain of nothing a little below zero. NaN stays NaN.
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
  const auto& names = criterion_names();
  std::string valid;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return static_cast<Criterion>(i);
    valid += (i == 0 ? "" : ", ") + names[i];
  }
  throw Error(ErrorCode::invalid_argument,
              "unknown criterion '" + std::string(name) + "', valid are " + valid);
}

double entropy(const SymmetricMatrix3& information, Criterion criterion) {
  const Inverse inverse = invert(information);
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
  const Inverse prior = invert(before);
  if (criterion == Criterion::log_determinant) {
    return not_negative(0.5 * std::log1p(determinant_ratio_minus_one(before, prior, added)));
  }
  const SymmetricMatrix3 after = invert(before + added).sigma;
  const Eigen::Vector3d drop = covariance_drop(prior.sigma, added, after);
  if (criterion == Criterion::trace) return not_negative(drop.sum());
  // The three ratios Σ_before,kk / Σ_after,kk are 1 + x, 1 + y, 1 + z; their product less one:
  const double x = drop.x() / after.xx, y = drop.y() / after.yy, z = drop.z() / after.zz;
  return not_negative(0.5 * std::log1p(x + y + z + x * y + x * z + y * z + x * y * z));
}

}  // namespace viewgain
