// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/align_frames.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>

#include "registration/joint_alignment.hpp"
#include "registration/pose_motion.hpp"
#include "registration/registration_readings.hpp"
#include "viewgain/core/noise.hpp"
#include "viewgain/core/thread_pool.hpp"

namespace viewgain {
namespace {

using detail::Agreement;
using detail::AlignedView;
using detail::JointAlignment;
using detail::JointFrame;
using detail::PairGates;
using detail::PairSums;
using detail::Reading;
using detail::Vector6;

// Back to what was reported of it.
void reset(JointFrame& frame) {
  frame.T = frame.T_reported;
  frame.covariance = frame.sigmas.cwiseAbs2().asDiagonal();
}

// Lengths in voxels, or footprints where those are longer.
constexpr double kNormalRadius = 4;
constexpr double kMargin = 2;
// Neighbouring readings share most of their surroundings: more say hardly more, and take longer.
constexpr std::size_t kEnoughReadings = 6'000;
// A frame that the others do not hold may be so many sigmas off without contradicting them. More
// would let frames pass for new surface that lie beside the object.
constexpr double kReach = 1;

// How far the readings of a frame may be off, as others see it.
struct Slack {
  PairGates pose;
  double length;  // [m]

  [[nodiscard]] bool is_past(const AlignedView& view, const Eigen::Vector3d& point,
                             const Reading& reading) const {
    const double reach = std::sqrt(pose.slack_variance(reading.point.norm()));
    const double margin = 4 * reading.sigmas.axial + kMargin * length;
    return view.looks_past(point, margin + reach, reach);
  }
};

// What frame and others say of one another's readings.
struct Agreements {
  Agreement readings, surface;
};

// What became of a frame, and whether those that are trusted hold it.
struct Verdict {
  FrameRegistration result;
  bool is_held;
  [[nodiscard]] bool is_trusted() const {
    return is_held && result.status == RegistrationStatus::registered;
  }
};

}  // namespace

struct FrameAlignment::Impl {
  Sensor sensor;
  BeliefGrid layout;
  RegistrationConfig config;
  double length;  // [m]
  std::vector<Eigen::Vector3d> rays;
  ThreadPool pool;
  JointAlignment joint;
  std::vector<FrameRegistration> results;

  Impl(const Sensor& s, const BeliefGrid& grid, const RegistrationConfig& c, const ExecConfig& exec)
      : sensor(s),
        layout({grid.voxel_size(), grid.workspace(), grid.T_world_grid(), grid.prior_sigma()}),
        config(c),
        length(std::max(grid.voxel_size(), s.sigmas(s.working_distance).lateral)),
        rays(s.camera.ray_table()),
        pool(exec.num_threads),
        joint(length, c.max_normal_angle, pool) {}

