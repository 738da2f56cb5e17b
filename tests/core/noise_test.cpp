// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/noise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace viewgain {
namespace {

TEST(ShotNoise, ScalesWithRangeTimeAndIncidence) {
  const ShotNoise noise{.reference_sigma = 4e-3,
                        .reference_range = 1.3,
                        .reference_integration_time = 8.5e-3,
                        .integration_time = 8.5e-3};
  EXPECT_NEAR(sigmas(noise, 1.30, 220, 1.0).axial, 4.0e-3, 1e-15);  // the measured anchor
  EXPECT_NEAR(sigmas(noise, 2.60, 220, 1.0).axial, 8.0e-3, 1e-15);
  EXPECT_NEAR(sigmas(noise, 1.30, 220, 0.25).axial, 8.0e-3, 1e-15);
  EXPECT_NEAR(sigmas(noise, 1.30, 220, 0.25).lateral, 1.30 / 220, 1e-15);
  ShotNoise shorter = noise;
  shorter.integration_time = 8.5e-3 / 9;
  EXPECT_NEAR(sigmas(shorter, 1.30, 220, 1.0).axial, 12.0e-3, 1e-15);
}

TEST(NoiseModel, UnambiguousRangeIsHalfAWavelength) {
  EXPECT_NEAR(unambiguous_range(ShotNoise{}), 4.99654, 1e-5);
  EXPECT_NEAR(unambiguous_range(ShotNoise{.modulation_frequency = 15e6}), 9.99308, 1e-5);
  for (const NoiseModel& model :
       std::vector<NoiseModel>{ShotNoise{.modulation_frequency = 0}, StructuredLightNoise{},
                               StereoNoise{}, QuadraticNoise{}, ConstantNoise{}}) {
    EXPECT_EQ(unambiguous_range(model), std::numeric_limits<double>::infinity());
  }
}

TEST(StructuredLightNoise, IsNguyensModel) {
  const StructuredLightNoise noise;
  EXPECT_NEAR(sigmas(noise, 0.4, 585, 1.0).axial, 1.2e-3, 1e-15);
  EXPECT_NEAR(sigmas(noise, 1.4, 585, 1.0).axial, 3.1e-3, 1e-15);
  EXPECT_NEAR(sigmas(noise, 1.0, 585, 1.0).lateral, 0.8 / 585, 1e-15);
  // Up to 60° the axial sigma does not depend on the incidence.
  EXPECT_EQ(sigmas(noise, 1.0, 585, 0.51).axial, sigmas(noise, 1.0, 585, 1.0).axial);
  EXPECT_GT(sigmas(noise, 1.0, 585, 0.49).axial, sigmas(noise, 1.0, 585, 1.0).axial);
  // At 75°: θ²/(π/2-θ)² = 25, θ/(π/2-θ) = 5.
  const double cos_75 = std::cos(75 * std::numbers::pi / 180);
  EXPECT_NEAR(sigmas(noise, 0.64, 585, cos_75).axial,
              1.2e-3 + 1.9e-3 * 0.24 * 0.24 + 1e-4 / 0.8 * 25, 1e-12);
  EXPECT_NEAR(sigmas(noise, 0.64, 585, cos_75).lateral, (0.8 + 0.035 * 5) * 0.64 / 585, 1e-12);
}

TEST(StereoNoise, GrowsWithTheSquareOfTheRange) {
  const StereoNoise noise;
  EXPECT_NEAR(sigmas(noise, 1.0, 447, 1.0).axial, 0.08 / (447 * 0.05), 1e-15);
  EXPECT_NEAR(sigmas(noise, 2.0, 447, 0.3).axial, 4 * 0.08 / (447 * 0.05), 1e-15);
  EXPECT_NEAR(sigmas(noise, 2.0, 447, 0.3).lateral, 2.0 / 447, 1e-15);
}

TEST(StereoNoise, HasTheCamerasFocalLengthUnlessItSaysOtherwise) {
  // Half of the resolution: half the focal length in pixels, twice the error.
  EXPECT_NEAR(sigmas(StereoNoise{}, 1.0, 223.5, 1.0).axial, 0.08 / (223.5 * 0.05), 1e-15);
  EXPECT_NEAR(sigmas(StereoNoise{.focal = 600}, 1.0, 223.5, 1.0).axial, 0.08 / (600 * 0.05), 1e-15);
}

TEST(QuadraticNoise, HasALinearPart) {
  const QuadraticNoise noise{.offset = 2e-3, .quadratic = 0, .linear = 5e-3};
  EXPECT_NEAR(sigmas(noise, 2.0, 400, 1.0).axial, 12e-3, 1e-15);
}

TEST(QuadraticNoise, IsOffsetPlusSquare) {
  const QuadraticNoise noise{.offset = 2e-3, .quadratic = 0.5e-3};
  EXPECT_NEAR(sigmas(noise, 2.0, 400, 1.0).axial, 4e-3, 1e-15);
  EXPECT_NEAR(sigmas(noise, 2.0, 400, 1.0).lateral, 5e-3, 1e-15);
}

TEST(ConstantNoise, IsConstant) {
  const ConstantNoise noise{.sigma_axial = 3e-3, .sigma_lateral = 2e-3};
  EXPECT_EQ(sigmas(noise, 0.1, 400, 0.2).axial, 3e-3);
  EXPECT_EQ(sigmas(noise, 9.0, 100, 1.0).lateral, 2e-3);
}

TEST(NoiseModel, StaysFiniteAtRangeZero) {
  for (const NoiseModel& model : std::vector<NoiseModel>{
           ShotNoise{}, StructuredLightNoise{}, StereoNoise{}, QuadraticNoise{}, ConstantNoise{}}) {
    const MeasurementSigmas zero = sigmas(model, 0.0, 300);
    const MeasurementSigmas near = sigmas(model, kMinNoiseRange, 300);
    EXPECT_GT(zero.axial, 0);
    EXPECT_GT(zero.lateral, 0);
    EXPECT_EQ(zero.axial, near.axial);
    EXPECT_EQ(zero.lateral, near.lateral);
  }
}

TEST(NoiseModel, CosineIsClampedAtATenth) {
  EXPECT_EQ(sigmas(ShotNoise{}, 1.0, 300, 0.01).axial, sigmas(ShotNoise{}, 1.0, 300, 0.1).axial);
  EXPECT_EQ(sigmas(StructuredLightNoise{}, 1.0, 300, -1).axial,
            sigmas(StructuredLightNoise{}, 1.0, 300, 0.1).axial);
}

}  // namespace
}  // namespace viewgain
