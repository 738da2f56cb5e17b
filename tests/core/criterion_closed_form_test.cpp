// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "random_values.hpp"
#include "viewgain/core/criterion.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain {
namespace {

using test::RandomValues;

TEST(ClosedForm, OneReadingInAnUnknownVoxel) {
  // Σ_after = (1/λ)(I - (b-a)/(λ+b) d dᵀ ...) in closed form for a = 0: Λ = λ I + b d dᵀ.
  RandomValues random(1);
  int cases = 0;
  for (int i = 0; i < 3000; ++i, ++cases) {
    const double prior = random.magnitude(1e2, 1e6);
    const double b = prior * random.magnitude(1e-14, 1e3);
    const Eigen::Vector3d d = random.unit_vector();
    const SymmetricMatrix3 before = SymmetricMatrix3::identity(prior);
    const auto added = SymmetricMatrix3::from(b * d * d.transpose());
    const double share = b / (prior + b);
    const double determinant = 0.5 * std::log1p(b / prior);
    double diagonal = 0;
    for (int k = 0; k < 3; ++k) diagonal -= 0.5 * std::log1p(-share * d[k] * d[k]);
    ASSERT_NEAR(entropy_reduction(before, added, Criterion::log_determinant) / determinant, 1,
                1e-9);
    ASSERT_NEAR(entropy_reduction(before, added, Criterion::log_diagonal) / diagonal, 1, 1e-9);
    ASSERT_NEAR(entropy_reduction(before, added, Criterion::trace) / (share / prior), 1, 1e-9);
  }
  EXPECT_EQ(cases, 3000);
}

TEST(ClosedForm, ReadingAlongAGridAxis) {
  // SR4000 at its working distance, prior 2 σ_ax: the three axes do not mix.
  const Sensor sensor = sensor_preset("sr4000");
  const MeasurementSigmas s = sensor.sigmas(0.4);
  const double sigma_0 = 2 * s.axial;
  const auto prior = SymmetricMatrix3::identity(1 / (sigma_0 * sigma_0));
  const SymmetricMatrix3 reading = measurement_information({0, 0, 1}, s);
  const double along = 1 + sigma_0 * sigma_0 / (s.axial * s.axial);
  const double across = 1 + sigma_0 * sigma_0 / (s.lateral * s.lateral);
  const double expected = 0.5 * (std::log(along) + 2 * std::log(across));
  EXPECT_DOUBLE_EQ(along, 5.0);
  EXPECT_NEAR(entropy_reduction(prior, reading, Criterion::log_diagonal), expected, 1e-12);
  EXPECT_NEAR(entropy_reduction(prior, reading, Criterion::log_determinant), expected, 1e-12);
  const double trace = sigma_0 * sigma_0 * ((1 - 1 / along) + 2 * (1 - 1 / across));
  EXPECT_NEAR(entropy_reduction(prior, reading, Criterion::trace) / trace, 1, 1e-12);
}

TEST(ClosedForm, TwoPerpendicularReadings) {
  // The paper's Fig. 3: each reading is poor along its own ray; fused, each mends the other's weak
  // axis: Σ = diag(1/(a+b), 1/(a+b), 1/(2a)) with a = σ_lat⁻², b = σ_ax⁻².
  const MeasurementSigmas s{3.6e-3, 1.8e-3};
  const double a = 1 / (s.lateral * s.lateral), b = 1 / (s.axial * s.axial);
  const SymmetricMatrix3 along_x = measurement_information({1, 0, 0}, s);
  const SymmetricMatrix3 along_y = measurement_information({0, 1, 0}, s);
  const SymmetricMatrix3 fused = (along_x + along_y).inverse();
  EXPECT_NEAR(fused.xx * (a + b), 1, 1e-14);
  EXPECT_NEAR(fused.yy * (a + b), 1, 1e-14);
  EXPECT_NEAR(fused.zz * (2 * a), 1, 1e-14);
  EXPECT_EQ(fused.xy, 0.0);
  EXPECT_NEAR(std::sqrt(fused.xx), 1.61e-3, 5e-6);  // 3.6 mm along the first ray before

  const double expected = -std::log(a + b) - 0.5 * std::log(2 * a);
  EXPECT_NEAR(entropy(along_x + along_y, Criterion::log_diagonal), expected, 1e-12);
  EXPECT_NEAR(entropy(along_x + along_y, Criterion::log_determinant), expected, 1e-12);
  EXPECT_NEAR(entropy(along_x + along_y, Criterion::trace) / (2 / (a + b) + 1 / (2 * a)), 1, 1e-12);

  // Worth more than a second reading from the first direction, by every criterion.
  for (const Criterion c :
       {Criterion::log_diagonal, Criterion::log_determinant, Criterion::trace}) {
    EXPECT_GT(entropy_reduction(along_x, along_y, c), entropy_reduction(along_x, along_x, c));
  }
  // The gain of the second: ln((a+b)/b)/2 + ln((a+b)/a)/2 + ln(2)/2.
  const double gain = 0.5 * (std::log((a + b) / b) + std::log((a + b) / a) + std::log(2.0));
  EXPECT_NEAR(entropy_reduction(along_x, along_y, Criterion::log_diagonal), gain, 1e-12);
}

TEST(ClosedForm, IsotropicNoiseMakesTheLogCriteriaEqual) {
  RandomValues random(2);
  int cases = 0;
  for (int i = 0; i < 1000; ++i, ++cases) {
    const double sigma = random.magnitude(1e-4, 1e-1), sigma_0 = random.magnitude(1e-4, 1e-1);
    SymmetricMatrix3 added;
    const int readings = 1 + i % 7;
    for (int k = 0; k < readings; ++k) {
      added += measurement_information(random.unit_vector(), {sigma, sigma});
    }
    const auto prior = SymmetricMatrix3::identity(1 / (sigma_0 * sigma_0));
    const double expected = 1.5 * std::log1p(readings * sigma_0 * sigma_0 / (sigma * sigma));
    const double diagonal = entropy_reduction(prior, added, Criterion::log_diagonal);
    const double determinant = entropy_reduction(prior, added, Criterion::log_determinant);
    ASSERT_NEAR(diagonal / expected, 1, 1e-12);
    ASSERT_NEAR(determinant / expected, 1, 1e-12);
    ASSERT_NEAR(entropy(prior + added, Criterion::log_diagonal),
                entropy(prior + added, Criterion::log_determinant), 1e-12);
  }
  EXPECT_EQ(cases, 1000);
}

TEST(ClosedForm, TurnedByFortyFiveDegreesTheDiagonalGainIsSmaller) {
  // Correlation hides from the diagonal: a reading along (1,1,0)/√2 leaves Σ_xx = Σ_yy = mean of
  // both.
  const double prior = 1, a = 1, b = 100;
  const auto before = SymmetricMatrix3::identity(prior);
  const SymmetricMatrix3 reading = measurement_information(Eigen::Vector3d(1, 1, 0).normalized(),
                                                           {1 / std::sqrt(b), 1 / std::sqrt(a)});
  const double mean = 0.5 * (1 / (prior + a) + 1 / (prior + b));
  const double expected = -0.5 * (2 * std::log(mean) + std::log(1 / (prior + a)));
  EXPECT_NEAR(entropy_reduction(before, reading, Criterion::log_diagonal), expected, 1e-12);
  EXPECT_LT(expected, 0.7 * entropy_reduction(before, reading, Criterion::log_determinant));
}

}  // namespace
}  // namespace viewgain
