// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "registration/registration_view.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// A view among others, with its pose.
struct JointFrame {
  RegistrationView seen;
  Pose T_reported;
  PoseSigma sigma;          ///< uncertainty of T_reported
  bool is_fixed = false;    ///< whether T_reported is fixed
  bool is_in = false;       ///< whether others rely on it
  bool is_trusted = false;  ///< and its pose is better known than reported
  Pose T{};                 ///< current estimate
  /// Covariance of the pose relative to the fixed ones: the prior's, or from the last alignment of
  /// all.
  Matrix6 covariance = Matrix6::Zero();
  double slack = 0;    ///< remaining uncertainty of T, in sigmas
  int iterations = 0;  ///< of the last alignment

  /// Sigmas of the six parts of a difference.
  [[nodiscard]] Vector6 sigmas() const;
  /// Resets it to the report.
  void reset();
};

/// Estimates the poses of frames from their overlap and their reports, see FrameAlignment. Does not
/// decide which frames to trust.
class JointAlignment {
 public:
  /// `length`: size of a voxel or footprint [m]. Keeps a reference to the pool.
  JointAlignment(double length, ThreadPool& pool);

  std::vector<JointFrame> frames;
  /// Apparent widening of rims, because pixels beside a rim can show its surface. In lateral sigmas
  /// for each of the 25 pixels around a reading that lies past a rim; align_all() estimates it.
  double rim_width = kUsualRimWidth;

  /// Moves one frame relative to the trusted ones, or to all that are in, from its current pose.
  void align_one(std::size_t index, bool against_all);
  /// Moves a frame to the pose, from starting points around the report, where a few of its readings
  /// fit the trusted ones best.
  void search_one(std::size_t index);
  /// Moves all frames that are in and not fixed.
  void align_all();

  /// Pairs of one frame's readings, at its pose or another one, with another frame.
  [[nodiscard]] PairSums sums(const JointFrame& source, const JointFrame& target, int level,
                              std::vector<std::uint8_t>* is_paired = nullptr) const {
    return sums(source, source.T, target, level, is_paired);
  }
  [[nodiscard]] PairSums sums(const JointFrame& source, const Pose& T_source,
                              const JointFrame& target, int level,
                              std::vector<std::uint8_t>* is_paired = nullptr) const;
  /// `agreed` of all pairs of a frame with others, as if each reading were in one of them.
  [[nodiscard]] Matrix6 of_single_pairs(const Matrix6& agreed) const;
  /// Whether the first view is a map's.
  [[nodiscard]] bool is_by_map() const { return frames.front().seen.grid != nullptr; }

 private:
  // Between the values of simulated views, 0 to 0.055.
  static constexpr double kUsualRimWidth = 0.03;

  // Selection of readings for one iteration.
  struct Pass {
    std::vector<std::size_t> movable;
    int level;     // uses a finer level if too few readings remain
    double still;  // a shorter step ends it, in sigmas of the current knowledge of a pose
    bool trusted_only = false;
    bool with_rims = false;  // whether the rims' width is estimated too
  };
  struct System;
  [[nodiscard]] System system(const Pass& pass) const;
  bool move(const Pass& pass);
  void align(const Pass& pass);
  void begin_one(const Pass& pass);
  [[nodiscard]] double least_widening() const;
  [[nodiscard]] double estimated_scale(Pass pass) const;
  [[nodiscard]] std::size_t pairs_of(std::size_t index) const;
  [[nodiscard]] int level_of(const Pass& pass) const;

  double length_;
  ThreadPool& pool_;
  double widening_ = 1;          // factor for variances from readings, from align_all()
  double scale_ = 1;             // factor for the priors' variances
  Eigen::MatrixXd information_;  // from the last move: of frames and rims, in the priors' sigmas
};

}  // namespace viewgain::detail
