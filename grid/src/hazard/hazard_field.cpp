// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>

#include "hazard_layout.hpp"
#include "nearest_cells.hpp"
#include "open_directions.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/grid/hazard.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
void check(bool ok, const char* name, double value) {
  if (!ok) refuse("hazard: " + std::string(name) + " " + short_text(value) + " is out of bounds");
}

// Factors of the model's rates by distance class that make the rates of classes decrease with
// distance: classes that violate this are pooled by weight (isotonic regression), so that a class
// with few counts follows its neighbours.
using Factors = std::array<double, HazardCounters::kClasses>;
Factors monotone_factors(const HazardConfig::Model& model, const HazardCounters& counters) {
  struct Block {
    double rate, weight;
    std::size_t classes;
  };
  const auto model_rate = [&](std::size_t k) {  // in the middle of a class
    if (k == HazardCounters::kEnds.size()) return model.rate(kFar);
    const double begin = k > 0 ? HazardCounters::kEnds[k - 1] : 0.0;
    return model.rate(0.5 * (begin + HazardCounters::kEnds[k]) * model.decay_length);
  };
  std::vector<Block> blocks;
  for (std::size_t k = 0; k < HazardCounters::kClasses; ++k) {
    blocks.push_back({model_rate(k) * counters.factor(k), counters.weight(k), 1});
    while (blocks.size() > 1 && blocks.back().rate > blocks[blocks.size() - 2].rate) {
      const Block last = blocks.back();
      blocks.pop_back();
      Block& before = blocks.back();
      const double weight = before.weight + last.weight;
      before.rate = (before.rate * before.weight + last.rate * last.weight) / weight;
      before.weight = weight;
      before.classes += last.classes;
    }
  }
  Factors factors;
  std::size_t k = 0;
  for (const Block& block : blocks) {
    for (std::size_t i = 0; i < block.classes; ++i, ++k) {
      const double rate = model_rate(k);
      factors[k] = rate > 0 ? block.rate / rate : 1.0;
    }
  }
  return factors;
}

}  // namespace

double HazardConfig::Model::continuation(double sine_of_elevation) {
  constexpr std::array<double, 11> kAt{0.30, 0.58,  0.81,  1.00,  0.95, 0.53,
                                       0.28, 0.162, 0.106, 0.064, 0.032};  // from -1 to 1
  const double place = std::clamp(5 * (sine_of_elevation + 1), 0.0, 10.0);
  const std::size_t before = std::min<std::size_t>(static_cast<std::size_t>(place), 9);
  return std::lerp(kAt[before], kAt[before + 1], place - static_cast<double>(before));
}

double HazardConfig::Model::openness(double share_of_directions) {
  constexpr std::array<double, 14> kAt{0.25, 0.26, 0.32,  0.53,  0.83,  1.00,   0.88,
                                       0.53, 0.29, 0.165, 0.076, 0.030, 0.0052, 0.0005};
  const double place = std::clamp(13 * share_of_directions, 0.0, 13.0);
  const std::size_t before = std::min<std::size_t>(static_cast<std::size_t>(place), 12);
  return std::lerp(kAt[before], kAt[before + 1], place - static_cast<double>(before));
}

void HazardConfig::validate() const {
  const auto is_positive = [](double value) { return value > 0 && std::isfinite(value); };
  const auto is_rate = [](double value) { return value >= 0 && std::isfinite(value); };
  if (object_size) check(is_positive(*object_size), "object size", *object_size);
  if (model) {
    check(is_positive(model->decay_length), "decay length", model->decay_length);
    check(is_rate(model->near_rate), "rate near the surface", model->near_rate);
    check(is_rate(model->far_rate), "rate far from the surface", model->far_rate);
  }
  if (!volume) return;
  if (volume->rates.size() != volume->box.volume()) {
    refuse("hazard: " + std::to_string(volume->rates.size()) + " rates for a box of " +
           std::to_string(volume->box.volume()) + " voxels");
  }
  check(is_rate(double{volume->outside}), "rate outside the volume", double{volume->outside});
  for (const float rate : volume->rates) check(is_rate(double{rate}), "rate", double{rate});
}

HazardConfig constant_hazard(double rate, const BeliefGrid& grid,
                             std::optional<double> object_size) {
  if (object_size) {
    check(*object_size > 0 && std::isfinite(*object_size), "object size", *object_size);
  }
  const Index3 dims = grid.dims();
  const double longest = std::max({dims.x, dims.y, dims.z}) * grid.voxel_size();
  HazardConfig config;
  config.object_size = object_size;
  config.model = HazardConfig::Model::constant(rate, object_size.value_or(longest));
  return config;
}

