// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "registration/registration_pairs.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace viewgain::detail {
namespace {

constexpr std::size_t kBlock = 512;  // readings summed together
constexpr std::uint64_t kEmpty = std::numeric_limits<std::uint64_t>::max();
constexpr int kMaxCell = 32;  // [px]
// Columns of radius 1 round points 0.75 to 1 apart: each reading of the map is in about three.
constexpr double kPointsPerReading = 3;

std::array<std::int64_t, 3> cube_of(const Eigen::Vector3d& point, double edge) {
  std::array<std::int64_t, 3> cube{};
  for (int a = 0; a < 3; ++a) {
    cube[static_cast<std::size_t>(a)] = static_cast<std::int64_t>(std::floor(point[a] / edge));
  }
  return cube;
}

}  // namespace

PairSums& PairSums::operator+=(const PairSums& other) {
  information += other.information;
  agreed += other.agreed;
  gradient += other.gradient;
  squares += other.squares;
  pairs += other.pairs;
  return *this;
}

double PairSums::residual() const {
  return pairs > 0 ? std::sqrt(squares / static_cast<double>(pairs)) : 0.0;
}

RegistrationModel registration_model(std::span<const FusedPoint> points, double edge) {
  RegistrationModel model;
  model.points.reserve(points.size());
  std::vector<std::array<std::int64_t, 3>> cubes;
  cubes.reserve(points.size());
  for (const FusedPoint& fused : points) {
    ModelPoint point;
    point.point = Eigen::Vector3d(fused.position.data());
    point.normal = Eigen::Vector3d(fused.toward_free.data());
    point.variance = point.normal.dot(fused.covariance * point.normal);
    model.points.push_back(point);
    cubes.push_back(cube_of(point.point, edge));
  }
  std::vector<std::array<std::int64_t, 3>> sorted = cubes;
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  model.cubes = sorted.size();
  for (std::size_t i = 0; i < cubes.size(); ++i) {
    model.points[i].neighbours = static_cast<std::uint32_t>(
        std::lower_bound(sorted.begin(), sorted.end(), cubes[i]) - sorted.begin());
  }
  return model;
}

RegistrationPairs::RegistrationPairs(const RegistrationModel& model,
                                     const std::vector<Reading>& readings,
                                     const PinholeCamera& camera, double length, double range,
                                     ThreadPool& pool)
    : model_(model),
      readings_(readings),
      camera_(camera),
      pool_(pool),
      // About one point a cell.
      cell_(std::clamp(static_cast<int>(std::lround(length * camera.fx / range)), 1, kMaxCell)),
      columns_((camera.width + cell_ - 1) / cell_),
      rows_((camera.height + cell_ - 1) / cell_),
      cells_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)),
      targets_(readings.size(), -1),
      shares_(model.points.size()) {}

void RegistrationPairs::draw(const Pose& T_world_camera) {
  for (std::atomic<std::uint64_t>& cell : cells_) cell.store(kEmpty, std::memory_order_relaxed);
  const Eigen::Matrix3d R_camera_world = T_world_camera.rotation().transpose();
  const Eigen::Vector3d center = T_world_camera.translation();
  pool_.for_each_chunk(model_.points.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const ModelPoint& m = model_.points[i];
      const Eigen::Vector3d sight = m.point - center;
      if (!(m.normal.dot(sight) < 0)) continue;  // seen from inside
      const Eigen::Vector3d p_camera = R_camera_world * sight;
      if (!camera_.sees(p_camera)) continue;
      const Eigen::Vector2d pixel = camera_.project(p_camera);
      const int column = static_cast<int>(pixel.x() + 0.5) / cell_;
      const int row = static_cast<int>(pixel.y() + 0.5) / cell_;
      std::atomic<std::uint64_t>& cell =
          cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                 static_cast<std::size_t>(column)];
      const std::uint64_t bits = std::bit_cast<std::uint32_t>(static_cast<float>(p_camera.z()));
      const std::uint64_t key = bits << 32U | i;
      std::uint64_t nearest = cell.load(std::memory_order_relaxed);
      while (key < nearest &&
             !cell.compare_exchange_weak(nearest, key, std::memory_order_relaxed)) {
      }
    }
  });
}

template <typename Visit>
void RegistrationPairs::for_each_cell_round(const Reading& reading, Visit&& visit) const {
  const int column = reading.u / cell_, row = reading.v / cell_;
  for (int y = std::max(0, row - 1); y <= std::min(rows_ - 1, row + 1); ++y) {
    for (int x = std::max(0, column - 1); x <= std::min(columns_ - 1, column + 1); ++x) {
      const std::uint64_t key =
          cells_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
                 static_cast<std::size_t>(x)]
              .load(std::memory_order_relaxed);
      if (key == kEmpty) continue;
      visit(key);
    }
  }
}

