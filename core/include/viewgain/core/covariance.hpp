// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <limits>

#include "viewgain/core/export.hpp"
#include "viewgain/core/noise.hpp"

namespace viewgain {

/// Symmetric 3x3 matrix. Map files store its entries in the same order as this struct. Used for
/// covariances Σ [m²] and information matrices Λ = Σ⁻¹ [m⁻²]. Each use states the coordinate frame.
/// A value type. Members do not check their arguments and never throw.
struct VIEWGAIN_EXPORT SymmetricMatrix3 {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;  ///< entries [m⁻² or m²]

  /// The identity matrix times `scale` [m⁻² or m²].
  [[nodiscard]] static SymmetricMatrix3 identity(double scale = 1.0) {
    return {scale, scale, scale, 0, 0, 0};
  }
  /// From the upper triangle of `m`; the other entries are ignored.
  [[nodiscard]] static SymmetricMatrix3 from(const Eigen::Matrix3d& m) {
    return {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)};
  }
  /// All nine entries.
  [[nodiscard]] Eigen::Matrix3d matrix() const {
    return (Eigen::Matrix3d() << xx, xy, xz, xy, yy, yz, xz, yz, zz).finished();
  }
  /// Entrywise sum.
  SymmetricMatrix3& operator+=(const SymmetricMatrix3& o) {
    xx += o.xx, yy += o.yy, zz += o.zz, xy += o.xy, xz += o.xz, yz += o.yz;
    return *this;
  }
  /// Entrywise sum. The sum of two information matrices fuses independent measurements (eq. (4) of
  /// Foix et al. 2012).
  friend SymmetricMatrix3 operator+(SymmetricMatrix3 a, const SymmetricMatrix3& b) {
    return a += b;
  }
  /// Matrix times vector. `v` may have any unit.
  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& v) const {
    return {xx * v.x() + xy * v.y() + xz * v.z(), xy * v.x() + yy * v.y() + yz * v.z(),
            xz * v.x() + yz * v.y() + zz * v.z()};
  }
  /// Every entry times the factor `s`.
  [[nodiscard]] SymmetricMatrix3 operator*(double s) const {
    return {xx * s, yy * s, zz * s, xy * s, xz * s, yz * s};
  }
  /// Sum of the diagonal [m⁻² or m²].
  [[nodiscard]] double trace() const { return xx + yy + zz; }
  /// Determinant [m⁻⁶ or m⁶], by expansion along the first row.
  [[nodiscard]] double determinant() const {
    return xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  }
  /// Inverse, for condition numbers up to 1e10. NaN unless the matrix is positive definite. Uses
  /// cofactors if they are accurate to about 1e-12, otherwise a factorisation.
  [[nodiscard]] SymmetricMatrix3 inverse() const {
    double ignored;
    return inverse(ignored);
  }
  /// As above. Also sets `determinant` to that of this matrix [m⁻⁶ or m⁶].
  [[nodiscard]] SymmetricMatrix3 inverse(double& determinant) const {
    // The ratio determinant / (xx yy zz) is in (0, 1]. It bounds the cancellation in the cofactors.
    constexpr double kWellScaled = 1e-4;
    const double c_xx = yy * zz - yz * yz, c_zz = xx * yy - xy * xy;
    const double c_xy = xz * yz - xy * zz;
    const double c_xz = xy * yz - xz * yy;
    determinant = xx * c_xx + xy * c_xy + xz * c_xz;
    // Positive definite: the leading minors are positive (Sylvester).
    if (!(xx > 0 && c_zz > 0 && determinant > kWellScaled * (xx * yy * zz))) {
      return inverse_by_factorisation(determinant);
    }
    const double s = 1.0 / determinant;
    return {c_xx * s, (xx * zz - xz * xz) * s, c_zz * s, c_xy * s,
            c_xz * s, (xy * xz - xx * yz) * s};
  }
  bool operator==(const SymmetricMatrix3&) const = default;

 private:
  /// LDLᵀ without pivoting, backward stable for positive definite matrices.
  [[nodiscard]] SymmetricMatrix3 inverse_by_factorisation(double& determinant) const {
    const double d1 = xx;
    const double l21 = xy / d1, l31 = xz / d1;
    const double d2 = yy - l21 * xy;
    const double s32 = yz - l21 * xz;
    const double l32 = s32 / d2;
    const double d3 = zz - l31 * xz - l32 * s32;
    if (!(d1 > 0 && d2 > 0 && d3 > 0)) {
      constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
      determinant = kNan;
      return {kNan, kNan, kNan, kNan, kNan, kNan};
    }
    determinant = d1 * d2 * d3;
    // L⁻¹ is lower triangular with ones on the diagonal.
    const double k21 = -l21, k32 = -l32, k31 = l21 * l32 - l31;
    const double i1 = 1.0 / d1, i2 = 1.0 / d2, i3 = 1.0 / d3;
    return {i1 + k21 * k21 * i2 + k31 * k31 * i3,
            i2 + k32 * k32 * i3,
            i3,
            k21 * i2 + k31 * k32 * i3,
            k31 * i3,
            k32 * i3};
  }
};

/// Information matrix of one reading (one measured depth): Λ_r = a I + (b - a) d dᵀ, with a =
/// σ_lat⁻² and b = σ_ax⁻² (apps/docs/guide/equations.md). d is the unit direction of the ray, in
/// the coordinate frame of the result. Arguments are not checked; sigmas of 0 give infinities.
[[nodiscard]] inline SymmetricMatrix3 measurement_information(const Eigen::Vector3d& d,
                                                              const MeasurementSigmas& sigmas) {
  const double a = 1.0 / (sigmas.lateral * sigmas.lateral);
  const double c = 1.0 / (sigmas.axial * sigmas.axial) - a;
  return {a + c * d.x() * d.x(), a + c * d.y() * d.y(), a + c * d.z() * d.z(),
          c * d.x() * d.y(),     c * d.x() * d.z(),     c * d.y() * d.z()};
}

}  // namespace viewgain
