// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "registration/joint_registration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <tuple>

#include "registration/pose_motion.hpp"

namespace viewgain::detail {
namespace {

constexpr double kMinOverlap = 0.1;    // minimum of FrameRegistration::overlap
constexpr std::size_t kMinPairs = 60;  // minimum of FrameRegistration::pairs
constexpr double kMaxSigmas = 5;       // limit of the correction, relative to the prior
// Limit of the contradicting share, except with few readings.
constexpr double kMaxContradiction = 0.2;
constexpr double kMargin = 2;  // lengths
// A frame that the others do not determine may be off by this many sigmas without contradicting
// them. With more, frames beside the object would pass for new surface.
constexpr double kReach = 1;
// A refused frame is tried again when others show this many times more.
constexpr double kMore = 1.5;

std::string rounded(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

std::size_t count(const std::vector<std::uint8_t>& marks) {
  return static_cast<std::size_t>(std::count(marks.begin(), marks.end(), std::uint8_t{1}));
}

double residual_of(const PairSums& sums) {
  return sums.pairs > 0 ? std::sqrt(sums.squares / static_cast<double>(sums.pairs)) : 0.0;
}

// Readings: how many show surface of the other side, and how many contradict it.
struct Agreement {
  std::size_t with = 0;
  std::size_t against = 0;
  [[nodiscard]] double contradiction() const {
    const std::size_t all = with + against;
    return all == 0 ? 0 : static_cast<double>(against) / static_cast<double>(all);
  }
  // A few of them can all be wrong by chance.
  [[nodiscard]] bool contradicts(std::size_t readings) const {
    return contradiction() > kMaxContradiction && against > kMinPairs &&
           static_cast<double>(against) > kMinOverlap * static_cast<double>(readings);
  }
};

}  // namespace

// Agreement of the frame's and the others' readings.
struct JointRegistration::Agreements {
  Agreement readings, surface;
};

// Result for a frame, and whether the trusted frames determine it.
struct JointRegistration::Verdict {
  FrameRegistration result;
  bool is_held;
  [[nodiscard]] bool is_trusted() const {
    return is_held && result.status == RegistrationStatus::registered;
  }
};

// Agreement with the trusted frames if the frame's pose may be off by this many sigmas.
JointRegistration::Agreements JointRegistration::agreements_of(
    std::size_t index, const std::vector<std::uint8_t>& is_paired, double sigmas) const {
  const JointFrame& frame = joint_.frames[index];
  const std::vector<Reading>& readings = frame.seen.readings;
  const auto is_past = [&](const RegistrationView& view, const Eigen::Vector3d& point,
                           const Reading& reading) {
    const double reach =
        sigmas * std::hypot(frame.sigma.translation, frame.sigma.rotation * reading.point.norm());
    return view.looks_past(point, 4 * reading.axial + kMargin * length_ + reach, reach);
  };
  Agreements found;
  std::vector<std::uint8_t> is_known = is_paired;
  found.readings.with = count(is_paired);
  for (std::size_t j = 0; j < joint_.frames.size(); ++j) {
    const JointFrame& other = joint_.frames[j];
    if (j == index || !other.is_trusted) continue;
    const Pose T_other_frame = other.T.inverse() * frame.T;
    const Pose T_frame_other = T_other_frame.inverse();
    for (std::size_t i = 0; i < readings.size(); ++i) {
      if (is_known[i] != 0) continue;
      if (!is_past(other.seen, T_other_frame * readings[i].point, readings[i])) continue;
      is_known[i] = 1;
      ++found.readings.against;
    }
    const std::vector<Reading>& surface = other.seen.readings;
    std::vector<std::uint8_t> is_shown(surface.size(), 0);
    found.surface.with += joint_.sums(other, frame, kLevels - 1, &is_shown).pairs;
    for (std::size_t i = 0; i < surface.size(); ++i) {
      if (is_shown[i] != 0) continue;
      if (is_past(frame.seen, T_frame_other * surface[i].point, surface[i])) {
        ++found.surface.against;
      }
    }
  }
  return found;
}

// Readings of the frame at a pose; marks those in pairs with trusted frames, and with others.
PairSums JointRegistration::sums_with_others(std::size_t index, const Pose& T,
                                             std::vector<std::uint8_t>* by_trusted,
                                             std::vector<std::uint8_t>* by_others) const {
  PairSums all;
  for (std::size_t j = 0; j < joint_.frames.size(); ++j) {
    const JointFrame& other = joint_.frames[j];
    if (j == index || !other.is_in) continue;
    const PairSums sums = joint_.sums(joint_.frames[index], T, other, kLevels - 1,
                                      other.is_trusted ? by_trusted : by_others);
    all.agreed += sums.agreed;
    all.squares += sums.squares;
    all.pairs += sums.pairs;
  }
  return all;
}

JointRegistration::Verdict JointRegistration::verdict_of(std::size_t index) const {
  const JointFrame& frame = joint_.frames[index];
  const std::size_t readings = frame.seen.readings.size();
  const Vector6 sigmas = frame.sigmas();
  FrameRegistration result;
  result.readings = readings;
  result.iterations = frame.iterations;
  std::vector<std::uint8_t> is_paired(readings, 0), by_trusted(readings, 0);
  const PairSums after = sums_with_others(index, frame.T, &by_trusted, &is_paired);
  const double all = static_cast<double>(std::max<std::size_t>(readings, 1));
  const bool is_held =
      frame.is_fixed || static_cast<double>(count(by_trusted)) / all >= kMinOverlap;
  for (std::size_t i = 0; i < readings; ++i) is_paired[i] |= by_trusted[i];
  result.residual_after = residual_of(after);
  result.pairs = count(is_paired);
  result.overlap = static_cast<double>(result.pairs) / all;
  const Directions directions = directions_of(joint_.of_single_pairs(after.agreed), sigmas);
  result.smallest_information = directions.information[0];
  for (int k = 0; k < 6; ++k) {
    if (directions.information[k] >= 1) continue;
    const Vector6 motion = sigmas.cwiseProduct(directions.axes.col(k));
    result.free_directions.push_back({motion.head<3>(), motion.tail<3>()});
  }
  const Vector6 correction = difference(frame.T, frame.T_reported);
  result.translation = correction.head<3>().norm();
  result.rotation = correction.tail<3>().norm();
  // Without a contradiction it may be new surface; but a map knows the free space all around.
  const bool by_map = joint_.is_by_map();
  const bool may_be_new = !is_held && !by_map;
  Agreements found = agreements_of(index, is_paired, may_be_new ? kReach : 0);
  if (may_be_new) {
    found.readings.with = readings - found.readings.against;
    found.surface.with = std::max(found.surface.with, readings);
  }
  result.contradiction = std::max(found.readings.contradiction(), found.surface.contradiction());

  result.status = RegistrationStatus::refused;
  if (frame.is_fixed) {
    result.status = RegistrationStatus::registered;
  } else if (result.translation > kMaxSigmas * frame.sigma.translation ||
             result.rotation > kMaxSigmas * frame.sigma.rotation) {
    result.reason = "the correction, " + rounded(1e3 * result.translation) + " mm and " +
                    rounded(result.rotation * 180 / std::numbers::pi) + " deg, exceeds " +
                    rounded(kMaxSigmas) + " standard deviations of the reported pose";
  } else if (found.readings.contradicts(readings)) {
    result.reason = rounded(100 * found.readings.contradiction()) +
                    " % of the points lie in free space of " + others_;
  } else if (found.surface.contradicts(by_map ? 0 : readings)) {
    result.reason = "the frame sees free space at " + rounded(100 * found.surface.contradiction()) +
                    " % of the surface in " + others_;
  } else if (result.overlap < kMinOverlap || result.pairs < kMinPairs) {
    result.status = RegistrationStatus::too_little_overlap;
    result.reason = std::to_string(result.pairs) + " of " + std::to_string(readings) +
                    " points lie on surface that is also in " + others_;
  } else {
    result.status = RegistrationStatus::registered;
  }
  const bool is_found = result.status == RegistrationStatus::registered;
  result.T_world_camera = is_found ? frame.T : frame.T_reported;
  const Matrix6 of_prior = sigmas.cwiseAbs2().asDiagonal();
  const Matrix6& covariance = is_found ? frame.covariance : of_prior;
  std::copy(covariance.data(), covariance.data() + covariance.size(), result.covariance.begin());
  return {result, is_held};
}

// Number of pairs with others for each of a few readings, if the frame is within a sigma of its
// report.
double JointRegistration::shown_of(std::size_t index) {
  JointFrame& frame = joint_.frames[index];
  const std::vector<Reading>& readings = frame.seen.readings;
  const auto few = std::count_if(readings.begin(), readings.end(),
                                 [](const Reading& reading) { return reading.level == 0; });
  std::size_t pairs = 0;
  frame.slack = 1;
  for (const JointFrame& other : joint_.frames) {
    if (&other == &frame || !other.is_in) continue;
    pairs += joint_.sums(frame, frame.T_reported, other, 0).pairs;
  }
  frame.slack = 0;
  return few == 0 ? 0 : static_cast<double>(pairs) / static_cast<double>(few);
}

// Relative to the trusted frames; if these show too little of it, relative to all.
void JointRegistration::align_one(std::size_t index) {
  JointFrame& frame = joint_.frames[index];
  FrameRegistration& result = results_[index];
  frame.reset();
  joint_.align_one(index, false);
  result = verdict_of(index).result;
  if (result.status == RegistrationStatus::registered) return;
  if (result.status == RegistrationStatus::refused) {
    joint_.search_one(index);
    joint_.align_one(index, false);
  } else {
    frame.reset();
    joint_.align_one(index, true);
  }
  result = verdict_of(index).result;
}

// Tries a frame that is not registered; true if it is now.
bool JointRegistration::register_frame(std::size_t index) {
  JointFrame& frame = joint_.frames[index];
  FrameRegistration& result = results_[index];
  shown_[index] = shown_of(index);
  align_one(index);
  if (result.status == RegistrationStatus::registered) {
    std::vector<std::pair<Pose, Matrix6>> before;
    for (const JointFrame& one : joint_.frames) before.emplace_back(one.T, one.covariance);
    const double rim_width = joint_.rim_width;
    frame.is_in = true;
    joint_.align_all();
    const Verdict verdict = verdict_of(index);
    result = verdict.result;
    frame.is_trusted = verdict.is_trusted();
    if (result.status == RegistrationStatus::registered) return true;
    for (std::size_t i = 0; i < before.size(); ++i) {
      std::tie(joint_.frames[i].T, joint_.frames[i].covariance) = before[i];
    }
    joint_.rim_width = rim_width;
  }
  frame.reset();
  frame.is_in = result.status == RegistrationStatus::too_little_overlap;
  return false;
}

// Updates all results. Frames that the others no longer determine return to their report; true if
// there are any, because others may have relied on them.
bool JointRegistration::judge_all() {
  std::vector<Verdict> verdicts(results_.size());
  pool_.for_each_chunk(results_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const JointFrame& frame = joint_.frames[i];
      if (frame.seen.grid != nullptr) continue;
      if (frame.is_in) verdicts[i] = verdict_of(i);
      (frame.is_in ? verdicts[i].result : results_[i]).residual_before =
          residual_of(sums_with_others(i, frame.T_reported));
    }
  });
  bool is_less_known = false;
  for (std::size_t i = 0; i < results_.size(); ++i) {
    JointFrame& frame = joint_.frames[i];
    if (!frame.is_in || frame.seen.grid != nullptr) continue;
    const bool was_registered = results_[i].status == RegistrationStatus::registered;
    frame.is_trusted = verdicts[i].is_trusted();
    results_[i] = std::move(verdicts[i].result);
    if (results_[i].status == RegistrationStatus::registered) continue;
    frame.is_in = results_[i].status == RegistrationStatus::too_little_overlap;
    frame.reset();
    is_less_known |= was_registered;
  }
  return is_less_known;
}