HazardField::HazardField(const GridSnapshot& snapshot, const HazardConfig& config)
    : volume_(config.volume), voxel_size_(snapshot.voxel_size) {
  const detail::HazardLayout layout(snapshot, config);
  model_ = layout.model;
  pooling_ = layout.pooling;
  shift_ = layout.shift;
  most_known_ = layout.most_known;
  follows_counters_ = layout.follows_counters;
  factors_.fill(1.0);
  if (follows_counters_ && !snapshot.hazard.empty()) {
    factors_ = monotone_factors(model_, snapshot.hazard);
  }
  far_rate_ = volume_ ? volume_->outside : static_cast<float>(model_.rate(kFar) * factors_.back());
  if (!layout.evidence.empty()) find_distances(snapshot, layout);
}

void HazardField::find_distances(const GridSnapshot& snapshot, const detail::HazardLayout& layout) {
  const VoxelBox& cells = layout.cells;
  low_cell_ = cells.min;
  size_ = {static_cast<std::size_t>(cells.max.x - cells.min.x),
           static_cast<std::size_t>(cells.max.y - cells.min.y),
           static_cast<std::size_t>(cells.max.z - cells.min.z)};
  near_box_ = layout.voxels;
  squared_.assign(cells.volume(), detail::kNoDistance);
  for (const Index3& v : layout.evidence) squared_[cell_of(v)] = 0;
  static_assert(kNoDistance == detail::kNoDistance);
  const detail::NearestCells nearest(squared_, size_, layout.reach);
  const detail::FreeShare free(snapshot, cells, shift_);
  find_shapes(nearest, free,
              detail::OpenDirections(snapshot, cells, shift_, free, layout.open_reach));
  find_rates(layout.reach);
}

void HazardField::find_shapes(const detail::NearestCells& nearest, const detail::FreeShare& free,
                              const detail::OpenDirections& open) {
  using Model = HazardConfig::Model;
  shapes_.assign(squared_.size(), static_cast<std::uint16_t>(kShapeUnit));
  std::array<double, detail::OpenDirections::kDirections + 1> openness{};
  for (std::size_t k = 0; k < openness.size(); ++k) {
    openness[k] = Model::openness(static_cast<double>(k) / detail::OpenDirections::kDirections);
  }
  std::size_t i = 0;
  for (std::size_t x = 0; x < size_[0]; ++x) {
    for (std::size_t y = 0; y < size_[1]; ++y) {
      for (std::size_t z = 0; z < size_[2]; ++z, ++i) {
        if (squared_[i] == kNoDistance || free.is_free(i)) continue;
        const auto [dx, dy, dz] = nearest.offset(x, y, z);
        const auto at = [](std::size_t from, int by) { return static_cast<int>(from) + by; };
        // Direction towards free space at the nearest cell with evidence, and direction from there
        // to here.
        const Eigen::Vector3d n = free.gradient(at(x, dx), at(y, dy), at(z, dz));
        const Eigen::Vector3d away(-dx, -dy, -dz);
        const double product = n.norm() * away.norm();
        const double sine = product > 0 ? n.dot(away) / product : 0.0;
        const double shape =
            Model::continuation(sine) * openness[static_cast<std::size_t>(open.count(x, y, z))];
        shapes_[i] = static_cast<std::uint16_t>(std::lround(kShapeUnit * shape));
      }
    }
  }
}

void HazardField::find_rates(int reach) {
  const double cell = voxel_size_ * (1 << shift_);
  rates_.resize(static_cast<std::size_t>(reach * reach) + 1);
  // The factor steps at the end of a class: nearer cells have at least the rate of farther ones.
  double most = model_.rate(kFar) * factors_.back();
  for (std::size_t i = rates_.size(); i-- > 0;) {
    const double distance = std::sqrt(static_cast<double>(i)) * cell;
    const double all = model_.rate(distance);
    most = std::max(most, all * factors_[HazardCounters::class_of(distance / model_.decay_length)]);
    const double factor = all > 0 ? most / all : 0;
    rates_[i] = {static_cast<float>(factor * model_.far_rate),
                 static_cast<float>(factor * (all - model_.far_rate) / kShapeUnit)};
  }
}

float HazardField::volume_rate(Index3 v) const {
  const VoxelBox& box = volume_->box;
  if (!box.contains(v)) return volume_->outside;
  const auto extent = [](std::int32_t from, std::int32_t to) {
    return static_cast<std::size_t>(to - from);
  };
  return volume_
      ->rates[(extent(box.min.x, v.x) * extent(box.min.y, box.max.y) + extent(box.min.y, v.y)) *
                  extent(box.min.z, box.max.z) +
              extent(box.min.z, v.z)];
}

}  // namespace viewgain
