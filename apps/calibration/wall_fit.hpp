// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "calibration/wall_frame.hpp"

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

/// The curve of the error over the true range and the walls' tilts, fitted together: a block's
/// reading is t + error(t), t the range to its wall. Gauss-Newton with weights by the readings'
/// noise, times Tukey's for what is not on the wall.
class WallFit {
 public:
  /// `frames` must outlive the fit; at least two. `farthest` is the longest range to look at [m].
  WallFit(const std::vector<WallFrame>& frames, double farthest);

  /// Fits, by the smoothing that makes the curve the likeliest.
  void run();

  [[nodiscard]] const CurveBasis& basis() const { return basis_; }
  [[nodiscard]] double error(double true_range) const {
    return basis_.at(true_range).value(coefficients_);
  }
  [[nodiscard]] const InversePlane& plane(std::size_t frame) const { return planes_[frame]; }
  /// 0: the block is not on the wall.
  [[nodiscard]] double weight(std::size_t frame, std::size_t block) const {
    return weights_[frame][block];
  }
  /// By which factor residuals are wider than the noise model has it.
  [[nodiscard]] double noise_scale() const { return noise_scale_; }

  /// A block of a frame by what the other frames say: how far it is off without a table, and with
  /// theirs [m].
  struct Foretold {
    std::size_t block = 0;
    double true_range = 0;  ///< by all frames [m]
    double before = 0, after = 0;
  };
  /// Of those of its blocks on the wall that lie within the ranges of the other frames.
  [[nodiscard]] std::vector<Foretold> foretold(std::size_t frame) const;

 private:
  // Normal equations of the curve; a frame's tilt is eliminated.
  struct Normal {
    Eigen::MatrixXd A;
    Eigen::VectorXd g;
    Eigen::Matrix2d tilt_A;  // of the tilt's change, given the curve
    Eigen::Vector2d tilt_g;
    Eigen::MatrixX2d cross;
  };

  void weigh();
  [[nodiscard]] Normal normal_of(std::size_t frame) const;
  [[nodiscard]] Normal sum_of_all() const;
  [[nodiscard]] Eigen::MatrixXd smoothed(const Eigen::MatrixXd& A) const;
  double step();
  [[nodiscard]] InversePlane refitted(std::size_t frame, const Eigen::VectorXd& coefficients) const;
  [[nodiscard]] std::vector<std::size_t> blocks_others_cover(std::size_t frame) const;

  const std::vector<WallFrame>& frames_;
  double farthest_;
  std::vector<InversePlane> planes_;
  CurveBasis basis_;
  Eigen::MatrixXd roughness_;
  Eigen::VectorXd coefficients_;
  std::vector<std::vector<double>> weights_;  // [m⁻²], a frame, a block
  double noise_scale_ = 1;
  double smoothing_;  // weight of roughness [m⁻²]; 0: not chosen yet
};

}  // namespace viewgain::detail
