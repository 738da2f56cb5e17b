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

/// Measure of the uncertainty of the surface position in a voxel, whose covariance is Σ = Λ⁻¹. In
/// this library, "entropy" means this measure. "The paper" is Foix et al. (2012).
enum class Criterion : std::uint8_t {
  log_diagonal,  ///< ½ Σ_k ln Σ_kk along the grid axes [nat]: eqs. (3) and (6) of the paper, with
                 ///< the factor ½ of eq. (2)
  log_determinant,  ///< ½ ln det Σ [nat]: eq. (2); independent of the coordinate frame
  trace,            ///< tr Σ [m²]: A-optimality; independent of the coordinate frame
};

/// Names of the criteria, in enumeration order.
[[nodiscard]] VIEWGAIN_EXPORT const std::vector<std::string>& criterion_names();
/// Name of the criterion, as parse_criterion() reads it. Throws std::out_of_range for an invalid
/// value.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view criterion_name(Criterion criterion);

/// The criterion of this name. Throws Error(invalid_argument) listing the valid names.
[[nodiscard]] VIEWGAIN_EXPORT Criterion parse_criterion(std::string_view name);

/// Entropy H(Λ) [nat; m² with trace]. `information` is Λ [m⁻²]. It must be positive definite, which
/// is not checked.
[[nodiscard]] VIEWGAIN_EXPORT double entropy(const SymmetricMatrix3& information,
                                             Criterion criterion);

/// Reduction of the entropy, H(before) - H(before + added) >= 0 [nat; m² with trace]. The arguments
/// are information matrices [m⁻²]. `before` must be positive definite and `added` positive
/// semidefinite, which is not checked. Small differences are accurate, because they are computed as
/// one logarithm of a ratio.
[[nodiscard]] VIEWGAIN_EXPORT double entropy_reduction(const SymmetricMatrix3& before,
                                                       const SymmetricMatrix3& added,
                                                       Criterion criterion);

}  // namespace viewgain
