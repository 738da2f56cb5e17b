// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "viewgain/core/export.hpp"
#include "viewgain/core/noise.hpp"

namespace viewgain {

/// Symmetric 3x3 matrix, six numbers in the order of the map files: diagonal, then xy, xz, yz. Used
/// for information matrices Λ = Σ⁻¹ [m⁻²] and covariances Σ [m²]. A value type.
struct VIEWGAIN_EXPORT SymmetricMatrix3 {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  [[nodiscard]] static SymmetricMatrix3 identity(double scale = 1.0) {
    return {scale, scale, scale, 0, 0, 0};
  }
  [[nodiscard]] static SymmetricMatrix3 from(const Eigen::Matrix3d& m) {
    return {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)};
  }
  [[nodiscard]] Eigen::Matrix3d matrix() const {
    return (Eigen::Matrix3d() << xx, xy, xz, xy, yy, yz, xz, yz, zz).finished();
  }
  SymmetricMatrix3& operator+=(const SymmetricMatrix3& o) {
    xx += o.xx, yy += o.yy, zz += o.zz, xy += o.xy, xz += o.xz, yz += o.yz;
    return *this;
  }
  /// Fusion of independent measurements in information form is this sum: the paper's eq. (4).
  friend SymmetricMatrix3 operator+(SymmetricMatrix3 a, const SymmetricMatrix3& b) {
    return a += b;
  }
  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& v) const {
    return {xx * v.x() + xy * v.y() + xz * v.z(), xy * v.x() + yy * v.y() + yz * v.z(),
            xz * v.x() + yz * v.y() + zz * v.z()};
  }
  [[nodiscard]] double trace() const { return xx + yy + zz; }
  [[nodiscard]] double determinant() const {
    return xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  }
  /// By cofactors; exact to a few ulps times the condition number. Not finite if singular.
  [[nodiscard]] SymmetricMatrix3 inverse() const {
    const double c_xx = yy * zz - yz * yz, c_yy = xx * zz - xz * xz, c_zz = xx * yy - xy * xy;
    const double c_xy = xz * yz - xy * zz, c_xz = xy * yz - xz * yy, c_yz = xy * xz - xx * yz;
    const double s = 1.0 / (xx * c_xx + xy * c_xy + xz * c_xz);
    return {c_xx * s, c_yy * s, c_zz * s, c_xy * s, c_xz * s, c_yz * s};
  }
  bool operator==(const SymmetricMatrix3&) const = default;
};

/// Information of one reading along the unit direction d, in d's frame:
/// Λ_r = a I + (b - a) d dᵀ, a = σ_lat⁻², b = σ_ax⁻² (DESIGN.md section 4).
[[nodiscard]] inline SymmetricMatrix3 measurement_information(const Eigen::Vector3d& d,
                                                              const MeasurementSigmas& sigmas) {
  const double a = 1.0 / (sigmas.lateral * sigmas.lateral);
  const double c = 1.0 / (sigmas.axial * sigmas.axial) - a;
  return {a + c * d.x() * d.x(), a + c * d.y() * d.y(), a + c * d.z() * d.z(),
          c * d.x() * d.y(),     c * d.x() * d.z(),     c * d.y() * d.z()};
}

/// Covariance of the same reading: Σ_r = σ_lat² (I - d dᵀ) + σ_ax² d dᵀ.
[[nodiscard]] inline SymmetricMatrix3 measurement_covariance(const Eigen::Vector3d& d,
                                                             const MeasurementSigmas& sigmas) {
  const double a = sigmas.lateral * sigmas.lateral;
  const double c = sigmas.axial * sigmas.axial - a;
  return {a + c * d.x() * d.x(), a + c * d.y() * d.y(), a + c * d.z() * d.z(),
          c * d.x() * d.y(),     c * d.x() * d.z(),     c * d.y() * d.z()};
}

}  // namespace viewgain
