// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "registration/seen_space.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace viewgain::detail {
namespace {

constexpr int kTiles = 48;  // across the wider side of the image

template <typename Visit>
void for_each_reading(const DepthFrame& frame, std::span<const Eigen::Vector3d> rays,
                      Visit&& visit) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const double z = static_cast<double>(frame.depth[i]);
    if (z > 0 && std::isfinite(z) && rays[i].allFinite()) visit(z, rays[i]);
  }
}

}  // namespace

SeenSpace::SeenSpace(const DepthFrame& frame, const Sensor& sensor,
                     std::span<const Eigen::Vector3d> rays, const PosePrior& prior, double sigmas,
                     double margin)
    : R_camera_world_(prior.T_world_camera.rotation().transpose()),
      center_(prior.T_world_camera.translation()),
      tile_(0),
      low_x_(0),
      low_y_(0),
      columns_(0),
      rows_(0) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high = -low;
  double nearest = std::numeric_limits<double>::infinity(), deepest = 0;
  for_each_reading(frame, rays, [&](double z, const Eigen::Vector3d& ray) {
    low = low.cwiseMin(ray.head<2>());
    high = high.cwiseMax(ray.head<2>());
    nearest = std::min(nearest, z);
    deepest = std::max(deepest, z);
  });
  if (deepest == 0) return;
  const double shift = sigmas * prior.sigma_translation, turn = sigmas * prior.sigma_rotation;
  // By how much x/z of a point that shows at a reading may be off.
  const double slack = (1 + std::max(high.cwiseAbs2().maxCoeff(), low.cwiseAbs2().maxCoeff())) *
                           std::tan(std::min(turn, 1.0)) +
                       2 * shift / nearest;
  low.array() -= slack;
  high.array() += slack;
  tile_ = std::max((high - low).maxCoeff() / kTiles, 1e-9);  // one reading, a pose known exactly
  low_x_ = low.x(), low_y_ = low.y();
  columns_ = static_cast<int>((high.x() - low.x()) / tile_) + 1;
  rows_ = static_cast<int>((high.y() - low.y()) / tile_) + 1;
  const auto tiles = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  std::vector<double> at(tiles, 0.0);
  for_each_reading(frame, rays, [&](double z, const Eigen::Vector3d& ray) {
    double& depth =
        at[static_cast<std::size_t>(row_of(ray.y())) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column_of(ray.x()))];
    depth = std::max(depth, z);
  });
  const int reach = static_cast<int>(std::ceil(slack / tile_));
  depth_.assign(tiles, 0.0);
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      double depth = 0;
      for (int r = std::max(0, row - reach); r <= std::min(rows_ - 1, row + reach); ++r) {
        for (int c = std::max(0, column - reach); c <= std::min(columns_ - 1, column + reach);
             ++c) {
          depth =
              std::max(depth, at[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) +
                                 static_cast<std::size_t>(c)]);
        }
      }
      if (depth == 0) continue;
      depth_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
             static_cast<std::size_t>(column)] =
          depth + shift + turn * 2 * depth + 4 * sensor.noise_sigmas(depth).axial + margin;
    }
  }
}

int SeenSpace::column_of(double x) const { return static_cast<int>((x - low_x_) / tile_); }
int SeenSpace::row_of(double y) const { return static_cast<int>((y - low_y_) / tile_); }

bool SeenSpace::contains(const Eigen::Vector3d& p_world) const {
  const Eigen::Vector3d p = R_camera_world_ * (p_world - center_);
  if (!(p.z() > 0) || depth_.empty()) return false;
  const double x = p.x() / p.z(), y = p.y() / p.z();
  if (!(x >= low_x_ && y >= low_y_)) return false;
  if (!(x < low_x_ + columns_ * tile_ && y < low_y_ + rows_ * tile_)) return false;
  return p.z() <= depth_[static_cast<std::size_t>(row_of(y)) * static_cast<std::size_t>(columns_) +
                         static_cast<std::size_t>(column_of(x))];
}

}  // namespace viewgain::detail