  [[nodiscard]] std::vector<Reading> readings_of(const DepthFrame& frame, const Pose& T);
  [[nodiscard]] bool is_on_plane(const Eigen::Vector3d& point, const Eigen::Vector3d& sight) const {
    const double range = sight.norm();
    return config.support_plane &&
           is_of_plane(point.z() - *config.support_plane, sight.z() / range, sensor.sigmas(range));
  }
  [[nodiscard]] Agreements agreements_of(std::size_t index,
                                         const std::vector<std::uint8_t>& is_paired,
                                         double sigmas) const;
  [[nodiscard]] Verdict verdict_of(std::size_t index) const;
  [[nodiscard]] PairSums sums_with_others(std::size_t index, const Pose& T,
                                          std::vector<std::uint8_t>* by_trusted = nullptr,
                                          std::vector<std::uint8_t>* by_others = nullptr) const;
  void align_one(std::size_t index);
  bool register_frame(std::size_t index);
  void settle();
};

std::vector<Reading> FrameAlignment::Impl::readings_of(const DepthFrame& frame,
                                                       const Pose& T_world_camera) {
  // What does not count is not to thin out the rest.
  DepthFrame inside = frame;
  for (std::size_t i = 0; i < inside.depth.size(); ++i) {
    const double z = static_cast<double>(inside.depth[i]);
    if (!(z > 0) || !std::isfinite(z) || !rays[i].allFinite()) continue;
    const Eigen::Vector3d sight = T_world_camera.rotation() * (z * rays[i]);
    const Eigen::Vector3d point = sight + T_world_camera.translation();
    if (!layout.index_of(point) || is_on_plane(point, sight)) {
      inside.depth[i] = DepthFrame::kInvalid;
    }
  }
  return detail::readings_of(inside, sensor, rays, kNormalRadius * length, true,
                             std::min(config.max_readings, kEnoughReadings), pool);
}

// With the frames that are trusted, if the frame's pose may be off by so many sigmas.
Agreements FrameAlignment::Impl::agreements_of(std::size_t index,
                                               const std::vector<std::uint8_t>& is_paired,
                                               double sigmas) const {
  const JointFrame& frame = joint.frames[index];
  const std::vector<Reading>& readings = frame.seen.readings();
  const Slack slack{{sigmas * frame.sigmas[0], sigmas * frame.sigmas[3]}, length};
  Agreements found;
  std::vector<std::uint8_t> is_known = is_paired;
  found.readings.with =
      static_cast<std::size_t>(std::count(is_paired.begin(), is_paired.end(), std::uint8_t{1}));
  for (std::size_t j = 0; j < joint.frames.size(); ++j) {
    const JointFrame& other = joint.frames[j];
    if (j == index || !other.is_trusted) continue;
    const Pose T_other_frame = other.T.inverse() * frame.T;
    const Pose T_frame_other = T_other_frame.inverse();
    for (std::size_t i = 0; i < readings.size(); ++i) {
      if (is_known[i] != 0) continue;
      if (!slack.is_past(other.seen, T_other_frame * readings[i].point, readings[i])) continue;
      is_known[i] = 1;
      ++found.readings.against;
    }
    const std::vector<Reading>& surface = other.seen.readings();
    std::vector<std::uint8_t> is_shown(surface.size(), 0);
    const PairGates gates = joint.gates_of(other);
    found.surface.with += detail::pair_sums(other.seen, other.T, gates, frame.seen, frame.T, gates,
                                            joint.rim_width, detail::kLevels - 1, &is_shown)
                              .pairs;
    for (std::size_t i = 0; i < surface.size(); ++i) {
      if (is_shown[i] != 0) continue;
      if (slack.is_past(frame.seen, T_frame_other * surface[i].point, surface[i])) {
        ++found.surface.against;
      }
    }
  }
  return found;
}

// Of the frame at a pose; marks its readings that are in pairs with frames that are trusted, and
// with others.
PairSums FrameAlignment::Impl::sums_with_others(std::size_t index, const Pose& T,
                                                std::vector<std::uint8_t>* by_trusted,
                                                std::vector<std::uint8_t>* by_others) const {
  PairSums sums;
  for (std::size_t j = 0; j < joint.frames.size(); ++j) {
    const JointFrame& other = joint.frames[j];
    if (j == index || !other.is_in) continue;
    const PairGates gates = joint.gates_of(other);
    sums += detail::pair_sums(joint.frames[index].seen, T, gates, other.seen, other.T, gates,
                              joint.rim_width, detail::kLevels - 1,
                              other.is_trusted ? by_trusted : by_others);
  }
  return sums;
}

Verdict FrameAlignment::Impl::verdict_of(std::size_t index) const {
  const JointFrame& frame = joint.frames[index];
  const std::size_t readings = frame.seen.readings().size();
  FrameRegistration result;
  result.T_world_camera = frame.T;
  result.readings = readings;
  result.iterations = frame.iterations;
  std::vector<std::uint8_t> is_paired(readings, 0), by_trusted(readings, 0);
  const PairSums after = sums_with_others(index, frame.T, &by_trusted, &is_paired);
  const auto count = [](const std::vector<std::uint8_t>& marks) {
    return static_cast<std::size_t>(std::count(marks.begin(), marks.end(), std::uint8_t{1}));
  };
  const double all = static_cast<double>(std::max<std::size_t>(readings, 1));
  const bool is_held = static_cast<double>(count(by_trusted)) / all >= config.min_overlap;
  for (std::size_t i = 0; i < readings; ++i) is_paired[i] |= by_trusted[i];
  result.residual_after = after.residual();
  const detail::Directions directions =
      detail::directions_of(JointAlignment::of_single_pairs(after.agreed), frame.sigmas);
  result.smallest_information = directions.information[0];
  result.pairs = count(is_paired);
  result.overlap = static_cast<double>(result.pairs) / all;
  const Vector6 correction = detail::difference(frame.T, frame.T_reported);
  result.translation = correction.head<3>().norm();
  result.rotation = correction.tail<3>().norm();
  for (int k = 0; k < 6; ++k) {
    if (directions.information[k] >= 1) continue;
    const Vector6 motion = frame.sigmas.cwiseProduct(directions.axes.col(k));
    result.free_directions.push_back({motion.head<3>(), motion.tail<3>()});
  }
  Agreements found = agreements_of(index, is_paired, is_held ? 0 : kReach);
  if (!is_held) {
    // What nothing contradicts may be new surface.
    found.readings.with = readings - found.readings.against;
    found.surface.with = std::max(found.surface.with, readings);
  }
  detail::judge(result, found.readings, found.surface, config, frame.sigmas, "another frame");
  if (index == 0) result.status = RegistrationStatus::registered, result.reason.clear();
  if (index > 0) {
    const detail::Matrix6 of_prior = frame.sigmas.cwiseAbs2().asDiagonal();
    const bool is_found = result.status == RegistrationStatus::registered;
    result.covariance = detail::by_rows(is_found ? frame.covariance : of_prior);
  }
  return {result, is_held || index == 0};
}

// Against those that are trusted; where these show too little of it, against all.
void FrameAlignment::Impl::align_one(std::size_t index) {
  JointFrame& frame = joint.frames[index];
  FrameRegistration& result = results[index];
  reset(frame);
  joint.align_one(index, false);
  result = verdict_of(index).result;
  if (result.status == RegistrationStatus::registered) return;
  if (result.status == RegistrationStatus::refused) {
    joint.search_one(index);
    joint.align_one(index, false);
  } else {
    reset(frame);
    joint.align_one(index, true);
  }
  result = verdict_of(index).result;
}

// Of one that is not registered: true if it is now.
bool FrameAlignment::Impl::register_frame(std::size_t index) {
  JointFrame& frame = joint.frames[index];
  FrameRegistration& result = results[index];
  align_one(index);
  if (result.status == RegistrationStatus::registered) {
    std::vector<std::pair<Pose, detail::Matrix6>> before;
    for (const JointFrame& one : joint.frames) before.emplace_back(one.T, one.covariance);
    const double rim_width = joint.rim_width;
    frame.is_in = true;
    joint.align_all();
    const Verdict verdict = verdict_of(index);
    result = verdict.result;
    frame.is_trusted = verdict.is_trusted();
    if (result.status == RegistrationStatus::registered) return true;
    for (std::size_t i = 0; i < before.size(); ++i) {
      std::tie(joint.frames[i].T, joint.frames[i].covariance) = before[i];
    }
    joint.rim_width = rim_width;
  }
  reset(frame);
  if (result.status == RegistrationStatus::too_little_overlap) result = verdict_of(index).result;
  frame.is_in = result.status == RegistrationStatus::too_little_overlap;
  result.T_world_camera = frame.T;
  return false;
}

// The newest frame, then all others that are not registered or not trusted, as long as one more
// frame shows what they waited for.
void FrameAlignment::Impl::settle() {
  const std::size_t n = joint.frames.size();
  bool is_more_known = register_frame(n - 1);
  while (is_more_known) {
    is_more_known = false;
    for (std::size_t i = 1; i < n; ++i) {
      JointFrame& frame = joint.frames[i];
      if (results[i].status != RegistrationStatus::registered) {
        is_more_known |= register_frame(i);
      } else if (!frame.is_trusted) {
        frame.is_trusted = verdict_of(i).is_trusted();
        is_more_known |= frame.is_trusted;
      }
    }
  }
  std::vector<Verdict> verdicts(n);
  pool.for_each_chunk(n, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (joint.frames[i].is_in) verdicts[i] = verdict_of(i);
      (joint.frames[i].is_in ? verdicts[i].result : results[i]).residual_before =
          sums_with_others(i, joint.frames[i].T_reported).residual();
    }
  });
  for (std::size_t i = 0; i < n; ++i) {
    JointFrame& frame = joint.frames[i];
    if (!frame.is_in) continue;
    frame.is_trusted = verdicts[i].is_trusted();
    results[i] = std::move(verdicts[i].result);
    if (results[i].status != RegistrationStatus::refused) continue;
    frame.is_in = false;
    reset(frame);
    results[i].T_world_camera = frame.T;
  }
}

