// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "registration/registration_readings.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/thread_pool.hpp"
#include "viewgain/grid/fused_points.hpp"

namespace viewgain::detail {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// A fused point as registration needs it, world frame.
struct ModelPoint {
  Eigen::Vector3d point;       ///< [m]
  Eigen::Vector3d normal;      ///< unit, toward free space
  double variance = 0;         ///< along the normal [m²]
  std::uint32_t neighbours{};  ///< number of the cube that it lies in
};

struct RegistrationModel {
  std::vector<ModelPoint> points;
  std::size_t cubes = 0;  ///< of the given edge that hold a point
};

[[nodiscard]] RegistrationModel registration_model(std::span<const FusedPoint> points, double edge);

/// How many sigmas apart the two of a pair may be, and from where on they count less: 95 %
/// efficient for Gaussian errors.
inline constexpr double kGateSigmas = 4;
inline constexpr double kCauchy = 2.385;

/// Which reading may belong to which point.
struct PairGates {
  double slack_translation = 0;  ///< by which the pose may still be off, 1 sigma [m]
  double slack_rotation = 0;     ///< [rad]
  double along_surface = 0;      ///< largest distance along the surface [m]
  double min_cosine = 0;         ///< of the angle between the normals

  /// What a pose so far off does to a reading at this range [m²].
  [[nodiscard]] double slack_variance(double range) const {
    const double turned = slack_rotation * range;
    return slack_translation * slack_translation + turned * turned;
  }
};

/// What the pairs say at a pose: of J w e, e = nᵀ(T s - m), J its derivative by the translation of
/// the camera's centre and the rotation about it, world axes.
struct PairSums {
  Matrix6 information = Matrix6::Zero();  ///< Σ w J Jᵀ
  Matrix6 agreed = Matrix6::Zero();       ///< that map's and frame's normals agree on
  Vector6 gradient = Vector6::Zero();     ///< Σ w J e
  double squares = 0;                     ///< Σ e² [m²]
  std::size_t pairs = 0;

  PairSums& operator+=(const PairSums& other);
  /// RMS of e [m]; 0 without a pair.
  [[nodiscard]] double residual() const;
};

/// Pairs of readings with points of the map, and sums over them. Sums are of blocks of readings
/// that do not depend on the number of threads, added in their order.
class RegistrationPairs {
 public:
  /// `length`: the map's pooling length [m]; `range`: of a typical reading [m]. Keeps what it gets
  /// by reference.
  RegistrationPairs(const RegistrationModel& model, const std::vector<Reading>& readings,
                    const PinholeCamera& camera, double length, double range, ThreadPool& pool);

  /// Pairs anew the readings up to this level at a pose.
  void find(const Pose& T_world_camera, int level, const PairGates& gates);

  [[nodiscard]] PairSums sums(const Pose& T_world_camera) const;
  /// Of each cube of the model Σ w J e.
  [[nodiscard]] std::vector<Vector6> sums_by_cube(const Pose& T_world_camera) const;

  /// The number of the reading's point; -1 if it has none.
  [[nodiscard]] const std::vector<std::int32_t>& targets() const noexcept { return targets_; }
  /// Is there surface round the reading's pixel that is more than `margin` [m] before it?
  [[nodiscard]] bool is_behind_surface(const Reading& reading, double margin) const;

 private:
  struct Term {
    double error, weight;
    Vector6 derivative, frame_derivative;
  };
  [[nodiscard]] Term term(std::size_t reading, const Pose& T_world_camera) const;
  void draw(const Pose& T_world_camera);
  /// Calls visit(key) for the cells that are not empty among the nine round a reading's pixel.
  template <typename Visit>
  void for_each_cell_round(const Reading& reading, Visit&& visit) const;
  [[nodiscard]] std::int32_t nearest(const Reading& reading, const Pose& T_world_camera,
                                     const PairGates& gates) const;

  const RegistrationModel& model_;
  const std::vector<Reading>& readings_;
  const PinholeCamera& camera_;
  ThreadPool& pool_;
  int cell_;  // [px]
  int columns_, rows_;
  // A cell holds its nearest point: the depth's bits, then the number, so that the least is the
  // same in whatever order points are drawn.
  std::vector<std::atomic<std::uint64_t>> cells_;
  std::vector<std::int32_t> targets_;
  std::vector<std::uint32_t> shares_;  // readings of a point
  PairGates gates_;
};

}  // namespace viewgain::detail
