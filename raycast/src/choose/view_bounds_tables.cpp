// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The most that rays bring a voxel, by class, range and price.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <cmath>

#include "view_bounds.hpp"
#include "viewgain/core/covariance.hpp"

namespace viewgain::detail {
namespace {

// Prices of a ray as shares of what one ray gains in an unknown voxel at a middle range.
constexpr std::array<double, ViewBounds::kPrices> kPriceShares{0.15, 0.3, 0.5, 0.7,
                                                               0.9,  1.1, 1.4, 1.8};
// Ranges nearer than this have no table of their own [voxels].
constexpr double kNearestRange = 1.0;

// a and b of Λ_r = a I + (b - a) d dᵀ [m⁻²].
struct Information {
  double across, along;
};

// The most at any range from t on [m].
Information most_information(const FrontalSigmas& s, double t) {
  // sigma_ax is a parabola at most; its lowest point may lie farther on.
  double lowest = t;
  if (s.a2 > 0) lowest = std::max(t, s.v - s.a1 / (2 * s.a2));
  const double lateral = s.l0 + s.l1 * t;
  const double axial = s.a0 + s.a1 * lowest + s.a2 * (lowest - s.v) * (lowest - s.v);
  return {1 / (lateral * lateral), 1 / (axial * axial)};
}

// What a direction with covariance x gains from information s.
double gain_along(Criterion criterion, double x, double s) {
  return criterion == Criterion::trace ? x * x * s / (1 + x * s) : 0.5 * std::log1p(x * s);
}

// max over whole m >= 0 of gain(m) - m price, for a concave gain with gain(0) = 0.
template <typename Gain>
double left_after_paying(const Gain& gain, double price) {
  double best = 0;
  constexpr int kSteps = 32;
  for (int m = 1; m <= kSteps; ++m) {
    const double left = gain(m) - m * price;
    if (left <= best) return best;
    best = left;
  }
  double low = kSteps, high = 1 << 24;
  while (high - low > 1) {
    const double middle = std::floor((low + high) / 2);
    (gain(middle + 1) - gain(middle) > price ? low : high) = middle;
  }
  return std::max(gain(low) - low * price, gain(high) - high * price);
}

// The isotropic covariance [m²] that gains at least what an occupied voxel does from any multiple
// of I. By Jensen's inequality over the eigenvalues; for log_diagonal with the weights that they
// have in Σ_kk. For the trace the largest eigenvalue.
double equivalent_covariance(Criterion criterion, const SymmetricMatrix3& information) {
  const SymmetricMatrix3 sigma = information.inverse();
  switch (criterion) {
    case Criterion::log_determinant:
      return sigma.trace() / 3;
    case Criterion::log_diagonal:
      return ((sigma.xx * sigma.xx + sigma.xy * sigma.xy + sigma.xz * sigma.xz) / sigma.xx +
              (sigma.xy * sigma.xy + sigma.yy * sigma.yy + sigma.yz * sigma.yz) / sigma.yy +
              (sigma.xz * sigma.xz + sigma.yz * sigma.yz + sigma.zz * sigma.zz) / sigma.zz) /
             3;
    case Criterion::trace:
      break;
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sigma.matrix(), Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

// The least range of a step [voxels].
double range_of(std::uint32_t step) {
  return std::sqrt(static_cast<double>(std::bit_cast<float>(step << kRangeStepShift)));
}

}  // namespace

// The class of an occupied voxel: c >= 1, by halvings of σ_0².
unsigned ViewBounds::class_of(const SnapshotLeaf& leaf, unsigned offset) {
  if (!test_bit(leaf.occupied, offset)) return 0;
  const double prior = settings_.prior_information;
  SymmetricMatrix3 information = SymmetricMatrix3::identity(prior);
  const Belief* belief = leaf.beliefs ? leaf.beliefs->find(offset) : nullptr;
  if (belief != nullptr) information += belief->information_matrix();
  const double x = equivalent_covariance(settings_.criterion, information);
  const double steps = 1 + std::floor(1.5 * std::log2(1 / (prior * x)));
  const auto c =
      static_cast<unsigned>(steps > 1 ? std::min(steps, static_cast<double>(kClasses - 1)) : 1.0);
  covariance_[c] = std::max(covariance_[c], x);
  return c;
}

void ViewBounds::tabulate(double min_range, double max_range) {
  const double voxel = scene_.snapshot.voxel_size;
  const Criterion criterion = settings_.criterion;
  const auto squared = [&](double range) {
    const double r = std::clamp(range / voxel, kNearestRange, 2 * kFarthestCamera);
    return static_cast<float>(r * r);
  };
  first_step_ = step_of(squared(min_range));
  const std::size_t steps = step_of(squared(max_range)) - first_step_ + 1;
  const auto information_at = [&](std::size_t step) {
    const double range =
        std::max(range_of(first_step_ + static_cast<std::uint32_t>(step)) * voxel, min_range);
    return most_information(settings_.sigmas, std::max(range, kMinNoiseRange));
  };
  const auto unknown_gain = [&](const Information& info, double m) {
    return 2 * gain_along(criterion, covariance_[0], m * info.across) +
           gain_along(criterion, covariance_[0], m * info.along);
  };
  for (std::size_t i = 0; i < kPrices; ++i) {
    prices_[i] = kPriceShares[i] * unknown_gain(information_at(steps / 2), 1);
  }
  left_.resize(steps);
  left_changed_.resize(steps);
  one_ray_.resize(steps);
  for (std::size_t step = 0; step < steps; ++step) {
    const Information info = information_at(step);
    const double most = std::max(info.across, info.along);
    // Rays that end in one voxel turn by at most half its diagonal from the ray to its centre.
    const double range = range_of(first_step_ + static_cast<std::uint32_t>(step));
    const double turn = range > 1 ? 0.75 / (range * range) : 1.0;
    Information turned = info;
    (info.across > info.along ? turned.along : turned.across) +=
        std::abs(info.across - info.along) * turn;
    const auto isotropic = [&](double covariance) {
      return [=](double m) { return 3 * gain_along(criterion, covariance, m * most); };
    };
    one_ray_[step] = isotropic(covariance_[0])(1);
    for (std::size_t i = 0; i < kPrices; ++i) {
      left_[step][0][i] =
          left_after_paying([&](double m) { return unknown_gain(turned, m); }, prices_[i]);
      for (std::size_t c = 1; c < kClasses; ++c) {
        left_[step][c][i] = left_after_paying(isotropic(covariance_[c]), prices_[i]);
      }
      left_changed_[step][i] = left_after_paying(isotropic(covariance_[0]), prices_[i]);
    }
  }
}

}  // namespace viewgain::detail
