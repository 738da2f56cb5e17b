// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "voxel_oracle.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "grid/analytic_frames.hpp"
#include "grid/voxels.hpp"

namespace viewgain::test {
namespace {

constexpr int kUnknown = std::numeric_limits<int>::min();
constexpr int kNothing = std::numeric_limits<int>::min();

/// What a pixel says: how far it looks, and whether it ends in a reading.
struct Pixel {
  bool valid = false;
  bool reading = false;
  double range = 0;  // of the reading, or max_range
};

Pixel pixel_at(const Sensor& sensor, const DepthFrame& frame, int u, int v) {
  const double depth = frame.at(u, v);
  const double range = depth * sensor.camera.ray(u, v).norm();
  Pixel pixel;
  if (!(depth > 0) || !(range >= sensor.min_range)) return pixel;
  pixel.valid = true;
  pixel.reading = range <= sensor.max_range;
  pixel.range = pixel.reading ? range : sensor.max_range;
  return pixel;
}

/// Steps that a crossing at range r takes off, or nothing.
std::optional<int> crossing(const Sensor& sensor, const Pixel& pixel, double r) {
  if (!pixel.valid) return std::nullopt;
  if (!pixel.reading) return r <= pixel.range ? std::optional(-8) : std::nullopt;
  if (!(r < pixel.range)) return std::nullopt;
  const double sigma = sensor.sigmas(pixel.range).axial;
  const double weight = 8.0 * std::min(1.0, (pixel.range - r) / (3.0 * sigma));
  return -static_cast<int>(std::floor(weight + 0.5));
}

/// The pixel whose pyramid holds the point; false beyond the lens model's fold, where the pixel's
/// own ray comes back elsewhere.
bool holding_pixel(const PinholeCamera& camera, const Eigen::Vector3d& p, int& u, int& v) {
  if (!(p.z() > 0)) return false;
  const Eigen::Vector2d at = camera.project(p);
  const double pu = std::floor(at.x() + 0.5), pv = std::floor(at.y() + 0.5);
  if (!(pu >= 0 && pu < camera.width && pv >= 0 && pv < camera.height)) return false;
  u = static_cast<int>(pu);
  v = static_cast<int>(pv);
  // Near the axis no lens model of the tests folds.
  if (!camera.has_distortion() || p.head<2>().squaredNorm() < 0.4 * p.z() * p.z()) return true;
  const Eigen::Vector3d ray = camera.ray(at.x(), at.y());
  return (ray - p / p.z()).norm() < 1e-6;
}

// The reading put along the normal onto the plane through the readings of 5x5 pixels, by a
// factorisation; the normal is the cross product of differences on the plane. Camera's frame.
std::optional<Eigen::Vector3d> on_surface(const Sensor& sensor, const DepthFrame& frame, int u0,
                                          int v0) {
  const PinholeCamera& camera = sensor.camera;
  const double z0 = frame.at(u0, v0);
  const Eigen::Vector3d reading = z0 * camera.ray(u0, v0);
  const MeasurementSigmas s = sensor.sigmas(reading.norm());
  std::vector<Eigen::Vector3d> near;  // 1, column, row, then depth
  std::vector<double> depths;
  for (int v = std::max(0, v0 - 2); v <= std::min(camera.height - 1, v0 + 2); ++v) {
    for (int u = std::max(0, u0 - 2); u <= std::min(camera.width - 1, u0 + 2); ++u) {
      if (!pixel_at(sensor, frame, u, v).reading) continue;
      const double across = std::hypot(u - u0, v - v0) * z0 / std::min(camera.fx, camera.fy);
      const double dz = frame.at(u, v) - z0;
      if (std::abs(dz) > 2 * across + 3 * std::sqrt(2.0) * s.axial) continue;
      near.emplace_back(1, u - u0, v - v0);
      depths.push_back(dz);
    }
  }
  if (near.size() < 6) return std::nullopt;
  const auto count = static_cast<Eigen::Index>(near.size());
  const Eigen::MatrixX3d A = Eigen::Map<Eigen::Matrix3Xd>(near[0].data(), 3, count).transpose();
  const auto qr = A.colPivHouseholderQr();
  if (qr.rank() < 3) return std::nullopt;
  const Eigen::Vector3d fit = qr.solve(Eigen::Map<Eigen::VectorXd>(depths.data(), count));
  const auto on_plane = [&](double i, double j) -> Eigen::Vector3d {
    const Eigen::Vector3d ray = reading / z0 + Eigen::Vector3d(i / camera.fx, j / camera.fy, 0);
    return ray * (z0 + fit[0] + fit[1] * i + fit[2] * j);
  };
  constexpr double h = 1e-3;  // pixels
  const Eigen::Vector3d away =
      (on_plane(h, 0) - on_plane(-h, 0)).cross(on_plane(0, h) - on_plane(0, -h)).normalized();
  const double cosine = away.dot(reading.normalized());
  if (cosine < 0.1) return std::nullopt;
  const double sigma = std::hypot(cosine * s.axial, std::sqrt(1 - cosine * cosine) * s.lateral);
  const double distance = away.dot(on_plane(0, 0) - reading);
  if (std::abs(distance) > 3 * sigma) return std::nullopt;
  return reading + distance * away;
}

}  // namespace

VoxelOracle::VoxelOracle(const BeliefGrid& grid)
    : min_(grid.min_index()),
      dims_(grid.dims()),
      voxel_size_(grid.voxel_size()),
      T_world_grid_(grid.T_world_grid()),
      steps_(grid.voxel_count(), kUnknown) {}

std::size_t VoxelOracle::position(Index3 v) const {
  return (static_cast<std::size_t>(v.x - min_.x) * static_cast<std::size_t>(dims_.y) +
          static_cast<std::size_t>(v.y - min_.y)) *
             static_cast<std::size_t>(dims_.z) +
         static_cast<std::size_t>(v.z - min_.z);
}

Eigen::Vector3d VoxelOracle::center(Index3 v) const {
  return {(v.x + 0.5) * voxel_size_, (v.y + 0.5) * voxel_size_, (v.z + 0.5) * voxel_size_};
}

Index3 VoxelOracle::voxel_of(std::size_t position) const {
  const auto n = static_cast<int>(position);
  return {min_.x + n / dims_.z / dims_.y, min_.y + n / dims_.z % dims_.y, min_.z + n % dims_.z};
}

std::optional<std::size_t> VoxelOracle::voxel_at(const Eigen::Vector3d& p) const {
  const Index3 voxel{static_cast<int>(std::floor(p.x() / voxel_size_)),
                     static_cast<int>(std::floor(p.y() / voxel_size_)),
                     static_cast<int>(std::floor(p.z() / voxel_size_))};
  if (voxel.x < min_.x || voxel.x >= min_.x + dims_.x || voxel.y < min_.y ||
      voxel.y >= min_.y + dims_.y || voxel.z < min_.z || voxel.z >= min_.z + dims_.z) {
    return std::nullopt;
  }
  return position(voxel);
}

// Lists the values along the ray, and takes the largest of those more than twice the start's.
std::size_t VoxelOracle::best_supported(const Eigen::Vector3d& start, const Eigen::Vector3d& ray,
                                        double sigma,
                                        const std::map<std::size_t, double>& support) const {
  const double reach = std::min(3.0 * sigma, 8.0 * voxel_size_);
  const std::size_t own = *voxel_at(start);
  std::vector<std::array<double, 3>> found;  // value, -|t|, -t
  std::vector<std::size_t> voxels;
  for (int step = -16; step <= 16; ++step) {
    const double t = 0.5 * step * voxel_size_;
    if (step == 0 || !(std::abs(t) < reach)) continue;
    const std::optional<std::size_t> voxel = voxel_at(start + t * ray);
    if (!voxel || !support.contains(*voxel)) continue;
    found.push_back({support.at(*voxel) * (1 - t * t / (reach * reach)), -std::abs(t), -t});
    voxels.push_back(*voxel);
  }
  const auto best = std::max_element(found.begin(), found.end());
  if (best == found.end() || !((*best)[0] > 2 * support.at(own))) return own;
  return voxels[static_cast<std::size_t>(best - found.begin())];
}

void VoxelOracle::integrate(const Sensor& sensor, const DepthFrame& frame,
                            const Pose& T_world_camera, const IntegrationConfig& config) {
  const PinholeCamera& camera = sensor.camera;
  const Pose T_camera_grid = T_world_camera.inverse() * T_world_grid_;
  const Pose T_grid_camera = T_world_grid_.inverse() * T_world_camera;
  std::vector<int> deltas(steps_.size(), kNothing);

  std::vector<Pixel> pixels;
  std::vector<Eigen::Vector3d> rays;  // unit, grid frame
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      pixels.push_back(pixel_at(sensor, frame, u, v));
      rays.push_back(T_grid_camera.rotation() * camera.ray(u, v).normalized());
    }
  }
  // Plain numbers: the line loop also runs where nothing is optimised.
  const double eye[3] = {T_grid_camera.m[3], T_grid_camera.m[7], T_grid_camera.m[11]};
  std::vector<std::array<double, 3>> directions;
  for (const Eigen::Vector3d& ray : rays) directions.push_back({ray.x(), ray.y(), ray.z()});

  for_each_voxel(VoxelBox::from_dims(min_, dims_), [&](Index3 voxel) {
    const auto [i, j, k] = voxel;
    int& delta = deltas[position({i, j, k})];
    if (config.carve == IntegrationConfig::Carve::cones) {
      const Eigen::Vector3d c = center({i, j, k});
      const auto& T = T_camera_grid.m;
      const Eigen::Vector3d p(T[0] * c.x() + T[1] * c.y() + T[2] * c.z() + T[3],
                              T[4] * c.x() + T[5] * c.y() + T[6] * c.z() + T[7],
                              T[8] * c.x() + T[9] * c.y() + T[10] * c.z() + T[11]);
      int u = 0, v = 0;
      if (!holding_pixel(camera, p, u, v)) return;
      const double range = std::sqrt(p.x() * p.x() + p.y() * p.y() + p.z() * p.z());
      const auto said =
          crossing(sensor, pixels[static_cast<std::size_t>(v * camera.width + u)], range);
      if (said) delta = *said;
      return;
    }
    // Lines: the slab test of every ray with this voxel.
    const double low[3] = {i * voxel_size_ - eye[0], j * voxel_size_ - eye[1],
                           k * voxel_size_ - eye[2]};
    const double high[3] = {(i + 1) * voxel_size_ - eye[0], (j + 1) * voxel_size_ - eye[1],
                            (k + 1) * voxel_size_ - eye[2]};
    for (std::size_t n = 0; n < pixels.size(); ++n) {
      if (!pixels[n].valid) continue;
      double enter = 0, leave = pixels[n].range + 1.0;
      for (int a = 0; a < 3 && enter < leave; ++a) {
        const double t0 = low[a] / directions[n][a], t1 = high[a] / directions[n][a];
        enter = t0 < t1 ? (t0 > enter ? t0 : enter) : (t1 > enter ? t1 : enter);
        leave = t0 < t1 ? (t1 < leave ? t1 : leave) : (t0 < leave ? t0 : leave);
      }
      if (!(leave - enter > 1e-13)) continue;
      const auto said = crossing(sensor, pixels[n], enter);
      if (said) delta = delta == kNothing ? *said : std::min(delta, *said);
    }
  });

  std::vector<std::optional<std::size_t>> own(pixels.size());  // voxel that a reading lies in
  std::vector<Eigen::Vector3d> starts(pixels.size());          // where its support is sought
  std::vector<Eigen::Vector3d> points(pixels.size());
  std::map<std::size_t, double> support;
  for (const auto& [voxel, fused] : fused_) {
    if (steps_[voxel] != kUnknown && steps_[voxel] > 0) support[voxel] = fused.hits;
  }
  for (std::size_t n = 0; n < pixels.size(); ++n) {
    if (!pixels[n].reading) continue;
    const int u = static_cast<int>(n) % camera.width, v = static_cast<int>(n) / camera.width;
    points[n] = T_grid_camera * (camera.ray(u, v) * double{frame.at(u, v)});
    own[n] = voxel_at(points[n]);
    if (!own[n]) continue;
    starts[n] = points[n];
    if (config.occupancy != IntegrationConfig::Occupancy::literal &&
        sensor.sigmas(pixels[n].range).axial >= 0.5 * voxel_size_) {
      const auto surface = on_surface(sensor, frame, u, v);
      if (surface && voxel_at(T_grid_camera * *surface)) starts[n] = T_grid_camera * *surface;
    }
    ++support[*voxel_at(starts[n])];
  }

  std::vector<bool> is_hit(steps_.size(), false);
  moved_ = 0;
  for (std::size_t n = 0; n < pixels.size(); ++n) {
    if (!own[n]) continue;
    const MeasurementSigmas s = sensor.sigmas(pixels[n].range);
    std::size_t voxel = *own[n];
    if (config.occupancy != IntegrationConfig::Occupancy::literal && s.axial >= 0.5 * voxel_size_) {
      voxel = best_supported(starts[n], rays[n], s.axial, support);
    }
    if (voxel != *own[n]) ++moved_;
    is_hit[voxel] = true;
    const Eigen::Matrix3d along = rays[n] * rays[n].transpose();
    const Eigen::Matrix3d covariance =
        s.lateral * s.lateral * (Eigen::Matrix3d::Identity() - along) + s.axial * s.axial * along;
    const Eigen::Matrix3d information = covariance.inverse();
    Fused& fused = fused_[voxel];
    fused.information += information;
    fused.vector += information * (points[n] - center(voxel_of(voxel)));
    ++fused.hits;
  }

  crossed_ = hit_ = 0;
  for (std::size_t n = 0; n < steps_.size(); ++n) {
    const int before = steps_[n] == kUnknown ? 0 : steps_[n];
    const bool literal = config.occupancy == IntegrationConfig::Occupancy::literal;
    if (is_hit[n]) {
      steps_[n] = literal ? 17 : std::min(before + 17, 70);
      ++hit_;
    } else if (deltas[n] != kNothing) {
      steps_[n] = literal ? -8 : std::max(before + deltas[n], -40);
      ++crossed_;
    }
  }
}