void JointRegistration::add_fixed(RegistrationView seen, const Pose& T_world_view) {
  joint_.frames.push_back({std::move(seen), T_world_view, {1, 1}, true, true, true});
  joint_.frames.back().reset();
  results_.emplace_back();
  shown_.push_back(0);
  (void)judge_all();
}

void JointRegistration::add(RegistrationView seen, const Pose& T_reported, const PoseSigma& sigma) {
  joint_.frames.push_back({std::move(seen), T_reported, sigma});
  joint_.frames.back().reset();
  results_.emplace_back();
  shown_.push_back(0);
  const auto enough_shown = [&](std::size_t i) {
    if (results_[i].status == RegistrationStatus::too_little_overlap) return shown_[i];
    return std::max(kMore * shown_[i], shown_[i] + kMinOverlap);
  };
  bool is_more_known = register_frame(results_.size() - 1);
  while (is_more_known) {
    is_more_known = false;
    for (std::size_t i = 0; i < results_.size(); ++i) {
      JointFrame& frame = joint_.frames[i];
      if (frame.is_fixed || frame.is_trusted) continue;
      if (results_[i].status == RegistrationStatus::registered) {
        frame.is_trusted = verdict_of(i).is_trusted();
        is_more_known |= frame.is_trusted;
      } else if (shown_of(i) > enough_shown(i)) {
        is_more_known |= register_frame(i);
      }
    }
  }
  for (std::size_t i = 0; i < results_.size() && judge_all(); ++i) {
  }
}

}  // namespace viewgain::detail
