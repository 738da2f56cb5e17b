// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

namespace viewgain::detail {

/// Uniform cubic B-splines over [from, to]; beyond, the end pieces go on.
class CurveBasis {
 public:
  static constexpr int kLocal = 4;  ///< splines that are not 0 at a place

  /// `from` < `to`, at least one piece.
  CurveBasis(double from, double to, int pieces);

  /// What the splines from number `first` on are at a place, and their slopes.
  struct Local {
    int first = 0;
    std::array<double, kLocal> values{};
    std::array<double, kLocal> slopes{};

    [[nodiscard]] double value(const Eigen::VectorXd& coefficients) const;
    [[nodiscard]] double slope(const Eigen::VectorXd& coefficients) const;
  };
  [[nodiscard]] Local at(double place) const;

  [[nodiscard]] int size() const { return pieces_ + kLocal - 1; }
  [[nodiscard]] int pieces() const { return pieces_; }
  /// In which piece a place lies; the end pieces hold what lies beyond.
  [[nodiscard]] int piece(double place) const;
  /// Where piece i begins; i = pieces(): the end.
  [[nodiscard]] double begin_of(int i) const { return from_ + i * step_; }

  /// Σ (second difference of the coefficients)² as a quadratic form: how rough a curve is (Eilers
  /// and Marx, Statistical Science 11, 1996).
  [[nodiscard]] Eigen::MatrixXd roughness() const;

 private:
  double from_;
  double step_;
  int pieces_;
};

}  // namespace viewgain::detail
