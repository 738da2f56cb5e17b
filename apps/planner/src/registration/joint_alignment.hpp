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

/// A view among others, and where it is.
struct JointFrame {
  RegistrationView seen;
  Pose T_reported;
  PoseSigma sigma;          ///< by which T_reported may be off
  bool is_fixed = false;    ///< does T_reported hold?
  bool is_in = false;       ///< do others go by it?
  bool is_trusted = false;  ///< and is its pose better known than it was reported?
  Pose T{};                 ///< as known now
  /// Of the pose relative to the fixed ones: the prior's, or as the last alignment of all found it.
  Matrix6 covariance = Matrix6::Zero();
  double slack = 0;    ///< by which T may still be off, in sigmas
  int iterations = 0;  ///< of the last alignment

  /// Of the six parts of a difference.
  [[nodiscard]] Vector6 sigmas() const;
  /// Back to what was reported of it.
  void reset();
};

/// The poses of frames by what they show of one another and by what was reported, see
/// FrameAlignment. Says nothing of which frames are to be believed.
class JointAlignment {
 public:
  /// `length`: of a voxel or footprint [m]. Keeps the pool by reference.
  JointAlignment(double length, ThreadPool& pool);

  std::vector<JointFrame> frames;
  /// By how much rims seem wider than they are: what a pixel shows comes from beside its ray, too,
  /// so that pixels outside of a rim may show the surface. In lateral sigmas for each
  /// of the 25 pixels round a reading that lies past a rim; align_all() finds it.
  double rim_width = kUsualRimWidth;

  /// Moves one frame against those that are trusted, or all that are in, from where it is.
  void align_one(std::size_t index, bool against_all);
  /// Puts a frame where, beginning at poses round the reported one, few of its readings fit those
  /// that are trusted best.
  void search_one(std::size_t index);
  /// Moves all that are in and not fixed.
  void align_all();

  /// Of the readings of one frame, where it is or at another pose, that fall on another.
  [[nodiscard]] PairSums sums(const JointFrame& source, const JointFrame& target, int level,
                              std::vector<std::uint8_t>* is_paired = nullptr) const {
    return sums(source, source.T, target, level, is_paired);
  }
  [[nodiscard]] PairSums sums(const JointFrame& source, const Pose& T_source,
                              const JointFrame& target, int level,
                              std::vector<std::uint8_t>* is_paired = nullptr) const;
  /// What `agreed` of all pairs of a frame with others is, were each reading in one of them.
  [[nodiscard]] Matrix6 of_single_pairs(const Matrix6& agreed) const;
  /// Is the first view a map's?
  [[nodiscard]] bool is_by_map() const { return frames.front().seen.grid != nullptr; }

 private:
  static constexpr double kUsualRimWidth = 0.03;  // between what simulated views want, 0 to 0.055

  // What one iteration looks at.
  struct Pass {
    std::vector<std::size_t> movable;
    int level;     // a finer one where it leaves too few readings
    double still;  // a step this short ends it, in sigmas of what a pose is known to
    bool trusted_only = false;
    bool with_rims = false;  // is the rims' width to be found as well?
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
  double widening_ = 1;          // of the variances that readings give, as align_all() found it
  double scale_ = 1;             // of the priors' variances
  Eigen::MatrixXd information_;  // of the last move: of frames and rims, in the priors' sigmas
};

}  // namespace viewgain::detail