std::uint64_t VoxelOracle::differences(const BeliefGrid& grid) const {
  std::uint64_t differences = 0;
  for_each_voxel(VoxelBox::from_dims(min_, dims_), [&](Index3 voxel) {
    const int steps = steps_[position(voxel)];
    const VoxelState state = steps == kUnknown ? VoxelState::unknown
                             : steps > 0       ? VoxelState::occupied
                                               : VoxelState::free;
    const auto log_odds = grid.log_odds(voxel);
    bool same = grid.state(voxel) == state && log_odds.has_value() == (steps != kUnknown);
    if (log_odds) same = same && *log_odds == static_cast<float>(0.05 * steps);

    const auto belief = grid.belief(voxel);
    const auto fused = fused_.find(position(voxel));
    same = same && belief.has_value() == (fused != fused_.end());
    if (belief && fused != fused_.end()) {
      const Eigen::Matrix3d information = belief->information_matrix().matrix();
      const auto& eta = belief->information_vector;
      const Eigen::Vector3d vector(eta[0], eta[1], eta[2]);
      same = same && belief->hits == fused->second.hits &&
             (information - fused->second.information).norm() <
                 1e-5 * fused->second.information.norm() &&
             (vector - fused->second.vector).norm() <
                 1e-5 * fused->second.information.norm() * voxel_size_;
    }
    if (!same) ++differences;
  });
  return differences;
}

DepthFrame mixed_frame(const Sensor& sensor, const Pose& pose, std::mt19937& random,
                       bool out_of_range) {
  DepthFrame frame = see_spheres(sensor, pose, three_spheres_in_a_room());
  std::uniform_int_distribution<std::size_t> dice(0, 39);
  for (float& depth : frame.depth) {
    const std::array instead{DepthFrame::kInvalid,
                             out_of_range ? DepthFrame::kOutOfRange : DepthFrame::kInvalid,
                             std::numeric_limits<float>::quiet_NaN(),
                             -depth,
                             0.01F,          // nearer than min_range
                             50.0F,          // farther than max_range
                             0.7F * depth};  // in free space
    if (const std::size_t kind = dice(random); kind < instead.size()) depth = instead[kind];
  }
  return frame;
}

}  // namespace viewgain::test
