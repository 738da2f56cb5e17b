// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "registration/joint_alignment.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "registration/pose_motion.hpp"

namespace viewgain::detail {
namespace {

constexpr double kAlongSurface = 2;  // lengths
// Readings are used in several pairs of frames. Common errors of a map's points do not show:
// squared errors of poses are 2.8 to 3.9 times those of independent errors.
constexpr double kRedundancy = 3;
// For the information that both normals agree on, where points share readings: leaves 23 of 24
// noisy walls free.
constexpr double kMapRedundancy = 1.5;
// Errors common to all frames do not show in their differences. Measured: simulated frames differ
// by 0.1 to 0.4 of their readings' noise, where 3 widens correctly.
constexpr double kAlike = 8;
// Prior of the rims' width. Simulated views want 0 without noise, 0.02 with noise along the ray
// only, 0.055 with lateral noise too.
constexpr double kRimSigma = 0.03;
constexpr double kSettled = 0.3;  // slack of frames that were aligned before, in sigmas
constexpr double kSearch = 1.5;   // starting points of the search, in sigmas from the reported pose
constexpr int kMaxIterations = 15;
constexpr std::size_t kLeastPairs = 20;      // of two frames
constexpr std::size_t kLeastReadings = 400;  // of a frame

// Effect of a motion of the source as one of the target: e decreases with the motion A of the
// target.
Matrix6 carried(const Pose& T_world_source, const Pose& T_world_target) {
  const Eigen::Vector3d d = T_world_source.translation() - T_world_target.translation();
  Matrix6 A = Matrix6::Identity();
  A.bottomLeftCorner<3, 3>() << 0, -d.z(), d.y(), d.z(), 0, -d.x(), -d.y(), d.x(), 0;
  return A;
}

}  // namespace

// In sigmas of the priors, along the motions that the others determine for each frame. The rims'
// width, if estimated, is last.
struct JointAlignment::System {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
  Eigen::VectorXd away;     // from the reported pose
  double disagreement = 0;  // of single neighbours about each frame
};

Vector6 JointFrame::sigmas() const {
  Vector6 sigmas;
  sigmas << Eigen::Vector3d::Constant(sigma.translation), Eigen::Vector3d::Constant(sigma.rotation);
  return sigmas;
}

void JointFrame::reset() {
  T = T_reported;
  covariance = is_fixed ? Matrix6::Zero() : Matrix6(sigmas().cwiseAbs2().asDiagonal());
}

JointAlignment::JointAlignment(double length, ThreadPool& pool) : length_(length), pool_(pool) {}

PairSums JointAlignment::sums(const JointFrame& source, const Pose& T_source,
                              const JointFrame& target, int level,
                              std::vector<std::uint8_t>* is_paired) const {
  const auto slack = [](const JointFrame& frame) {
    return PoseSigma{frame.slack * frame.sigma.translation, frame.slack * frame.sigma.rotation};
  };
  return pair_sums({source.seen, T_source, slack(source)}, {target.seen, target.T, slack(target)},
                   kAlongSurface * length_, rim_width, level, pool_, is_paired);
}

Matrix6 JointAlignment::of_single_pairs(const Matrix6& agreed) const {
  return agreed / (is_by_map() ? kMapRedundancy : kRedundancy);
}

double JointAlignment::least_widening() const { return is_by_map() ? 1 : kRedundancy; }

// Each level has four times as many readings as the one before.
int JointAlignment::level_of(const Pass& pass) const {
  std::size_t readings = 0;
  for (const std::size_t i : pass.movable) readings += frames[i].seen.readings.size();
  int level = pass.level;
  const auto share = [&level] { return std::size_t{1} << (2 * (kLevels - 1 - level)); };
  while (level < kLevels - 1 && readings < kLeastReadings * pass.movable.size() * share()) ++level;
  return level;
}

JointAlignment::System JointAlignment::system(const Pass& pass) const {
  std::vector<Eigen::Index> column(frames.size(), -1);
  for (std::size_t k = 0; k < pass.movable.size(); ++k) {
    column[pass.movable[k]] = static_cast<Eigen::Index>(6 * k);
  }
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  const auto takes_part = [&](std::size_t i) {
    return column[i] >= 0 || (pass.trusted_only ? frames[i].is_trusted : frames[i].is_in);
  };
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (std::size_t j = 0; j < frames.size(); ++j) {
      if (i == j || (column[i] < 0 && column[j] < 0)) continue;
      // A map's points are targets of readings, but have no targets: they would count twice.
      if (frames[i].seen.grid != nullptr) continue;
      if (takes_part(i) && takes_part(j)) pairs.emplace_back(i, j);
    }
  }
  const int level = level_of(pass);
  std::vector<PairSums> sums_of(pairs.size());
  const auto add_up = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      sums_of[k] = sums(frames[pairs[k].first], frames[pairs[k].second], level);
    }
  };
  // A single pair distributes its readings over the threads.
  if (pairs.size() == 1) add_up(0, 1);
  if (pairs.size() > 1) pool_.for_each_chunk(pairs.size(), 1, add_up);
  const auto motions = static_cast<Eigen::Index>(6 * pass.movable.size());
  const Eigen::Index n = motions + (pass.with_rims ? 1 : 0);
  System s{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  std::vector<Matrix6> agreed(frames.size(), Matrix6::Zero());
  // The neighbours' contributions to a frame, one by one; a map has many.
  std::vector<std::vector<Vector6>> parts(frames.size(),
                                          std::vector<Vector6>(frames.size(), Vector6::Zero()));
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const PairSums& sum = sums_of[k];
    if (sum.pairs < kLeastPairs) continue;
    const auto [i, j] = pairs[k];
    const Matrix6 A = carried(frames[i].T, frames[j].T);
    const Eigen::Index a = column[i], b = column[j];
    if (a >= 0) {
      s.information.block<6, 6>(a, a) += sum.information;
      s.gradient.segment<6>(a) += sum.gradient;
    }
    if (b >= 0) {
      s.information.block<6, 6>(b, b) += A * sum.information * A.transpose();
      s.gradient.segment<6>(b) -= A * sum.gradient;
    }
    if (a >= 0 && b >= 0) {
      s.information.block<6, 6>(a, b) -= sum.information * A.transpose();
      s.information.block<6, 6>(b, a) -= A * sum.information;
    }
    if (pass.with_rims) {
      if (a >= 0) s.information.block<6, 1>(a, motions) += sum.rim_motion;
      if (b >= 0) s.information.block<6, 1>(b, motions) -= A * sum.rim_motion;
      s.information(motions, motions) += sum.rim_information;
      s.gradient[motions] += sum.rim_gradient;
    }
    parts[i].insert(parts[i].end(), sum.of_parts.begin(), sum.of_parts.end());
    if (sum.of_parts.empty()) parts[i][j] += std::sqrt(kAlike) * sum.gradient;
    parts[j][i] -= std::sqrt(kAlike) * A * sum.gradient;
    agreed[i] += sum.agreed;
    agreed[j] += A * sum.agreed * A.transpose();
  }
  Eigen::MatrixXd onto = Eigen::MatrixXd::Zero(n, n);
  Overdispersion disagreement;
  for (std::size_t k = 0; k < pass.movable.size(); ++k) {
    const JointFrame& frame = frames[pass.movable[k]];
    const Vector6 sigmas = frame.sigmas();
    const auto a = static_cast<Eigen::Index>(6 * k);
    const Matrix6 held = held_axes(directions_of(of_single_pairs(agreed[pass.movable[k]]), sigmas));
    onto.block<6, 6>(a, a) = sigmas.asDiagonal() * held * held.transpose();
    add_overdispersion(disagreement, parts[pass.movable[k]], s.information.block<6, 6>(a, a), held,
                       sigmas);
    s.away.segment<6>(a) = difference(frame.T, frame.T_reported).cwiseQuotient(sigmas);
  }
  if (pass.with_rims) {
    s.information.row(motions).head(motions) = s.information.col(motions).head(motions).transpose();
    onto(motions, motions) = kRimSigma;
    s.away[motions] = (rim_width - kUsualRimWidth) / kRimSigma;
  }
  s.disagreement = disagreement.mean();
  s.information = (onto.transpose() * s.information * onto / widening_).eval();
  s.gradient = (onto.transpose() * s.gradient / widening_).eval();
  return s;
}

