// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/frame_displacement.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace viewgain {
namespace {

constexpr double kHalfWidth = 0.02;  // tangent of the angle of the pixel square
constexpr double kMostPixels = 3;    // limit on each side
constexpr double kUneven = 0.002;  // relative to depth: deviation from a plane in addition to noise
constexpr std::size_t kFewPairs = 60;   // minimum for a fit
constexpr int kRounds = 4;              // iterations of reweighting (Huber 1964)
constexpr double kHuber = 1.5;          // standard deviations
constexpr double kMadToSigma = 1.4826;  // of a normal distribution
constexpr double kUndetermined = 1e-9;  // relative to the normal equations: smaller motions stay 0

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

// Inverse depth of a plane is linear in the pixel. A paraboloid, whose terms are orthogonal over
// the square, gives the value at the centre; the mean of a curved surface would lie behind it.
std::optional<Eigen::Vector3d> plane_at(const DepthFrame& frame, const PinholeCamera& camera,
                                        const std::vector<Eigen::Vector3d>& rays, std::size_t u,
                                        std::size_t v, double sigma) {
  const auto width = static_cast<std::size_t>(camera.width);
  const auto height = static_cast<std::size_t>(camera.height);
  const auto half = static_cast<std::size_t>(std::clamp(kHalfWidth * camera.fx, 1.0, kMostPixels));
  if (u < half || v < half || u + half >= width || v + half >= height) return std::nullopt;
  const std::size_t centre = v * width + u, first = centre - half * width - half;
  const auto side = static_cast<int>(2 * half + 1);
  const auto middle = static_cast<double>(half);
  const double count = static_cast<double>(side) * side;
  const double squares = count * middle * (middle + 1) / 3;  // sum of i², and of j²
  const double mean_square = 2 * squares / count;            // of i² + j²
  std::array<double, 49> inverse{};
  double sum = 0, sum_u = 0, sum_v = 0, sum_bent = 0, bends = 0;
  for (int j = 0, k = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i, ++k) {
      const auto z = static_cast<double>(
          frame.depth[first + static_cast<std::size_t>(j) * width + static_cast<std::size_t>(i)]);
      if (!(z > 0) || !std::isfinite(z)) return std::nullopt;
      const double x = i - middle, y = j - middle, bent = x * x + y * y - mean_square;
      const double w = 1 / z;
      inverse[static_cast<std::size_t>(k)] = w;
      sum += w;
      sum_u += x * w;
      sum_v += y * w;
      sum_bent += bent * w;
      bends += bent * bent;
    }
  }
  const double mean = sum / count, by_u = sum_u / squares, by_v = sum_v / squares;
  double uneven = 0;
  for (int j = 0, k = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i, ++k) {
      const double off =
          mean + by_u * (i - middle) + by_v * (j - middle) - inverse[static_cast<std::size_t>(k)];
      uneven += off * off;
    }
  }
  const double allowed = mean * (2 * sigma * mean + kUneven);
  if (uneven > count * allowed * allowed) return std::nullopt;

  const Eigen::Vector3d along_u = rays[centre + half] - rays[centre - half];
  const Eigen::Vector3d along_v = rays[centre + half * width] - rays[centre - half * width];
  const double area = along_u.x() * along_v.y() - along_u.y() * along_v.x();
  const double du = 2 * middle * by_u, dv = 2 * middle * by_v;
  const double x = (du * along_v.y() - dv * along_u.y()) / area;
  const double y = (dv * along_u.x() - du * along_v.x()) / area;
  const double at_centre = mean - sum_bent / bends * mean_square;
  const Eigen::Vector3d plane(x, y, at_centre - x * rays[centre].x() - y * rays[centre].y());
  if (!plane.allFinite()) return std::nullopt;  // a pixel without a ray
  return plane;
}

void DisplacementFit::add(const Eigen::Vector3d& p, const Eigen::Vector3d& normal, double distance,
                          double expected) {
  Pair pair;
  pair.by_motion << p.cross(normal), normal;
  pair.distance = distance;
  pair.expected = expected;
  pairs_.push_back(pair);
}

bool DisplacementFit::tells() const { return pairs_.size() >= kFewPairs; }

double DisplacementFit::displacement() const {
  const double least = 0.25 * expected();
  Eigen::Matrix<double, 6, 1> motion = Eigen::Matrix<double, 6, 1>::Zero();
  std::vector<double> off(pairs_.size());
  double sigma = 0;
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      off[k] = std::abs(pairs_[k].distance + pairs_[k].by_motion.dot(motion));
    }
    sigma = std::max(kMadToSigma * median_of(off), least);
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      const double weight = 1 / std::max(1.0, off[k] / (kHuber * sigma));
      normal.noalias() += weight * pairs_[k].by_motion * pairs_[k].by_motion.transpose();
      right -= weight * pairs_[k].distance * pairs_[k].by_motion;
    }
    normal.diagonal().array() += kUndetermined * normal.trace();
    motion = normal.ldlt().solve(right);
  }
  double squares = 0;
  for (const Pair& pair : pairs_) {
    const double moved = pair.by_motion.dot(motion);
    squares += moved * moved;
  }
  // Noise affects six parameters.
  return std::sqrt(
      std::max(0.0, (squares - 6 * sigma * sigma) / static_cast<double>(pairs_.size())));
}

double DisplacementFit::expected() const {
  std::vector<double> all;
  for (const Pair& pair : pairs_) all.push_back(pair.expected);
  return median_of(std::move(all));
}

}  // namespace viewgain
