// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

#include "viewgain/core/criterion.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "expect_error.hpp"
#include "random_values.hpp"
#include "viewgain/core/covariance.hpp"

namespace viewgain {
namespace {

using test::expect_error;
using test::RandomValues;
using LongMatrix = Eigen::Matrix<long double, 3, 3>;

constexpr std::array kCriteria{Criterion::log_diagonal, Criterion::log_determinant,
                               Criterion::trace};

/// The definition: an explicit inverse in extended precision, then the table of
/// raycast/README.md. By elimination, since Eigen's inverse() and determinant() of a 3x3 take
/// cofactors as the code under test does.
long double explicit_entropy(const LongMatrix& information, Criterion criterion) {
  const LongMatrix covariance = information.fullPivLu().inverse();
  switch (criterion) {
    case Criterion::log_diagonal: {
      long double sum = 0;
      for (int k = 0; k < 3; ++k) sum += std::log(covariance(k, k));
      return sum / 2;
    }
    case Criterion::log_determinant:
      return std::log(covariance.fullPivLu().determinant()) / 2;
    case Criterion::trace:
      return covariance.trace();
  }
  return 0;
}

LongMatrix widened(const SymmetricMatrix3& m) { return m.matrix().cast<long double>(); }

TEST(Entropy, EqualsTheDefinition) {
  RandomValues random(1);
  for (int i = 0; i < 5000; ++i) {
    // And with one to three stiff axes, eigenvalues 1 .. 1e10, where plain cofactors lose
    // everything.
    const bool is_stiff = i >= 3000;
    const auto information =
        SymmetricMatrix3::from(is_stiff ? random.spd(1, 1e10) : random.spd(1e3, 1e7));
    for (const Criterion c : kCriteria) {
      const double expected = static_cast<double>(explicit_entropy(widened(information), c));
      ASSERT_NEAR(entropy(information, c), expected,
                  (is_stiff ? 1e-5 : 1e-10) * (1 + std::abs(expected)))
          << criterion_name(c);
    }
  }
}

TEST(Entropy, OfWhatIsNotPositiveDefiniteIsNan) {
  for (const SymmetricMatrix3& m :
       {SymmetricMatrix3{}, SymmetricMatrix3{-1, -1, -1, 0, 0, 0},
        SymmetricMatrix3{1, 1, 1, 2, 0, 0}, SymmetricMatrix3{-1, -1, 1, 0, 0, 0},
        SymmetricMatrix3{NAN, 1, 1, 0, 0, 0}}) {
    for (const Criterion c : kCriteria) {
      EXPECT_TRUE(std::isnan(entropy(m, c)));
    }
  }
}

TEST(EntropyReduction, EqualsTheDifference) {
  RandomValues random(3);
  for (int i = 0; i < 3000; ++i) {
    const auto before = SymmetricMatrix3::from(random.spd(1e3, 1e6));
    const auto added = SymmetricMatrix3::from(random.magnitude(1e-3, 1e3) * random.spd(1e3, 1e6));
    for (const Criterion c : kCriteria) {
      const double expected =
          static_cast<double>(explicit_entropy(widened(before), c) -
                              explicit_entropy(widened(before) + widened(added), c));
      ASSERT_NEAR(entropy_reduction(before, added, c) / expected, 1, 1e-9) << criterion_name(c);
      ASSERT_NEAR(entropy_reduction(before, added, c),
                  entropy(before, c) - entropy(before + added, c),
                  1e-8 * (1 + std::abs(entropy(before, c))));
    }
  }
}

TEST(EntropyReduction, KeepsTheDigitsOfTinyAdditions) {
  RandomValues random(4);
  for (int i = 0; i < 2000; ++i) {
    // A difference of two entropies in double would keep 16 - 10 digits at most, here they are 9.
    const auto before = SymmetricMatrix3::from(random.spd(1e4, 1e6));
    const auto added = SymmetricMatrix3::from(random.magnitude(1e-10, 1e-8) * random.spd(1e4, 1e6));
    // First order in the addition, second order is below 1e-6 of it: by Σ's derivative -Σ B Σ.
    const LongMatrix covariance = widened(before).inverse();
    const LongMatrix drop = covariance * widened(added) * covariance;
    const long double determinant_gain = (covariance * widened(added)).trace() / 2;
    const long double diagonal_gain =
        (drop.diagonal().array() / covariance.diagonal().array()).sum() / 2;
    const std::array<long double, 3> expected{diagonal_gain, determinant_gain, drop.trace()};
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_NEAR(entropy_reduction(before, added, kCriteria[c]) / static_cast<double>(expected[c]),
                  1, 3e-6);
    }
  }
}

TEST(EntropyReduction, OfNothingIsZero) {
  RandomValues random(5);
  for (int i = 0; i < 300; ++i) {
    const auto before = SymmetricMatrix3::from(random.spd(1, 1e8));
    for (const Criterion c : kCriteria) {
      ASSERT_EQ(entropy_reduction(before, {}, c), 0.0);
    }
  }
}

TEST(CriterionNames, RoundTripAndListTheValidOnes) {
  EXPECT_EQ(criterion_names(),
            (std::vector<std::string>{"log_diagonal", "log_determinant", "trace"}));
  for (const Criterion c : kCriteria) {
    EXPECT_EQ(parse_criterion(criterion_name(c)), c);
  }
  expect_error(ErrorCode::invalid_argument,
               "unknown criterion 'entropy'; valid values: log_diagonal, log_determinant, trace",
               [] { (void)parse_criterion("entropy"); });
  expect_error(ErrorCode::invalid_argument, "''", [] { (void)parse_criterion(""); });
}

TEST(SymmetricMatrix3, AgreesWithEigen) {
  RandomValues random(1);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Matrix3d a = random.spd(0.1, 10), b = random.spd(0.1, 10);
    const Eigen::Vector3d v = random.vector();
    const auto m = SymmetricMatrix3::from(a);
    ASSERT_EQ(m.matrix(), a);
    ASSERT_LT(((m + SymmetricMatrix3::from(b)).matrix() - (a + b)).norm(), 1e-14);
    ASSERT_LT((m * v - a * v).norm(), 1e-13);
    ASSERT_NEAR(m.trace(), a.trace(), 1e-13);
    ASSERT_NEAR(m.determinant() / a.determinant(), 1, 1e-10);
    ASSERT_LT((m.inverse().matrix() * a - Eigen::Matrix3d::Identity()).norm(), 1e-10);
  }
}

