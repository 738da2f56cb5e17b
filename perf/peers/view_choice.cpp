// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "view_choice.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "viewgain/core/error.hpp"
#include "viewgain/support/hash64.hpp"

namespace viewgain::bench {
namespace {

ScorerConfig scorer_config(Ranker ranker, const Box& workspace, double voxel, int stride) {
  ScorerConfig config;
  config.voxel_size = voxel;
  config.workspace = workspace;
  config.jump_edges.reset();  // their camera makes no flying pixels
  config.gain.pixel_stride = stride;
  config.gain.model = GainModel::paper;
  if (ranker == Ranker::combined) config.gain.model = GainModel::combined;
  if (ranker == Ranker::surface) config.gain.model = GainModel::surface;
  return config;
}

/// The values as shares of their sum.
void make_shares(std::vector<double>& values) {
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  if (!(sum > 0)) return;
  for (double& value : values) value /= sum;
}

}  // namespace

const std::vector<std::string>& ranker_names() {
  static const std::vector<std::string> names{"combined", "surface", "paper", "frontier", "random"};
  return names;
}

Ranker parse_ranker(const std::string& name) {
  const auto& names = ranker_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    std::string message = name;
    message.append(": is none of");
    for (const std::string& valid : names) message.append(" ").append(valid);
    throw Error(ErrorCode::invalid_argument, message);
  }
  return static_cast<Ranker>(found - names.begin());
}

ViewChoice::ViewChoice(Ranker ranker, const Sensor& sensor, const Box& workspace, double voxel,
                       int stride, std::uint64_t seed, const ExecConfig& exec)
    : ranker_(ranker),
      seed_(seed),
      scorer_(sensor, scorer_config(ranker, workspace, voxel, stride), exec) {}

void ViewChoice::add(const DepthFrame& frame, const Pose& T_world_camera) {
  ++views_;
  if (ranker_ != Ranker::random) scorer_.add(frame, T_world_camera);
  eye_ = T_world_camera.translation();
}

std::vector<double> ViewChoice::values(std::span<const Pose> T_world_camera) {
  std::vector<double> result;
  if (ranker_ == Ranker::random) {
    const std::uint64_t step = mix64(mix64(seed_) ^ views_);
    for (std::size_t i = 0; i < T_world_camera.size(); ++i) {
      result.push_back(unit_number(mix64(step ^ i)));
    }
    return result;
  }
  for (const ViewGain& gain : scorer_.evaluate(T_world_camera)) {
    result.push_back(ranker_ == Ranker::frontier ? gain.unknown_voxels : gain.gain);
  }
  return result;
}

std::optional<std::size_t> ViewChoice::next(std::span<const Pose> T_world_camera,
                                            std::span<const std::uint8_t> taken, double travel) {
  std::vector<double> worth = values(T_world_camera);
  std::vector<double> way;
  for (const Pose& pose : T_world_camera) way.push_back((pose.translation() - eye_).norm());
  make_shares(worth);
  make_shares(way);
  std::optional<std::size_t> best;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < worth.size(); ++i) {
    const double value = (1 - travel) * worth[i] - travel * way[i];
    if (taken[i] == 0 && value > most) most = value, best = i;
  }
  return best;
}

}  // namespace viewgain::bench
