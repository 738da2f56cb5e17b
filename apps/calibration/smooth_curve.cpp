// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "calibration/smooth_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

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

}  // namespace viewgain::detail
