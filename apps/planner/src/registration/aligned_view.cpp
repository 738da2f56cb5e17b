// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "registration/aligned_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "viewgain/core/noise.hpp"

namespace viewgain::detail {
AlignedView::AlignedView(const DepthFrame& frame, const PinholeCamera& camera,
                         std::vector<Reading> readings)
    : camera_(camera), readings_(std::move(readings)), depth_(frame.depth) {
  stride_ = 0;
  for (const Reading& r : readings_) stride_ = std::gcd(std::gcd(stride_, r.u), r.v);
  stride_ = std::max(stride_, 1);
  columns_ = (camera.width + stride_ - 1) / stride_;
  rows_ = (camera.height + stride_ - 1) / stride_;
  at_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), -1);
  variances_.reserve(readings_.size());
  for (std::size_t i = 0; i < readings_.size(); ++i) {
    const Reading& r = readings_[i];
    at_[static_cast<std::size_t>(r.v / stride_) * static_cast<std::size_t>(columns_) +
        static_cast<std::size_t>(r.u / stride_)] = static_cast<std::int32_t>(i);
    const double cosine = std::abs(r.normal.dot(r.point)) / r.point.norm();
    const double sigma = sigma_along_normal(r.sigmas, cosine);
    variances_.push_back(r.extrapolation * sigma * sigma);
  }
}

std::int32_t AlignedView::reading_at(double u, double v) const {
  const int column = static_cast<int>(std::floor(u / stride_ + 0.5));
  const int row = static_cast<int>(std::floor(v / stride_ + 0.5));
  if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return -1;
  return at_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
             static_cast<std::size_t>(column)];
}

bool AlignedView::looks_past(const Eigen::Vector3d& point, double margin, double reach) const {
  if (!(point.z() > 0)) return false;
  const Eigen::Vector2d pixel = camera_.project(point);
  const int round = std::max(1, static_cast<int>(reach * camera_.fx / point.z()));
  const Eigen::Vector2d size(camera_.width, camera_.height);
  if (!((pixel.array() >= round).all() && (pixel.array() + round < size.array() - 1).all())) {
    return false;
  }
  const int u = static_cast<int>(pixel.x() + 0.5), v = static_cast<int>(pixel.y() + 0.5);
  for (int y = v - round; y <= v + round; ++y) {
    for (int x = u - round; x <= u + round; ++x) {
      const float z = depth_at(x, y);
      if (z != DepthFrame::kInvalid && static_cast<double>(z) < point.z() + margin) return false;
    }
  }
  return depth_at(u, v) != DepthFrame::kInvalid;
}

ViewSums pair_sums(const AlignedView& source, const Pose& T_world_source,
                   const PairGates& source_gates, const AlignedView& target,
                   const Pose& T_world_target, const PairGates& target_gates, double rim_width,
                   int level, std::vector<std::uint8_t>* is_paired) {
  const Pose T_target_source = T_world_target.inverse() * T_world_source;
  const Eigen::Matrix3d R = T_target_source.rotation();
  const Eigen::Vector3d t = T_target_source.translation();
  const double along = source_gates.along_surface * source_gates.along_surface;
  ViewSums sums;  // the target's axes
  for (std::size_t i = 0; i < source.readings().size(); ++i) {
    const Reading& s = source.readings()[i];
    if (s.level > level) continue;
    const Eigen::Vector3d arm = R * (s.point - rim_width * s.rim * s.normal);
    const Eigen::Vector3d p = arm + t;
    if (!(p.z() > 0)) continue;
    double u = 0, v = 0;
    target.camera().project(p, u, v);
    const std::int32_t at = target.reading_at(u, v);
    if (at < 0) continue;
    const auto j = static_cast<std::size_t>(at);
    const Reading& m = target.readings()[j];
    const Eigen::Vector3d source_normal = R * s.normal;
    if (source_normal.dot(m.normal) < source_gates.min_cosine) continue;
    const Eigen::Vector3d d = p - (m.point - rim_width * m.rim * m.normal);
    // Along the mean of both: of one alone the noise pulls more, and on what is curved a point
    // beside the other lies off its plane. That it turns with the frames is left out of J, as is
    // usual: d is short.
    const Eigen::Vector3d normal = (source_normal + m.normal).normalized();
    const double e = normal.dot(d);
    const double slack =
        source_gates.slack_variance(s.point.norm()) + target_gates.slack_variance(m.point.norm());
    const double variance = source.variance(i) + target.variance(j);
    const double square = e * e / (variance + slack);
    if (square > kGateSigmas * kGateSigmas) continue;
    if (d.squaredNorm() - e * e > along + slack) continue;
    const double weight = 1 / (1 + square / (kCauchy * kCauchy)) / variance;
    const auto derivative_along = [&arm](const Eigen::Vector3d& n) {
      Vector6 derivative;
      derivative << n, arm.cross(n);
      return derivative;
    };
    const Vector6 derivative = derivative_along(normal);
    const Vector6 weighted = weight * derivative;
    sums.information += weighted * derivative.transpose();
    // Of these two the noise is independent.
    sums.agreed +=
        weight * derivative_along(m.normal) * derivative_along(source_normal).transpose();
    sums.gradient += e * weighted;
    const double by_width = m.rim * normal.dot(m.normal) - s.rim * normal.dot(source_normal);
    sums.rim_motion += by_width * weighted;
    sums.rim_information += weight * by_width * by_width;
    sums.rim_gradient += weight * by_width * e;
    sums.squares += e * e;
    ++sums.pairs;
    if (is_paired != nullptr) (*is_paired)[i] = 1;
  }
  Matrix6 to_world = Matrix6::Zero();
  to_world.topLeftCorner<3, 3>() = T_world_target.rotation();
  to_world.bottomRightCorner<3, 3>() = T_world_target.rotation();
  sums.information = (to_world * sums.information * to_world.transpose()).eval();
  sums.agreed =
      (0.5 * to_world * (sums.agreed + sums.agreed.transpose()) * to_world.transpose()).eval();
  sums.gradient = (to_world * sums.gradient).eval();
  sums.rim_motion = (to_world * sums.rim_motion).eval();
  return sums;
}

}  // namespace viewgain::detail
