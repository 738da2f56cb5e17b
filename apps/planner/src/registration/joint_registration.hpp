// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "registration/joint_alignment.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/planner/register_frame.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// Aligns frames one after the other and decides which to trust, see FrameAlignment.
class JointRegistration {
 public:
  /// `length`: size of a voxel or footprint [m]; `others`: name of the other frames in messages.
  /// Keeps a reference to the pool.
  JointRegistration(double length, std::string others, ThreadPool& pool)
      : length_(length), others_(std::move(others)), pool_(pool), joint_(length, pool) {}

  /// Adds a trusted, fixed view.
  void add_fixed(RegistrationView seen, const Pose& T_world_view);
  /// Aligns a frame, then all others that are not registered or not trusted, until no more of them
  /// can be.
  void add(RegistrationView seen, const Pose& T_reported, const PoseSigma& sigma);

  /// Results of all views, in order.
  [[nodiscard]] const std::vector<FrameRegistration>& results() const noexcept { return results_; }

 private:
  struct Verdict;
  struct Agreements;
  [[nodiscard]] Agreements agreements_of(std::size_t index,
                                         const std::vector<std::uint8_t>& is_paired,
                                         double sigmas) const;
  [[nodiscard]] Verdict verdict_of(std::size_t index) const;
  [[nodiscard]] PairSums sums_with_others(std::size_t index, const Pose& T,
                                          std::vector<std::uint8_t>* by_trusted = nullptr,
                                          std::vector<std::uint8_t>* by_others = nullptr) const;
  [[nodiscard]] double shown_of(std::size_t index);
  void align_one(std::size_t index);
  bool register_frame(std::size_t index);
  bool judge_all();

  double length_;  // [m]
  std::string others_;
  ThreadPool& pool_;
  JointAlignment joint_;
  std::vector<FrameRegistration> results_;
  std::vector<double> shown_;  // shown_of() of each at its last attempt
};

}  // namespace viewgain::detail
