// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "voxel_truth.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "methods/octomap_tree.hpp"

namespace viewgain::bench {
namespace {

constexpr int kFitStep = 8;  // of the pixels that the lens is fitted on
// DefaultConfiguration.yaml, in the places where the code looks for k1 k2 p1 p2 k3.
constexpr std::array<double, 5> kPeerLens{0.12042199820280075, -0.21373499929904938,
                                          0.005386000033468008, -0.0021210000850260258, 0.0};

/// (x, y) moved by the lens polynomial of k1 k2 p1 p2 k3.
Eigen::Vector2d through_lens(const std::array<double, 5>& k, const Eigen::Vector2d& p) {
  const double x = p.x(), y = p.y(), r2 = p.squaredNorm();
  const double radial = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  return {x * radial + 2 * k[2] * x * y + k[3] * (r2 + 2 * x * x),
          y * radial + k[2] * (r2 + 2 * y * y) + 2 * k[3] * x * y};
}

PinholeCamera camera_without_lens() {
  PinholeCamera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = 610.40447998046875;
  camera.fy = 608.88446044921875;
  camera.cx = 324.7635498046875;
  camera.cy = 248.34353637695312;
  return camera;
}

/// The polynomial is linear in its numbers.
std::array<double, 5> inverse_lens(const PinholeCamera& camera) {
  std::vector<Eigen::Vector2d> pixels;
  for (int v = 0; v < camera.height; v += kFitStep) {
    for (int u = 0; u < camera.width; u += kFitStep) {
      pixels.push_back(camera.ray(u, v).head<2>());
    }
  }
  Eigen::MatrixXd A(2 * pixels.size(), 5);
  Eigen::VectorXd b(2 * pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Eigen::Vector2d ray = through_lens(kPeerLens, pixels[i]);
    const auto row = static_cast<Eigen::Index>(2 * i);
    for (std::size_t k = 0; k < 5; ++k) {
      std::array<double, 5> one{};
      one[k] = 1;
      A.block<2, 1>(row, static_cast<Eigen::Index>(k)) = through_lens(one, ray) - ray;
    }
    b.segment<2>(row) = pixels[i] - ray;
  }
  const Eigen::VectorXd x = A.colPivHouseholderQr().solve(b);
  return {x[0], x[1], x[2], x[3], x[4]};
}

/// Does the half line meet the box?
bool meets(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const Eigen::Vector3d& from,
           const Eigen::Vector3d& direction) {
  double begin = 0;
  double end = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    if (direction[k] == 0) {
      if (from[k] < low[k] || from[k] > high[k]) return false;
      continue;
    }
    const double a = (low[k] - from[k]) / direction[k];
    const double b = (high[k] - from[k]) / direction[k];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return begin <= end;
}

Eigen::Vector3d double_precision(const octomap::point3d& p) {
  return Eigen::Vector3f(p.x(), p.y(), p.z()).cast<double>();
}

}  // namespace

Sensor peer_sensor(double working_distance, double max_range) {
  Sensor sensor;
  sensor.name = "peer";
  sensor.camera = camera_without_lens();
  sensor.camera.distortion = inverse_lens(sensor.camera);
  sensor.min_range = 0.01;
  sensor.max_range = max_range;
  sensor.working_distance = working_distance;
  const double sigma = kTruthVoxel / std::sqrt(12.0);
  sensor.noise = ConstantNoise{.sigma_axial = sigma, .sigma_lateral = sigma};
  sensor.validate();
  return sensor;
}

double peer_lens_error(const Sensor& sensor) {
  const PinholeCamera plain = camera_without_lens();
  double largest = 0;
  for (int v = 0; v < plain.height; ++v) {
    for (int u = 0; u < plain.width; ++u) {
      const Eigen::Vector2d ray = through_lens(kPeerLens, plain.ray(u, v).head<2>());
      const Eigen::Vector2d seen_at = sensor.camera.project({ray.x(), ray.y(), 1.0});
      largest = std::max(largest, (seen_at - Eigen::Vector2d(u, v)).norm());
    }
  }
  return largest;
}

VoxelTruth::VoxelTruth(const std::vector<Eigen::Vector3d>& points, const Sensor& sensor)
    : sensor_(sensor),
      directions_(sensor.camera.ray_table()),
      tree_(kTruthVoxel),
      low_(Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity())),
      high_(-low_) {
  for (const Eigen::Vector3d& p : points) {
    tree_.setNodeValue(octomap_point(p), tree_.getProbHitLog(), true);
    low_ = low_.cwiseMin(p);
    high_ = high_.cwiseMax(p);
  }
  tree_.updateInnerOccupancy();
  low_ -= Eigen::Vector3d::Constant(2 * kTruthVoxel);
  high_ += Eigen::Vector3d::Constant(2 * kTruthVoxel);
}

octomap::OcTreeKey VoxelTruth::voxel_of(const Eigen::Vector3d& p_world) const {
  return tree_.coordToKey(octomap_point(p_world));
}

VoxelFrame VoxelTruth::acquire(const Pose& T_world_camera, ThreadPool& pool) const {
  const Eigen::Matrix3d R = T_world_camera.rotation();
  const Eigen::Vector3d eye = T_world_camera.translation();
  const octomap::point3d origin = tree_.keyToCoord(voxel_of(eye));
  const Eigen::Vector3d from = double_precision(origin);
  VoxelFrame frame;
  frame.depth.width = sensor_.camera.width;
  frame.depth.height = sensor_.camera.height;
  frame.depth.depth.assign(directions_.size(), DepthFrame::kInvalid);
  std::vector<octomap::OcTreeKey> ends(directions_.size());
  pool.for_each_chunk(directions_.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d direction = eye + R * directions_[i] - from;
      if (!meets(low_, high_, from, direction)) continue;
      octomap::point3d hit;
      if (!tree_.castRay(origin, octomap_point(direction), hit, true, sensor_.max_range)) {
        continue;
      }
      const double depth = R.col(2).dot(double_precision(hit) - eye);
      if (!(depth > 0)) continue;
      frame.depth.depth[i] = static_cast<float>(depth);
      ends[i] = tree_.coordToKey(hit);
    }
  });
  octomap::KeySet seen;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (frame.depth.depth[i] == DepthFrame::kInvalid || !seen.insert(ends[i]).second) continue;
    frame.voxels.push_back(ends[i]);
  }
  return frame;
}

}  // namespace viewgain::bench
