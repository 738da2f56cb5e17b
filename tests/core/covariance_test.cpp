// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/covariance.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "random_values.hpp"

namespace viewgain {
namespace {

using test::RandomValues;

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
