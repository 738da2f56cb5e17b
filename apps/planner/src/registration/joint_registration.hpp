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

/// Aligns frames one after the other and says which are to be believed, see FrameAlignment.
class JointRegistration {
 public:
  /// `length`: of a voxel or footprint [m]; `others`: what frames are held against, for people.
  /// Keeps the pool by reference.
  JointRegistration(double length, std::string others, ThreadPool& pool)
      : length_(length), others_(std::move(others)), pool_(pool), joint_(length, pool) {}

  /// One that others go by and that stays where it is.
  void add_fixed(RegistrationView seen, const Pose& T_world_view);
  /// Aligns it, then all others that are not registered or not trusted, as long as one more frame
  /// shows what they waited for.
  void add(RegistrationView seen, const Pose& T_reported, const PoseSigma& sigma);

  /// Of all views, in their order.
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
  std::vector<double> shown_;  // shown_of() each, when it was tried last
};

}  // namespace viewgain::detail
