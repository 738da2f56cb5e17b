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

/// How the uncertainty of a voxel's position is measured, from Σ = Λ⁻¹.
enum class Criterion : std::uint8_t {
  log_diagonal,  ///< ½ Σ_k ln Σ_kk in grid axes [nat]: the paper's eq. (3) and (6) with eq. (2)'s ½
  log_determinant,  ///< ½ ln det Σ [nat]: eq. (2); the same in every frame
  trace,            ///< tr Σ [m²]: A-optimality; the same in every frame
};

/// Names of the criteria, in their order.
[[nodiscard]] VIEWGAIN_EXPORT const std::vector<std::string>& criterion_names();
/// The criterion's name, as parse_criterion() reads it. Throws std::out_of_range for a number that
/// is none of them.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view criterion_name(Criterion criterion);

/// Throws Error(invalid_argument) that lists the valid names.
[[nodiscard]] VIEWGAIN_EXPORT Criterion parse_criterion(std::string_view name);

/// H(Λ) by the criterion [nat, or m² for trace]; Λ [m⁻²] must be positive definite, which is not
/// checked.
[[nodiscard]] VIEWGAIN_EXPORT double entropy(const SymmetricMatrix3& information,
                                             Criterion criterion);

/// H(before) - H(before + added) >= 0 [nat, or m² for trace] for a positive semidefinite `added`,
/// which is not checked. One logarithm of a ratio, so small gains keep their digits.
[[nodiscard]] VIEWGAIN_EXPORT double entropy_reduction(const SymmetricMatrix3& before,
                                                       const SymmetricMatrix3& added,
                                                       Criterion criterion);

}  // namespace viewgain
