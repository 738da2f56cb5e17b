// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "belief_blocks.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "viewgain/support/text.hpp"

namespace viewgain {

std::vector<BeliefBlockAt> belief_blocks(const BeliefGrid& grid) {
  const detail::BeliefMap& beliefs = detail::beliefs_of(grid);
  std::vector<std::uint64_t> keys;
  keys.reserve(beliefs.size());
  for (const auto& [key, block] : beliefs) keys.push_back(key);
  std::sort(keys.begin(), keys.end());
  const detail::BlockLattice lattice(grid.min_index(), grid.dims());
  std::vector<BeliefBlockAt> blocks;
  blocks.reserve(keys.size());
  for (const std::uint64_t key : keys) blocks.push_back({lattice.origin(key), beliefs.at(key)});
  return blocks;
}

std::shared_ptr<BeliefBlock> detail::reshaped(const BeliefBlock* block, const LeafMask& mask) {
  auto result = std::make_shared<BeliefBlock>();
  result->mask = mask;
  if (block != nullptr) result->scale = block->scale;
  result->beliefs.reserve(count_bits(mask));
  for_each_bit(mask, [&](unsigned offset) {
    const Belief* old = block != nullptr ? block->find(offset) : nullptr;
    result->beliefs.push_back(old != nullptr ? *old : Belief{});
  });
  return result;
}

}  // namespace viewgain

namespace viewgain::detail {
namespace {

std::string has(const char* what, const std::string& value) {
  return std::string("has ") + what + value;
}

/// Bound on how far the sum of `hits` readings can deviate from positive semidefinite, with its
/// information scaled to a unit diagonal. Rounding each sum to nearest single precision has an
/// error of at most 2^-24, and |Λ_ij| <= √(Λ_ii Λ_jj): that is hits · 2^-24 per entry, three times
/// as much for the matrix. From 2^24 readings on, such sums stagnate within a factor of 2 of each
/// other. The bound is doubled, so that the matrix factored below is regular, and for BeliefSum,
/// which rounds by up to 2^-23 but less often.
double rounding(std::uint32_t hits) { return 6.0 * std::min((hits + 1.0) * 0x1p-24, 1.0); }

}  // namespace

std::string fault_of_belief(const Belief& belief, double voxel_size) {
  constexpr float kMost = std::numeric_limits<float>::max();
  bool is_clamped = false;
  for (std::size_t i = 0; i < 6; ++i) {
    const float value = belief.information[i];
    if (!std::isfinite(value) || (i < 3 && value < 0))
      return has("an information that is negative or not finite: ", short_text(value));
    is_clamped = is_clamped || std::abs(value) == kMost;
  }
  for (const float value : belief.information_vector) {
    if (!std::isfinite(value))
      return has("an information vector that is not finite: ", short_text(value));
    is_clamped = is_clamped || std::abs(value) == kMost;
  }
  if (belief.hits > static_cast<std::uint32_t>(std::numeric_limits<std::int32_t>::max())) {
    return has("more than 2147483647 measured points: ", std::to_string(belief.hits));
  }
  // Sums that would overflow stay unchanged.
  if (is_clamped) return {};

  // Smallest normal number: below it rounding errors are absolute.
  const Eigen::Matrix3d information = belief.information_matrix().matrix();
  const Eigen::Vector3d scale =
      (information.diagonal().array() + double{std::numeric_limits<float>::min()}).rsqrt();
  Eigen::Matrix3d scaled = scale.asDiagonal() * information * scale.asDiagonal();
  scaled.diagonal().array() += rounding(belief.hits);
  const Eigen::LLT<Eigen::Matrix3d> factors(scaled);
  if (factors.info() != Eigen::Success) {
    return "has an information matrix that is not positive semidefinite";
  }
  // The matrix-weighted mean of readings in a voxel is at most about twice as many voxels from its
  // centre as a sensor's sigmas differ by a factor. A position farther away, in voxels, would
  // exceed 32 bits.
  constexpr double kFarthest = 0x1p28;
  const Eigen::Vector3d vector(belief.information_vector[0], belief.information_vector[1],
                               belief.information_vector[2]);
  const Eigen::Vector3d offset =
      scale.cwiseProduct(factors.solve(scale.cwiseProduct(vector))) / voxel_size;
  const double farthest = offset.cwiseAbs().maxCoeff();
  if (!(farthest <= kFarthest))
    return has("a point that is too far from its voxel; its distance in voxels: ",
               short_text(farthest));
  return {};
}

}  // namespace viewgain::detail