TEST(SymmetricMatrix3, KeepsTheOrderOfTheMapFiles) {
  const SymmetricMatrix3 m{1, 2, 3, 4, 5, 6};
  EXPECT_EQ(m.matrix(), (Eigen::Matrix3d() << 1, 4, 5, 4, 2, 6, 5, 6, 3).finished());
  EXPECT_EQ(SymmetricMatrix3::identity(7).matrix(), 7 * Eigen::Matrix3d::Identity());
  SymmetricMatrix3 sum = m;
  sum += SymmetricMatrix3::identity();
  EXPECT_EQ(sum, (SymmetricMatrix3{2, 3, 4, 4, 5, 6}));
}

TEST(SymmetricMatrix3, InversesOfIllConditionedMatricesKeepTheirDigits) {
  RandomValues random(6);
  int cases = 0;
  for (; cases < 2000; ++cases) {
    // Eigenvalues 1 .. 1e10 along random axes; the inverse is known from them.
    const Eigen::Vector3d values(1, random.magnitude(1, 1e10), random.magnitude(1, 1e10));
    const Eigen::Matrix3d R = random.rotation();
    const Eigen::Matrix3d m = R * values.asDiagonal() * R.transpose();
    const Eigen::Matrix3d expected = R * values.cwiseInverse().asDiagonal() * R.transpose();
    double determinant = 0;
    const SymmetricMatrix3 inverse =
        SymmetricMatrix3::from(0.5 * (m + m.transpose())).inverse(determinant);
    ASSERT_LT((inverse.matrix() - expected).norm(), 1e-4 * expected.norm());
    ASSERT_NEAR(determinant / values.prod(), 1, 1e-4);
  }
  EXPECT_EQ(cases, 2000);
}

TEST(SymmetricMatrix3, OnlyPositiveDefiniteOnesHaveAnInverse) {
  int cases = 0;
  for (const SymmetricMatrix3& m :
       {SymmetricMatrix3{}, SymmetricMatrix3{1, 1, 1, 2, 0, 0}, SymmetricMatrix3{1, 1, 1, 1, 1, 1},
        SymmetricMatrix3{-1, -1, 1, 0, 0, 0}, SymmetricMatrix3{1, 1, 1, 1e8, 0, 0}}) {
    double determinant = 0;
    EXPECT_TRUE(std::isnan(m.inverse(determinant).xx)) << cases;
    EXPECT_TRUE(std::isnan(determinant));
    ++cases;
  }
  EXPECT_EQ(cases, 5);
  // {1, 1, 1, 2, 2, 2} and its like: the determinant is positive where two eigenvalues are not.
  RandomValues random(9);
  int with_inverse = 0, two_negative = 0;
  for (cases = 0; cases < 5000; ++cases) {
    const auto entry = [&] { return random.uniform(-1, 1); };
    const SymmetricMatrix3 m{random.uniform(-0.2, 1),
                             random.uniform(-0.2, 1),
                             random.uniform(-0.2, 1),
                             entry(),
                             entry(),
                             entry()};
    const Eigen::Vector3d values =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m.matrix(), Eigen::EigenvaluesOnly)
            .eigenvalues();
    if (values.cwiseAbs().minCoeff() < 1e-9) continue;
    ASSERT_EQ(std::isnan(m.inverse().xx), values.minCoeff() < 0) << values.transpose();
    with_inverse += values.minCoeff() > 0 ? 1 : 0;
    two_negative += m.xx > 0 && m.yy > 0 && values[1] < 0 ? 1 : 0;
  }
  EXPECT_GT(with_inverse, 200);
  EXPECT_GT(two_negative, 200);
}

// Σ_r = σ_lat² (I - d dᵀ) + σ_ax² d dᵀ.
TEST(Measurement, InformationIsTheInverseOfTheCovariance) {
  RandomValues random(3);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d d = random.unit_vector();
    const MeasurementSigmas s{random.magnitude(1e-3, 1e-2), random.magnitude(1e-3, 1e-2)};
    const Eigen::Matrix3d along = d * d.transpose();
    const Eigen::Matrix3d covariance =
        s.lateral * s.lateral * (Eigen::Matrix3d::Identity() - along) + s.axial * s.axial * along;
    const Eigen::Matrix3d product = measurement_information(d, s).matrix() * covariance;
    ASSERT_LT((product - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace viewgain
