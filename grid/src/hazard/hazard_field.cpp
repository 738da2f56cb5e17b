// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>

#include "free_share.hpp"
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
  if (!ok) refuse("hazard: the " + std::string(name) + ", not " + short_text(value));
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
  if (object_size)
    check(is_positive(*object_size), "object size must be positive and finite", *object_size);
  if (model) {
    check(is_positive(model->decay_length), "decay length must be positive and finite",
          model->decay_length);
    check(is_rate(model->near_rate), "rate near the surface must be at least 0 and finite",
          model->near_rate);
    check(is_rate(model->far_rate), "rate far from the surface must be at least 0 and finite",
          model->far_rate);
  }
  if (!volume) return;
  if (volume->rates.size() != volume->box.volume()) {
    refuse("hazard: one rate per voxel of the box is required; rates: " +
           std::to_string(volume->rates.size()) +
           ", voxels: " + std::to_string(volume->box.volume()));
  }
  check(is_rate(double{volume->outside}), "rate outside the volume must be at least 0 and finite",
        double{volume->outside});
  for (const float rate : volume->rates)
    check(is_rate(double{rate}), "rate must be at least 0 and finite", double{rate});
}

HazardConfig constant_hazard(double rate, const BeliefGrid& grid,
                             std::optional<double> object_size) {
  if (object_size) {
    check(*object_size > 0 && std::isfinite(*object_size),
          "object size must be positive and finite", *object_size);
  }
  const Index3 dims = grid.dims();
  const double longest = std::max({dims.x, dims.y, dims.z}) * grid.voxel_size();
  HazardConfig config;
  config.object_size = object_size;
  config.model = HazardConfig::Model::constant(rate, object_size.value_or(longest));
  return config;
}

HazardField::HazardField(const GridSnapshot& snapshot, const HazardConfig& config,
                         const ExecConfig& exec)
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
  if (layout.evidence.empty()) return;
  ThreadPool pool(exec.num_threads);
  find_distances(snapshot, layout, pool);
}

void HazardField::find_distances(const GridSnapshot& snapshot, const detail::HazardLayout& layout,
                                 ThreadPool& pool) {
  const VoxelBox& cells = layout.cells;
  low_cell_ = cells.min;
  size_ = {static_cast<std::size_t>(cells.max.x - cells.min.x),
           static_cast<std::size_t>(cells.max.y - cells.min.y),
           static_cast<std::size_t>(cells.max.z - cells.min.z)};
  near_box_ = layout.voxels;
  squared_.assign(cells.volume(), detail::kNoDistance);
  std::vector<std::uint32_t> sources;  // cells with evidence
  for (const Index3& v : layout.evidence) {
    const std::size_t at = cell_of(v);
    if (std::exchange(squared_[at], std::uint16_t{0}) != 0) {
      sources.push_back(static_cast<std::uint32_t>(at));
    }
  }
  static_assert(kNoDistance == detail::kNoDistance);
  const detail::NearestCells nearest(squared_, size_, layout.reach, pool);
  const detail::FreeShare free(snapshot, cells, shift_, pool);
  const detail::OpenDirections open(snapshot, cells, shift_, free, layout.open_reach, pool);
  find_shapes(nearest, free, open, sources, pool);
  find_rates(layout.reach);
}

void HazardField::find_shapes(const detail::NearestCells& nearest, const detail::FreeShare& free,
                              const detail::OpenDirections& open,
                              const std::vector<std::uint32_t>& sources, ThreadPool& pool) {
  using Model = HazardConfig::Model;
  const std::size_t nx = size_[0], ny = size_[1], nz = size_[2];
  // Direction towards free space at each cell with evidence.
  struct Normal {
    Eigen::Vector3d direction;
    double norm;
  };
  std::vector<Normal> normals(sources.size());
  const auto number = std::make_unique_for_overwrite<std::uint32_t[]>(squared_.size());
  pool.for_each_chunk(sources.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t at = sources[i];
      const Eigen::Vector3d n =
          free.gradient(static_cast<int>(at / nz / ny), static_cast<int>(at / nz % ny),
                        static_cast<int>(at % nz));
      normals[i] = {n, n.norm()};
      number[at] = static_cast<std::uint32_t>(i);
    }
  });
  std::array<double, detail::OpenDirections::kDirections + 1> openness{};
  for (std::size_t k = 0; k < openness.size(); ++k) {
    openness[k] = Model::openness(static_cast<double>(k) / detail::OpenDirections::kDirections);
  }
  shapes_.resize(squared_.size());
  const auto shape_at = [&](std::size_t x, std::size_t y, std::size_t z, std::size_t i) {
    const auto [dx, dy, dz] = nearest.offset(x, y, z);
    const auto source = static_cast<std::size_t>(
        static_cast<std::ptrdiff_t>(i) +
        (std::ptrdiff_t{dx} * std::ptrdiff_t(ny) + dy) * std::ptrdiff_t(nz) + dz);
    const Normal& normal = normals[number[source]];
    const Eigen::Vector3d away(-dx, -dy, -dz);  // from there to here
    const double product = normal.norm * away.norm();
    const double sine = product > 0 ? normal.direction.dot(away) / product : 0.0;
    return Model::continuation(sine) * openness[static_cast<std::size_t>(open.count(x, y, z))];
  };
  pool.for_each_chunk(nx, 1, [&](std::size_t x, std::size_t) {
    std::size_t i = x * ny * nz;
    for (std::size_t y = 0; y < ny; ++y) {
      for (std::size_t z = 0; z < nz; ++z, ++i) {
        const bool is_asked = squared_[i] != kNoDistance && free.is_free()[i] == 0;
        if (is_asked) {
          shapes_[i] = static_cast<std::uint16_t>(kShapeUnit * shape_at(x, y, z, i) + 0.5);
        } else {
          shapes_[i] = static_cast<std::uint16_t>(kShapeUnit);
        }
      }
    }
  });
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
