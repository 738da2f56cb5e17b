// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/covariance.hpp"
#include "viewgain/core/export.hpp"

namespace viewgain {

/// Measure of the uncertainty of a voxel's position, computed from Σ = Λ⁻¹.
enum class Criterion : std::uint8_t {
  log_diagonal,  ///< ½ Σ_k ln Σ_kk in grid axes [nat]: eqs. (3) and (6) of the paper, with the
                 ///< factor ½ of eq. (2)
  log_determinant,  ///< ½ ln det Σ [nat]: eq. (2); independent of the coordinate frame
  trace,            ///< tr Σ [m²]: A-optimality; independent of the coordinate frame
};

/// Names of the criteria, in enumeration order.
[[nodiscard]] VIEWGAIN_EXPORT const std::vector<std::string>& criterion_names();
/// Name of the criterion, as parse_criterion() reads it. Throws std::out_of_range for an invalid
/// value.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view criterion_name(Criterion criterion);

/// Parses a name. Throws Error(invalid_argument) listing the valid names.
[[nodiscard]] VIEWGAIN_EXPORT Criterion parse_criterion(std::string_view name);

/// H(Λ) under the criterion [nat, or m² for trace]. Λ [m⁻²] must be positive definite (unchecked).
[[nodiscard]] VIEWGAIN_EXPORT double entropy(const SymmetricMatrix3& information,
                                             Criterion criterion);

/// H(before) - H(before + added) >= 0 [nat, or m² for trace]. `added` must be positive semidefinite
/// (unchecked). Uses a single logarithm of a ratio, so small gains stay accurate.
[[nodiscard]] VIEWGAIN_EXPORT double entropy_reduction(const SymmetricMatrix3& before,
                                                       const SymmetricMatrix3& added,
                                                       Criterion criterion);

}  // namespace viewgain
