// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "calibration/wall_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "calibration/wall_frame.hpp"

namespace viewgain::detail {
namespace {

double weighted(const std::array<double, CurveBasis::kLocal>& weights, int first,
                const Eigen::VectorXd& coefficients) {
  double sum = 0;
  for (int k = 0; k < CurveBasis::kLocal; ++k) {
    sum += weights[static_cast<std::size_t>(k)] * coefficients[first + k];
  }
  return sum;
}

}  // namespace

double CurveBasis::Local::value(const Eigen::VectorXd& coefficients) const {
  return weighted(values, first, coefficients);
}
double CurveBasis::Local::slope(const Eigen::VectorXd& coefficients) const {
  return weighted(slopes, first, coefficients);
}

CurveBasis::CurveBasis(double from, double to, int pieces)
    : from_(from), step_((to - from) / pieces), pieces_(pieces) {}

int CurveBasis::piece(double place) const {
  return static_cast<int>(
      std::clamp(std::floor((place - from_) / step_), 0.0, static_cast<double>(pieces_ - 1)));
}

CurveBasis::Local CurveBasis::at(double place) const {
  Local local;
  local.first = piece(place);
  const double s = (place - begin_of(local.first)) / step_, r = 1 - s;
  local.values = {r * r * r / 6, (3 * s * s * s - 6 * s * s + 4) / 6,
                  (3 * r * r * r - 6 * r * r + 4) / 6, s * s * s / 6};
  local.slopes = {-r * r / 2 / step_, (3 * s * s - 4 * s) / 2 / step_,
                  (4 * r - 3 * r * r) / 2 / step_, s * s / 2 / step_};
  return local;
}

Eigen::MatrixXd CurveBasis::roughness() const {
  Eigen::MatrixXd form = Eigen::MatrixXd::Zero(size(), size());
  const Eigen::Vector3d difference(1, -2, 1);
  for (int i = 0; i + 2 < size(); ++i) {
    form.block<3, 3>(i, i) += difference * difference.transpose();
  }
  return form;
}

namespace {

constexpr double kPieceLength = 0.03;  // of the curve, where that makes not too many [m]
constexpr int kLeastPieces = 4, kMostPieces = 120;
constexpr double kModelError = 5e-4;  // that no count of readings makes less [m]
constexpr double kOffWall = 3e-3;     // and so many sigmas off: not on the wall [m]
constexpr double kOffWallSigmas = 5;
constexpr double kFirstSmoothing = 1e-3;  // weight of roughness, in data of a spline
constexpr double kLeastSmoothing = 1e-9, kMostSmoothing = 1e4;
constexpr double kStraight = 2;  // parameters of a curve without roughness
constexpr int kMostTurns = 60;
constexpr double kSettled = 1e-6;  // [m]

bool is_seen(double range, double farthest) { return range > 0 && range < farthest; }

CurveBasis basis_of(const std::vector<WallFrame>& frames, double farthest) {
  double from = std::numeric_limits<double>::infinity(), to = 0;
  for (const WallFrame& frame : frames) {
    for (const WallBlock& block : frame.blocks) {
      const double range = range_to(frame.plane, block.ray);
      if (!is_seen(range, farthest)) continue;
      from = std::min(from, range);
      to = std::max(to, range);
    }
  }
  to = std::max(to, from + kPieceLength);
  const int pieces = static_cast<int>(std::ceil((to - from) / kPieceLength));
  return {from, to, std::clamp(pieces, kLeastPieces, kMostPieces)};
}

// Data of a spline, on the mean.
double unit_of(const Eigen::MatrixXd& A) { return A.trace() / static_cast<double>(A.rows()); }

// How the range to a plane goes with x and y of the plane.
Eigen::Vector2d slope_of_range(double range, const Eigen::Vector3d& ray) {
  return -range * range / ray.norm() * ray.head<2>();
}

}  // namespace

WallFit::WallFit(const std::vector<WallFrame>& frames, double farthest)
    : frames_(frames),
      farthest_(farthest),
      basis_(basis_of(frames, farthest)),
      roughness_(basis_.roughness()),
      coefficients_(Eigen::VectorXd::Zero(basis_.size())),
      smoothing_(0) {
  for (const WallFrame& frame : frames_) {
    planes_.push_back(frame.plane);
    weights_.emplace_back(frame.blocks.size(), 0.0);
  }
}

void WallFit::weigh() {
  std::vector<std::vector<double>> residuals(frames_.size());
  std::vector<double> in_sigmas;
  const auto sigma_of = [](const WallBlock& block) { return std::hypot(block.sigma, kModelError); };
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    for (const WallBlock& block : frames_[f].blocks) {
      const double range = range_to(planes_[f], block.ray);
      residuals[f].push_back(is_seen(range, farthest_) ? block.range - range - error(range)
                                                       : std::numeric_limits<double>::infinity());
      in_sigmas.push_back(std::abs(residuals[f].back()) / sigma_of(block));
    }
  }
  noise_scale_ = kSigmaByMedian * median(std::move(in_sigmas));
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    for (std::size_t b = 0; b < residuals[f].size(); ++b) {
      const double sigma = sigma_of(frames_[f].blocks[b]);
      const double share = residuals[f][b] / (kOffWall + kOffWallSigmas * noise_scale_ * sigma);
      const double tukey = std::abs(share) < 1 ? std::pow(1 - share * share, 2) : 0.0;
      weights_[f][b] = tukey / (sigma * sigma);
    }
  }
}