std::int32_t RegistrationPairs::nearest(const Reading& reading, const Pose& T_world_camera,
                                        const PairGates& gates) const {
  const Eigen::Vector3d p_world = T_world_camera * reading.point;
  const Eigen::Vector3d sight = p_world - T_world_camera.translation();
  const Eigen::Vector3d normal = T_world_camera.rotation() * reading.normal;
  const double range = sight.norm();
  const double slack = gates.slack_variance(range);
  const double lateral = reading.sigmas.lateral * reading.sigmas.lateral;
  const double along_ray = reading.sigmas.axial * reading.sigmas.axial - lateral;
  const double along_surface = gates.along_surface * gates.along_surface + slack;
  double best = std::numeric_limits<double>::infinity();
  std::int32_t target = -1;
  for_each_cell_round(reading, [&](std::uint64_t key) {
    const auto i = static_cast<std::uint32_t>(key);
    const ModelPoint& m = model_.points[i];
    const Eigen::Vector3d d = p_world - m.point;
    const double square = d.squaredNorm();
    if (square >= best) return;
    const double e = m.normal.dot(d);
    const double cosine = m.normal.dot(sight) / range;
    const double variance = m.variance + lateral + along_ray * cosine * cosine;
    if (e * e > kGateSigmas * kGateSigmas * (variance + slack)) return;
    if (square - e * e > along_surface) return;
    if (m.normal.dot(normal) < gates.min_cosine) return;
    best = square;
    target = static_cast<std::int32_t>(i);
  });
  return target;
}

void RegistrationPairs::find(const Pose& T_world_camera, int level, const PairGates& gates) {
  draw(T_world_camera);
  gates_ = gates;
  pool_.for_each_chunk(readings_.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const bool takes_part = readings_[i].level <= level;
      targets_[i] = takes_part ? nearest(readings_[i], T_world_camera, gates) : -1;
    }
  });
  std::fill(shares_.begin(), shares_.end(), 0U);
  for (const std::int32_t target : targets_) {
    if (target >= 0) ++shares_[static_cast<std::size_t>(target)];
  }
}

RegistrationPairs::Term RegistrationPairs::term(std::size_t i, const Pose& T_world_camera) const {
  const Reading& reading = readings_[i];
  const auto target = static_cast<std::size_t>(targets_[i]);
  const ModelPoint& m = model_.points[target];
  const Eigen::Matrix3d R = T_world_camera.rotation();
  const Eigen::Vector3d sight = R * reading.point;  // from the camera's centre
  const Eigen::Vector3d frame_normal = R * reading.normal;
  const double range = sight.norm();
  const double lateral = reading.sigmas.lateral * reading.sigmas.lateral;
  const double along_ray = reading.sigmas.axial * reading.sigmas.axial - lateral;
  const double cosine = m.normal.dot(sight) / range;
  const double of_reading = lateral + along_ray * cosine * cosine;
  Term term;
  term.error = m.normal.dot(sight + T_world_camera.translation() - m.point);
  const double square =
      term.error * term.error / (m.variance + of_reading + gates_.slack_variance(range));
  const double robust = 1 / (1 + square / (kCauchy * kCauchy));
  term.weight = robust / (kPointsPerReading * shares_[target] * m.variance + of_reading);
  term.derivative << m.normal, sight.cross(m.normal);
  term.frame_derivative << frame_normal, sight.cross(frame_normal);
  return term;
}

PairSums RegistrationPairs::sums(const Pose& T_world_camera) const {
  std::vector<PairSums> blocks((readings_.size() + kBlock - 1) / kBlock);
  pool_.for_each_chunk(readings_.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    PairSums& sums = blocks[begin / kBlock];
    for (std::size_t i = begin; i < end; ++i) {
      if (targets_[i] < 0) continue;
      const Term t = term(i, T_world_camera);
      const Vector6 weighted = t.weight * t.derivative;
      sums.information += weighted * t.derivative.transpose();
      sums.agreed += weighted * t.frame_derivative.transpose();
      sums.gradient += t.error * weighted;
      sums.squares += t.error * t.error;
      ++sums.pairs;
    }
  });
  PairSums total;
  for (const PairSums& block : blocks) total += block;
  total.agreed = (0.5 * (total.agreed + total.agreed.transpose())).eval();
  return total;
}

std::vector<Vector6> RegistrationPairs::sums_by_cube(const Pose& T_world_camera) const {
  std::vector<Vector6> sums(model_.cubes, Vector6::Zero());
  for (std::size_t i = 0; i < readings_.size(); ++i) {
    if (targets_[i] < 0) continue;
    const Term t = term(i, T_world_camera);
    sums[model_.points[static_cast<std::size_t>(targets_[i])].neighbours] +=
        t.weight * t.error * t.derivative;
  }
  return sums;
}

bool RegistrationPairs::is_behind_surface(const Reading& reading, double margin) const {
  constexpr int kMostOfNine = 6;  // a rim's cells are not all its own
  int before = 0;
  for_each_cell_round(reading, [&](std::uint64_t key) {
    const auto depth =
        static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(key >> 32U)));
    if (depth < reading.point.z() - margin) ++before;
  });
  return before >= kMostOfNine;
}

}  // namespace viewgain::detail