// One Gauss-Newton step; false if it was short.
bool JointAlignment::move(const Pass& pass) {
  const System s = system(pass);
  Eigen::VectorXd of_prior = Eigen::VectorXd::Constant(s.gradient.size(), 1 / scale_);
  if (pass.with_rims) of_prior.tail<1>().setOnes();  // as well known as before
  information_ = s.information;
  Eigen::MatrixXd whole = s.information;
  whole.diagonal() += of_prior;
  const Eigen::VectorXd step = whole.llt().solve(-(s.gradient + s.away.cwiseProduct(of_prior)));
  for (std::size_t k = 0; k < pass.movable.size(); ++k) {
    JointFrame& frame = frames[pass.movable[k]];
    const Vector6 own = step.segment<6>(static_cast<Eigen::Index>(6 * k));
    frame.T = moved(frame.T, own.cwiseProduct(frame.sigmas()));
    ++frame.iterations;
  }
  if (pass.with_rims) rim_width += step.tail<1>().value() * kRimSigma;
  return std::sqrt(step.dot(whole * step)) >= pass.still;
}

void JointAlignment::align(const Pass& pass) {
  for (int i = 0; i < kMaxIterations && move(pass); ++i) {
  }
}

double JointAlignment::estimated_scale(Pass pass) const {
  pass.with_rims = false;
  const System s = system(pass);
  const double honest = std::min(1.0, widening_ / kRedundancy);
  return likeliest_scale(honest * s.information, honest * s.gradient, s.away);
}