FrameAlignment::FrameAlignment(const Sensor& sensor, const BeliefGrid& layout,
                               const RegistrationConfig& config, const ExecConfig& exec) {
  sensor.validate();
  detail::check(config);
  impl_ = std::make_unique<Impl>(sensor, layout, config, exec);
}
FrameAlignment::~FrameAlignment() = default;
FrameAlignment::FrameAlignment(FrameAlignment&&) noexcept = default;
FrameAlignment& FrameAlignment::operator=(FrameAlignment&&) noexcept = default;

const FrameRegistration& FrameAlignment::add(const DepthFrame& frame, const PosePrior& prior) {
  check_frame_size(frame, impl_->sensor.camera);
  detail::check(prior);
  const Pose T = orthonormalized(prior.T_world_camera);
  std::vector<JointFrame>& frames = impl_->joint.frames;
  frames.push_back({AlignedView(frame, impl_->sensor.camera, impl_->readings_of(frame, T)), T,
                    detail::sigmas_of(prior), T});
  reset(frames.back());
  impl_->results.emplace_back();
  if (frames.size() == 1) {
    frames[0].is_in = frames[0].is_trusted = true;
    impl_->results[0] = impl_->verdict_of(0).result;
  } else {
    impl_->settle();
  }
  return impl_->results.back();
}

const std::vector<FrameRegistration>& FrameAlignment::registrations() const {
  return impl_->results;
}

}  // namespace viewgain