WallFit::Normal WallFit::normal_of(std::size_t f) const {
  const int n = basis_.size();
  constexpr int kLocal = CurveBasis::kLocal;
  Normal normal{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), Eigen::Matrix2d::Zero(),
                Eigen::Vector2d::Zero(), Eigen::MatrixX2d::Zero(n, 2)};
  for (std::size_t b = 0; b < frames_[f].blocks.size(); ++b) {
    const double weight = weights_[f][b];
    if (weight == 0) continue;
    const WallBlock& block = frames_[f].blocks[b];
    const double range = range_to(planes_[f], block.ray);
    const CurveBasis::Local local = basis_.at(range);
    const Eigen::Map<const Eigen::Vector4d> splines(local.values.data());
    const Eigen::Vector2d tilt =
        (1 + local.slope(coefficients_)) * slope_of_range(range, block.ray);
    const double off = block.range - range;
    normal.A.block<kLocal, kLocal>(local.first, local.first) +=
        weight * splines * splines.transpose();
    normal.g.segment<kLocal>(local.first) += weight * off * splines;
    normal.cross.block<kLocal, 2>(local.first, 0) += weight * splines * tilt.transpose();
    normal.tilt_A += weight * tilt * tilt.transpose();
    normal.tilt_g += weight * off * tilt;
  }
  if (frames_[f].tilt_is_known) return normal;
  // A line of pixels does not tell the tilt about itself.
  normal.tilt_A.diagonal().array() += 1e-9 * normal.tilt_A.trace();
  const Eigen::MatrixX2d share = normal.tilt_A.ldlt().solve(normal.cross.transpose()).transpose();
  normal.A -= share * normal.cross.transpose();
  normal.g -= share * normal.tilt_g;
  return normal;
}

WallFit::Normal WallFit::sum_of_all() const {
  Normal sum = normal_of(0);
  for (std::size_t f = 1; f < frames_.size(); ++f) {
    const Normal normal = normal_of(f);
    sum.A += normal.A;
    sum.g += normal.g;
  }
  return sum;
}

Eigen::MatrixXd WallFit::smoothed(const Eigen::MatrixXd& A) const {
  Eigen::MatrixXd whole = A + smoothing_ * roughness_;
  whole.diagonal().array() += 1e-10 * unit_of(A);  // where there is but one range
  return whole;
}