void JointAlignment::begin_one(const Pass& pass) {
  JointFrame& frame = frames[pass.movable.front()];
  for (JointFrame& one : frames) one.slack = one.is_fixed ? 0 : one.is_trusted ? kSettled : 1;
  frame.slack = 1;
  frame.iterations = 0;
  scale_ = 1;
  widening_ = std::max(widening_, least_widening());
  align(pass);
}

void JointAlignment::align_one(std::size_t index, bool against_all) {
  Pass pass{{index}, 0, 0.5, !against_all};
  begin_one(pass);
  frames[index].slack = kSettled;
  pass.still = 0.2;
  align(pass);
  for (JointFrame& frame : frames) frame.slack = 0;
  pass.level = 1, pass.still = 0.1;
  align(pass);
}

// From a few readings, in both directions.
std::size_t JointAlignment::pairs_of(std::size_t index) const {
  const JointFrame& frame = frames[index];
  std::size_t pairs = 0;
  for (std::size_t j = 0; j < frames.size(); ++j) {
    const JointFrame& other = frames[j];
    if (j == index || !other.is_trusted) continue;
    pairs += sums(frame, other, 1).pairs + sums(other, frame, 1).pairs;
  }
  return pairs;
}

void JointAlignment::search_one(std::size_t index) {
  const Pass pass{{index}, 0, 0.5, true};
  JointFrame& frame = frames[index];
  const Vector6 sigmas = frame.sigmas();
  Pose best = frame.T_reported;
  std::size_t most = 0;
  for (int axis = 0; axis < 6; ++axis) {
    for (const double side : {kSearch, -kSearch}) {
      Vector6 shift = Vector6::Zero();
      shift[axis] = side * sigmas[axis];
      frame.T = moved(frame.T_reported, shift);
      begin_one(pass);
      for (JointFrame& one : frames) one.slack = 0;
      align(pass);
      const std::size_t pairs = pairs_of(index);
      if (pairs > most) most = pairs, best = frame.T;
    }
  }
  frame.T = best;
}

void JointAlignment::align_all() {
  Pass pass{{}, 0, 0.2};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].slack = 0;
    if (!frames[i].is_in || frames[i].is_fixed) continue;
    pass.movable.push_back(i);
    frames[i].slack = frames[i].is_trusted ? kSettled : 1;
    frames[i].iterations = 0;
  }
  if (pass.movable.empty()) return;
  scale_ = 1;
  widening_ = least_widening();
  align(pass);
  for (const std::size_t i : pass.movable) frames[i].slack = kSettled;
  align(pass);
  for (JointFrame& frame : frames) frame.slack = 0;
  pass.level = 1, pass.still = 0.1, pass.with_rims = true;
  align(pass);
  widening_ = std::max(least_widening(), system(pass).disagreement);
  pass.level = kLevels - 1, pass.still = 0.05;
  scale_ = estimated_scale(pass);
  align(pass);
  // Not with the scaled prior: agreement along determined motions does not apply to the others.
  information_ *= std::min(1.0, widening_ / kRedundancy);
  information_.diagonal().array() += 1;
  const Eigen::MatrixXd covariance = information_.inverse();
  for (std::size_t k = 0; k < pass.movable.size(); ++k) {
    const auto a = static_cast<Eigen::Index>(6 * k);
    JointFrame& frame = frames[pass.movable[k]];
    const Vector6 sigmas = frame.sigmas();
    frame.covariance = sigmas.asDiagonal() * covariance.block<6, 6>(a, a) * sigmas.asDiagonal();
  }
}

}  // namespace viewgain::detail
