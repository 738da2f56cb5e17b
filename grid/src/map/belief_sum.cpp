// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "belief_sum.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "viewgain/support/hash64.hpp"

namespace viewgain::detail {
namespace {

/// `salt` makes the random numbers of equal values differ.
float rounded_by_chance(double value, std::uint64_t salt) {
  constexpr double kLimit = std::numeric_limits<float>::max();
  if (!(std::abs(value) < kLimit)) return static_cast<float>(std::clamp(value, -kLimit, kLimit));
  // The bits that single precision lacks. A random number added to them carries into the higher
  // bits with a probability equal to their share of a step.
  constexpr std::uint64_t kLost = (std::uint64_t{1} << 29U) - 1;
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const std::uint64_t chance = mix64(bits + kMixStep * salt) & kLost;
  return static_cast<float>(std::bit_cast<double>((bits + chance) & ~kLost));
}

bool is_definite(const SymmetricMatrix3& matrix) {
  double determinant = 0;
  (void)matrix.inverse(determinant);
  return determinant > 0;  // NaN unless it is
}

}  // namespace

void BeliefSum::add(const Belief& belief, const Eigen::Vector3d& way) {
  for (std::size_t i = 0; i < 6; ++i) information_[i] += double{belief.information[i]};
  const auto& v = belief.information_vector;
  vector_ += Eigen::Vector3d(v[0], v[1], v[2]) + belief.information_matrix() * way;
  hits_ += belief.hits;
}

void BeliefSum::add(const SymmetricMatrix3& information, const Eigen::Vector3d& offset) {
  const double terms[6] = {information.xx, information.yy, information.zz,
                           information.xy, information.xz, information.yz};
  for (std::size_t i = 0; i < 6; ++i) information_[i] += terms[i];
  vector_ += information * offset;
  ++hits_;
}

Belief BeliefSum::rounded() const {
  Belief belief;
  // Includes the count: otherwise an unchanged sum would get the same random number every time.
  std::uint64_t salt = 9 * static_cast<std::uint64_t>(hits_);
  const auto narrow = [&](double value) { return rounded_by_chance(value, salt++); };
  std::transform(information_.begin(), information_.end(), belief.information.begin(), narrow);
  std::transform(vector_.begin(), vector_.end(), belief.information_vector.begin(), narrow);
  // The files hold the count as a signed integer.
  constexpr double kMostHits = std::numeric_limits<std::int32_t>::max();
  belief.hits = static_cast<std::uint32_t>(std::min(hits_, kMostHits));
  return definite(belief);
}

Belief definite(const Belief& belief) {
  if (is_definite(belief.information_matrix())) return belief;
  const auto with = [&](double share) {
    constexpr double kLimit = std::numeric_limits<float>::max();
    Belief more = belief;
    for (std::size_t i = 0; i < 3; ++i) {
      const double value = double{belief.information[i]} * (1 + share);
      more.information[i] = static_cast<float>(std::min(value, kLimit));
    }
    return more;
  };
  // From a share of 2 on it is diagonally dominant if |Λ_ij| <= √(Λ_ii Λ_jj).
  for (double t = 0x1p-24; t <= 4; t *= 2) {
    if (is_definite(with(t).information_matrix())) return with(2 * t);
  }
  return belief;
}

}  // namespace viewgain::detail