// Returns by how much the curve has changed [m].
double WallFit::step() {
  weigh();
  const Normal sum = sum_of_all();
  const double unit = unit_of(sum.A);
  if (smoothing_ == 0) smoothing_ = kFirstSmoothing * unit;
  const Eigen::LDLT<Eigen::MatrixXd> solver(smoothed(sum.A));
  const Eigen::VectorXd coefficients = solver.solve(sum.g);
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    if (frames_[f].tilt_is_known) continue;
    const Normal normal = normal_of(f);
    planes_[f].head<2>() +=
        normal.tilt_A.ldlt().solve(normal.tilt_g - normal.cross.transpose() * coefficients);
  }
  // The likeliest smoothing for differences that are as large as those found (Wood and Fasiolo,
  // Biometrics 73, 2017).
  const double parameters = solver.solve(sum.A).trace() - kStraight;
  const double roughness = coefficients.dot(roughness_ * coefficients);
  smoothing_ = std::clamp(noise_scale_ * noise_scale_ * std::max(parameters, 1.0) /
                              std::max(roughness, std::numeric_limits<double>::min()),
                          kLeastSmoothing * unit, kMostSmoothing * unit);
  const double change = (coefficients - coefficients_).lpNorm<Eigen::Infinity>();
  coefficients_ = coefficients;
  return change;
}

void WallFit::run() {
  for (int turn = 0; turn < kMostTurns && step() > kSettled; ++turn) {
  }
  weigh();
}

std::vector<std::size_t> WallFit::blocks_others_cover(std::size_t f) const {
  double from = std::numeric_limits<double>::infinity(), to = 0;
  for (std::size_t other = 0; other < frames_.size(); ++other) {
    if (other == f) continue;
    for (std::size_t b = 0; b < frames_[other].blocks.size(); ++b) {
      if (weights_[other][b] == 0) continue;
      const double range = range_to(planes_[other], frames_[other].blocks[b].ray);
      from = std::min(from, range);
      to = std::max(to, range);
    }
  }
  std::vector<std::size_t> covered;
  for (std::size_t b = 0; b < frames_[f].blocks.size(); ++b) {
    const double range = range_to(planes_[f], frames_[f].blocks[b].ray);
    if (weights_[f][b] > 0 && range >= from && range <= to) covered.push_back(b);
  }
  return covered;
}

// The frame's plane for a curve that is given.
InversePlane WallFit::refitted(std::size_t f, const Eigen::VectorXd& coefficients) const {
  constexpr int kTurns = 5;
  InversePlane plane = planes_[f];
  if (frames_[f].tilt_is_known) return plane;
  for (int turn = 0; turn < kTurns; ++turn) {
    Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
    Eigen::Vector2d g = Eigen::Vector2d::Zero();
    for (std::size_t b = 0; b < frames_[f].blocks.size(); ++b) {
      if (weights_[f][b] == 0) continue;
      const WallBlock& block = frames_[f].blocks[b];
      const double range = range_to(plane, block.ray);
      const CurveBasis::Local local = basis_.at(range);
      const Eigen::Vector2d tilt =
          (1 + local.slope(coefficients)) * slope_of_range(range, block.ray);
      A += weights_[f][b] * tilt * tilt.transpose();
      g += weights_[f][b] * (block.range - range - local.value(coefficients)) * tilt;
    }
    A.diagonal().array() += 1e-9 * A.trace();
    plane.head<2>() += A.ldlt().solve(g);
  }
  return plane;
}

std::vector<WallFit::Foretold> WallFit::foretold(std::size_t f) const {
  std::vector<Foretold> blocks;
  const std::vector<std::size_t> covered = blocks_others_cover(f);
  if (covered.empty()) return blocks;
  const Normal sum = sum_of_all(), own = normal_of(f);
  const Eigen::VectorXd coefficients = smoothed(sum.A - own.A).ldlt().solve(sum.g - own.g);
  const InversePlane plane = refitted(f, coefficients);
  for (const std::size_t b : covered) {
    const WallBlock& block = frames_[f].blocks[b];
    const double by_all = range_to(planes_[f], block.ray), by_others = range_to(plane, block.ray);
    blocks.push_back({b, by_all, block.range - by_all,
                      block.range - by_others - basis_.at(by_others).value(coefficients)});
  }
  return blocks;
}

}  // namespace viewgain::detail
