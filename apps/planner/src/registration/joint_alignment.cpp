// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "registration/joint_alignment.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "registration/pose_motion.hpp"

namespace viewgain::detail {
namespace {

constexpr double kAlongSurface = 2;  // lengths
// Readings are used in several pairs.
constexpr double kRedundancy = 3;
// What all frames get wrong alike does not show in how they differ. Measured: on simulated objects
// frames differ by 0.1 to 0.4 of what their readings' noise gives, where 3 widens as it should.
constexpr double kWidening = 8;
// Of the prior on rims' width. Simulated views want 0 without any noise, 0.02 with noise along the
// ray alone, 0.055 with lateral noise as well.
constexpr double kRimSigma = 0.03;
constexpr double kSettled = 0.3;  // slack of frames that were aligned before, in sigmas
constexpr double kSearch = 1.5;   // where the search begins, in sigmas from the reported pose
constexpr int kMaxIterations = 15;
constexpr std::size_t kLeastPairs = 20;      // of two frames
constexpr std::size_t kLeastReadings = 400;  // of a frame

// What a motion of the source does, as one of the target: e falls with the motion A of that.
Matrix6 carried(const Pose& T_world_source, const Pose& T_world_target) {
  const Eigen::Vector3d d = T_world_source.translation() - T_world_target.translation();
  Matrix6 A = Matrix6::Identity();
  A.bottomLeftCorner<3, 3>() << 0, -d.z(), d.y(), d.z(), 0, -d.x(), -d.y(), d.x(), 0;
  return A;
}

}  // namespace

// In sigmas of the priors, along what the others hold of each frame. The rims' width, if it is to
// be found, is the last.
struct JointAlignment::System {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
  Eigen::VectorXd away;     // from what was reported
  double disagreement = 0;  // of single neighbours about each frame
};

JointAlignment::JointAlignment(double length, double max_normal_angle, ThreadPool& pool)
    : length_(length),
      min_cosine_(std::cos(max_normal_angle)),
      pool_(pool),
      widening_(kRedundancy) {}

PairGates JointAlignment::gates_of(const JointFrame& frame) const {
  return {frame.slack * frame.sigmas[0], frame.slack * frame.sigmas[3], kAlongSurface * length_,
          min_cosine_};
}

Matrix6 JointAlignment::of_single_pairs(const Matrix6& agreed) { return agreed / kRedundancy; }

// From one level to the next the readings are four times as many.
int JointAlignment::level_of(const Pass& pass) const {
  std::size_t readings = 0;
  for (const std::size_t i : pass.movable) readings += frames[i].seen.readings().size();
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
      if (takes_part(i) && takes_part(j)) pairs.emplace_back(i, j);
    }
  }
  const int level = level_of(pass);
  std::vector<ViewSums> sums(pairs.size());
  pool_.for_each_chunk(pairs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const JointFrame& source = frames[pairs[k].first];
      const JointFrame& target = frames[pairs[k].second];
      sums[k] = pair_sums(source.seen, source.T, gates_of(source), target.seen, target.T,
                          gates_of(target), rim_width, level);
    }
  });
  const auto motions = static_cast<Eigen::Index>(6 * pass.movable.size());
  const Eigen::Index n = motions + (pass.with_rims ? 1 : 0);
  System s{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  std::vector<Matrix6> agreed(frames.size(), Matrix6::Zero());
  std::vector<Vector6> of_neighbour(frames.size() * frames.size(), Vector6::Zero());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const ViewSums& sum = sums[k];
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
    of_neighbour[i * frames.size() + j] += sum.gradient;
    of_neighbour[j * frames.size() + i] -= A * sum.gradient;
    agreed[i] += sum.agreed;
    agreed[j] += A * sum.agreed * A.transpose();
  }
  Eigen::MatrixXd onto = Eigen::MatrixXd::Zero(n, n);
  Overdispersion disagreement;
  for (std::size_t k = 0; k < pass.movable.size(); ++k) {
    const JointFrame& frame = frames[pass.movable[k]];
    const auto a = static_cast<Eigen::Index>(6 * k);
    const Matrix6 held =
        held_axes(directions_of(of_single_pairs(agreed[pass.movable[k]]), frame.sigmas));
    onto.block<6, 6>(a, a) = frame.sigmas.asDiagonal() * held * held.transpose();
    const std::span gradients(&of_neighbour[pass.movable[k] * frames.size()], frames.size());
    const Overdispersion of_frame =
        overdispersion_of(gradients, s.information.block<6, 6>(a, a), held, frame.sigmas);
    disagreement.sum += of_frame.sum;
    disagreement.motions += of_frame.motions;
    s.away.segment<6>(a) = difference(frame.T, frame.T_reported).cwiseQuotient(frame.sigmas);
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

// One step of Gauss and Newton; false if it was short.
bool JointAlignment::move(const Pass& pass) {
  const System s = system(pass);
  Eigen::VectorXd of_prior = Eigen::VectorXd::Constant(s.gradient.size(), 1 / scale_);
  if (pass.with_rims) of_prior.tail<1>().setOnes();  // known as well as ever
  whole_ = s.information;
  whole_.diagonal() += of_prior;
  const Eigen::VectorXd step = whole_.llt().solve(-(s.gradient + s.away.cwiseProduct(of_prior)));
  for (std::size_t k = 0; k < pass.movable.size(); ++k) {
    JointFrame& frame = frames[pass.movable[k]];
    const Vector6 own = step.segment<6>(static_cast<Eigen::Index>(6 * k));
    frame.T = moved(frame.T, own.cwiseProduct(frame.sigmas));
    ++frame.iterations;
  }
  if (pass.with_rims) rim_width += step.tail<1>().value() * kRimSigma;
  return std::sqrt(step.dot(whole_ * step)) >= pass.still;
}

void JointAlignment::align(const Pass& pass) {
  for (int i = 0; i < kMaxIterations && move(pass); ++i) {
  }
}

double JointAlignment::estimated_scale(Pass pass) const {
  pass.with_rims = false;
  const System s = system(pass);
  return likeliest_scale(s.information, s.gradient, s.away);
}

void JointAlignment::begin_one(const Pass& pass) {
  JointFrame& frame = frames[pass.movable.front()];
  for (JointFrame& one : frames) one.slack = one.is_trusted ? kSettled : 1;
  frames.front().slack = 0;
  frame.slack = 1;
  frame.iterations = 0;
  scale_ = 1;
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

// Of few readings, either way.
std::size_t JointAlignment::pairs_of(std::size_t index) const {
  const JointFrame& frame = frames[index];
  std::size_t pairs = 0;
  for (std::size_t j = 0; j < frames.size(); ++j) {
    const JointFrame& other = frames[j];
    if (j == index || !other.is_trusted) continue;
    for (const auto& [source, target] : {std::pair(&frame, &other), std::pair(&other, &frame)}) {
      pairs += pair_sums(source->seen, source->T, gates_of(*source), target->seen, target->T,
                         gates_of(*target), rim_width, 1)
                   .pairs;
    }
  }
  return pairs;
}

void JointAlignment::search_one(std::size_t index) {
  const Pass pass{{index}, 0, 0.5, true};
  JointFrame& frame = frames[index];
  Pose best = frame.T_reported;
  std::size_t most = 0;
  for (int axis = 0; axis < 6; ++axis) {
    for (const double side : {kSearch, -kSearch}) {
      Vector6 shift = Vector6::Zero();
      shift[axis] = side * frame.sigmas[axis];
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
  for (std::size_t i = 1; i < frames.size(); ++i) {
    if (!frames[i].is_in) continue;
    pass.movable.push_back(i);
    frames[i].slack = frames[i].is_trusted ? kSettled : 1;
    frames[i].iterations = 0;
  }
  if (pass.movable.empty()) return;
  frames.front().slack = 0;
  scale_ = 1;
  widening_ = kRedundancy;
  align(pass);
  for (const std::size_t i : pass.movable) frames[i].slack = kSettled;
  align(pass);
  for (JointFrame& frame : frames) frame.slack = 0;
  pass.level = 1, pass.still = 0.1, pass.with_rims = true;
  align(pass);
  widening_ = std::max(kRedundancy, kWidening * system(pass).disagreement);
  pass.level = kLevels - 1, pass.still = 0.05;
  scale_ = estimated_scale(pass);
  align(pass);
  const Eigen::MatrixXd covariance = whole_.inverse();
  for (std::size_t k = 0; k < pass.movable.size(); ++k) {
    const auto a = static_cast<Eigen::Index>(6 * k);
    JointFrame& frame = frames[pass.movable[k]];
    frame.covariance =
        frame.sigmas.asDiagonal() * covariance.block<6, 6>(a, a) * frame.sigmas.asDiagonal();
  }
}

}  // namespace viewgain::detail
