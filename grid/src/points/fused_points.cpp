// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/grid/fused_points.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include "belief_bricks.hpp"
#include "hit_moments.hpp"
#include "point_selection.hpp"
#include "reading_sigma.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/belief_block.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain {
namespace {

using namespace detail;

constexpr double kMaxReach = BrickNeighborhood::kMaxReach;
constexpr double kSupportRadius = 4.0;  // pooling lengths
constexpr double kMostHeight = 6.0;     // half height of a column [voxels]
constexpr int kSteps = 3;               // iterations of a point towards its column's mean
constexpr double kRamp = 0.2;           // transition from one sheet to two [voxels]
// Errors that readings of the same surface share, and blur from pooling a column, relative to a
// reading's sigma, the column's scatter and a voxel; perf/results/honesty.md describes the fit.
constexpr double kOfSigma = 0.19, kOfScatter = 0.43, kOfVoxel = 0.02;

void check(const FusedPointsConfig& config) {
  const auto need = [](bool ok, const std::string& bounds, double value) {
    if (!ok) refuse("fused points: " + bounds + ", not " + short_text(value));
  };
  need(config.normal_radius >= 1 && config.normal_radius <= kMaxReach,
       "normal_radius must be in 1.." + short_text(kMaxReach) + " voxels", config.normal_radius);
  need(config.column_radius > 0 && config.column_radius <= kMaxReach / 2,
       "column_radius must be positive and at most " + short_text(kMaxReach / 2) + " voxels",
       config.column_radius);
  need(config.column_sigmas > 0 && std::isfinite(config.column_sigmas),
       "column_sigmas must be positive and finite", config.column_sigmas);
  need(config.min_distance >= 0 && std::isfinite(config.min_distance),
       "min_distance must be at least 0 and finite", config.min_distance);
  need(config.min_relative_evidence >= 0 && config.min_relative_evidence <= 1,
       "min_relative_evidence must be in 0..1", config.min_relative_evidence);
  need(config.scale_sigma >= 0 && std::isfinite(config.scale_sigma),
       "scale_sigma must be at least 0 and finite", config.scale_sigma);
  if (config.floor_sigma) {
    need(*config.floor_sigma >= 0 && std::isfinite(*config.floor_sigma),
         "floor_sigma must be at least 0 and finite", *config.floor_sigma);
  }
}

/// State of one voxel's point; positions in voxels of the grid.
struct Seed {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  SymmetricMatrix3 information{};  ///< [m⁻²]
  SymmetricMatrix3 covariance{};   ///< of the position [m²]
  std::uint32_t hits = 0;
  double scatter = 0;     ///< variance of the column's means along the normal [voxels²]
  bool has_side = false;  ///< whether the normal points to the voxel's free side
  bool is_near = false;   ///< whether the position is in the voxel's neighbourhood
};

/// The direction in which the readings around a voxel scatter least.
Eigen::Vector3d local_normal(const HitMoments::Sums& around) {
  const Eigen::Vector3d mean = around.first / around.weight;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(around.second / around.weight - mean * mean.transpose());
  return solver.eigenvectors().col(0);
}

/// The items with a nonzero mark, one mark per item.
template <typename Item>
void keep(std::vector<Item>& items, const std::vector<std::uint8_t>& marks) {
  std::size_t next = 0;
  std::erase_if(items, [&](const Item&) { return marks[next++] == 0; });
}

/// Lengths of the configuration in voxels of the bricks.
struct Lengths {
  double normal_radius, column_radius, min_distance, support_radius;
};

/// Sums over the beliefs of a column whose free side agrees with its normal, or disagrees.
struct Face {
  SymmetricMatrix3 information{}, covariance{};
  double hits = 0;
  /// Σ hits · h and h², h the belief's mean relative to the seed [voxels].
  double height = 0, square = 0;

  void add(const PlacedBelief& belief, double h) {
    const double weight = belief.hits;
    information += belief.information;
    covariance += belief.covariance * (weight * weight);
    hits += weight;
    height += weight * h;
    square += weight * h * h;
  }
};

/// Weight, 0 to 1, of the beliefs of a wall's other face. Noise alone separates the means of both
/// halves of a sheet seen from both sides by up to a sigma of a reading [voxels].
double share_of_other(const Face& own, const Face& other, double sigma) {
  if (own.hits == 0 || other.hits == 0) return 1;
  const double apart = std::abs(own.height / own.hits - other.height / other.hits);
  return std::clamp((sigma + kRamp - apart) / kRamp, 0.0, 1.0);
}

/// Moves the seed along its normal to the mean of its column and pools the column's beliefs.
void pool_column(const BeliefBricks& bricks, BrickNeighborhood around, double voxel_size,
                 const PlacedBelief& own, const FusedPointsConfig& config, double radius,
                 Seed& seed) {
  // Sigma of one reading across the surface, in voxels, from the seed voxel's own belief.
  const Eigen::Vector3d n = seed.normal;
  const double variance = own.hits * n.dot(own.covariance * n);
  const double sigma = std::sqrt(std::max(variance, 0.0)) / voxel_size;
  const double half_height =
      std::clamp(config.column_sigmas * sigma, 1.0, kMostHeight);  // NaN: not for valid beliefs
  for (int step = 0; step < kSteps && around.is_near(seed.position); ++step) {
    if (!around.is_centered_on(seed.position)) {
      const Index3 v = BrickNeighborhood::containing(seed.position);
      around = BrickNeighborhood(bricks, {v.x & ~7, v.y & ~7, v.z & ~7});
    }
    Face face, other;
    around.for_each_in_column(seed.position, n, radius, half_height,
                              [&](const PlacedBelief& belief, const Eigen::Vector3d& from_axis) {
                                const double h = n.dot(from_axis + belief.mean);
                                (belief.toward_free.dot(n) < 0 ? other : face).add(belief, h);
                              });
    const double share = share_of_other(face, other, sigma);
    const double hits = face.hits + share * other.hits;
    if (hits == 0) return;
    // Moves only along the normal, and counts each reading once. Weighting by information would
    // blur thin parts: grazing readings seem precise across the surface, but where the surface
    // curves their error along the ray leads away from it.
    const double height = (face.height + share * other.height) / hits;
    seed.position += height * n;
    seed.information = face.information + other.information * share;
    seed.covariance = (face.covariance + other.covariance * (share * share)) * (1 / (hits * hits));
    seed.hits = static_cast<std::uint32_t>(hits);
    seed.scatter = std::max((face.square + share * other.square) / hits - height * height, 0.0);
  }
}

/// How often the surface at a seed was seen, in frontal views: the areas of its readings divided by
/// the area of its column. One frontal view gives about 1 at any range.
double evidence(const Seed& seed, double column_area) {
  return seed.hits * lateral_variance(seed.information, seed.hits) / column_area;
}

/// F of a pooled point along its normal [m²]: errors that its readings share, and blur of the
/// column. Decreases with more views, because their readings sample different positions in a voxel.
double pooled_floor(const Seed& seed, double evidence, double voxel_size) {
  const double own = seed.hits * seed.normal.dot(seed.covariance * seed.normal);  // of one reading
  const double left = std::min(1.0, 0.2 + 2.0 / std::max(evidence, 1.0));
  return left *
         (kOfSigma * kOfSigma * own +
          voxel_size * voxel_size * (kOfScatter * kOfScatter * seed.scatter + kOfVoxel * kOfVoxel));
}

/// How far a point moves per relative change of all ranges [m]: the mean vector to it from the
/// views on the side of `normal`. Each view is weighted by cosθ / t², which is proportional to its
/// readings of the surface. Zero without such views. World frame.
Eigen::Vector3d mean_way(const std::vector<Pose>& views, const Eigen::Vector3d& point,
                         const Eigen::Vector3d& normal) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double weights = 0;
  for (const Pose& view : views) {
    const Eigen::Vector3d way = point - view.translation();
    const double squared = way.squaredNorm(), towards = -way.dot(normal);
    if (!(towards > 0 && way.dot(view.rotation().col(2)) > 0)) continue;
    const double weight = towards / (squared * std::sqrt(squared));
    sum += weight * way;
    weights += weight;
  }
  return weights > 0 ? Eigen::Vector3d(sum / weights) : sum;
}

/// Points of the leaves of one scale; beliefs of finer leaves nearby contribute to their columns.
class ScalePoints {
 public:
  ScalePoints(const BeliefGrid& grid, const GridSnapshot& snapshot,
              const std::vector<BeliefBlockAt>& blocks, int scale, const FusedPointsConfig& config,
              const ExecConfig& exec)
      : grid_(grid),
        snapshot_(snapshot),
        config_(config),
        scale_(scale),
        pooled_(!config.per_voxel),
        pooling_(pooled_ ? pooling_of(snapshot, scale)
                         : Pooling{scale, std::ldexp(grid.voxel_size(), scale)}),
        voxel_size_(std::ldexp(grid.voxel_size(), pooling_.shift)),
        unit_(pooling_.length / voxel_size_),
        lengths_{std::min(config.normal_radius * unit_, kMaxReach), config.column_radius * unit_,
                 config.min_distance * unit_, kSupportRadius * unit_},
        column_area_(std::numbers::pi * std::pow(lengths_.column_radius * voxel_size_, 2)),
        pool_(exec.num_threads),
        bricks_(snapshot, blocks, pooling_.shift) {
    if (pooled_) bricks_.find_sides(pool_);
  }

  std::vector<FusedPoint> find() {
    find_occupied();
    seeds_.resize(occupied_.size());
    pool_.for_each_chunk(occupied_.size(), 256,
                         [&](std::size_t begin, std::size_t end) { make_seeds(begin, end); });
    select();
    std::vector<FusedPoint> points;
    points.reserve(kept_.size());
    for (const std::size_t i : kept_) points.push_back(point_of(seeds_[i]));
    return points;
  }

 private:
  // The occupied voxels with a belief that make points: of this scale, and where wanted.
  void find_occupied() {
    occupied_ = bricks_.occupied_with_belief();
    std::erase_if(occupied_, [&](const auto& at) {
      const Index3 v = offset_voxel(bricks_.origin(at.first), at.second);
      const auto inside = [&](std::int32_t cube,
                              std::int32_t low) {  // a cube at the rim is cut off
        return std::max(cube << pooling_.shift, low);
      };
      const Index3& low = snapshot_.min_index;
      return grid_.scale({inside(v.x, low.x), inside(v.y, low.y), inside(v.z, low.z)}) != scale_;
    });
    if (!config_.where) return;
    std::erase_if(occupied_, [&](const auto& at) {
      const Index3 voxel = offset_voxel(bricks_.origin(at.first), at.second);
      const Eigen::Vector3d center = Eigen::Vector3d(voxel.x, voxel.y, voxel.z).array() + 0.5;
      return !config_.where(grid_.T_world_grid() * Eigen::Vector3d(center * voxel_size_));
    });
  }

  void make_seeds(std::size_t begin, std::size_t end) {
    HitMoments moments(lengths_.normal_radius);
    BrickNeighborhood around(bricks_, occupied_[begin].first);
    for (std::size_t i = begin; i < end; ++i) {
      const auto [brick, offset] = occupied_[i];
      if (i == begin || brick != occupied_[i - 1].first) {
        around = BrickNeighborhood(bricks_, brick);
        moments.look_at(around, bricks_.origin(brick));
      }
      const Index3 voxel = offset_voxel(bricks_.origin(brick), offset);
      const PlacedBelief& own = *bricks_.find(brick, offset);
      Seed& seed = seeds_[i];
      seed.normal = local_normal(moments.round(offset, own.toward_free));
      const double along = seed.normal.dot(own.toward_free);
      seed.has_side = along != 0;
      if (along < 0) seed.normal = -seed.normal;
      const Eigen::Vector3d center = Eigen::Vector3d(voxel.x, voxel.y, voxel.z).array() + 0.5;
      seed.position = center + own.mean;
      seed.information = own.information;
      seed.covariance = own.covariance;
      seed.hits = own.hits;
      if (pooled_ && around.is_near(seed.position)) {
        // Noise assigns readings from some distance to a voxel: the mean of a few can lie so far
        // from the surface that a column around it would miss the surface.
        seed.position = center + own.mean.cwiseMax(-0.5).cwiseMin(0.5);
        pool_column(bricks_, around, voxel_size_, own, config_, lengths_.column_radius, seed);
      }
      seed.is_near = around.is_near(seed.position);
    }
  }

  // Keeps seeds that have enough hits; of pooled ones those with support, thinned.
  void select() {
    kept_.resize(seeds_.size());
    std::iota(kept_.begin(), kept_.end(), std::size_t{0});
    std::erase_if(kept_, [&](std::size_t i) {
      return seeds_[i].hits < config_.min_hits || !seeds_[i].is_near;
    });
    std::vector<PooledPoint> pooled_points(pooled_ ? kept_.size() : 0);
    pool_.for_each_chunk(kept_.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        Seed& seed = seeds_[kept_[k]];
        // A pooled point keeps the side of its pooling, wherever it ends up in a thin wall.
        if (!seed.has_side) {
          const BrickNeighborhood around(bricks_, occupied_[kept_[k]].first);
          if (seed.normal.dot(around.free_side(seed.position)) < 0) seed.normal = -seed.normal;
        }
        if (pooled_) {
          pooled_points[k] = {seed.position, seed.normal, evidence(seed, column_area_), seed.hits};
        }
      }
    });
    if (!pooled_) return;
    // Before thinning, so that no point is removed because of a removed one.
    const std::vector<std::uint8_t> good = well_supported(pooled_points, lengths_.support_radius,
                                                          config_.min_relative_evidence, pool_);
    keep(kept_, good);
    keep(pooled_points, good);
    std::vector<std::uint8_t> stays(kept_.size());
    const double cover = std::max(unit_, lengths_.min_distance);
    for (const std::size_t k : thinned(pooled_points, lengths_.min_distance, cover, pool_)) {
      stays[k] = 1;
    }
    keep(kept_, stays);
  }

  [[nodiscard]] FusedPoint point_of(const Seed& seed) const {
    const Pose& T_world_grid = grid_.T_world_grid();
    const Eigen::Matrix3d R = T_world_grid.rotation();
    const Eigen::Vector3d p = T_world_grid * (seed.position * voxel_size_);
    const Eigen::Vector3d n = R * seed.normal;
    const double floor = config_.floor_sigma.value_or(voxel_size_ / std::sqrt(12.0));
    const double F = pooled_ && !config_.floor_sigma
                         ? pooled_floor(seed, evidence(seed, column_area_), voxel_size_)
                         : floor * floor;
    Eigen::Matrix3d covariance = R * seed.covariance.matrix() * R.transpose() +
                                 Eigen::Matrix3d(Eigen::Vector3d::Constant(F).asDiagonal());
    if (config_.scale_sigma > 0) {
      const Eigen::Vector3d moves = config_.scale_sigma * mean_way(grid_.views(), p, n);
      covariance += moves * moves.transpose();
    }
    return {{p.x(), p.y(), p.z()},
            SymmetricMatrix3::from(covariance),
            {n.x(), n.y(), n.z()},
            seed.hits,
            pooling_.length};
  }

  const BeliefGrid& grid_;
  const GridSnapshot& snapshot_;
  const FusedPointsConfig& config_;
  int scale_;
  bool pooled_;
  Pooling pooling_;
  double voxel_size_;  // of the bricks [m]
  double unit_;        // pooling length [voxels of the bricks]
  Lengths lengths_;
  double column_area_;  // [m²]
  ThreadPool pool_;
  BeliefBricks bricks_;
  std::vector<std::pair<std::size_t, unsigned>> occupied_;
  std::vector<Seed> seeds_;  // of the occupied voxels
  std::vector<std::size_t> kept_;
};

constexpr int kMostShift = 3;  // cubes stay within a leaf

// Median sigma of a reading across its ray [m]; 0 without readings.
double footprint_in(const GridSnapshot& snapshot, std::optional<int> scale) {
  std::vector<float> variances;
  for (const GridSnapshot::Leaf& leaf : snapshot.leaves) {
    if (!leaf.beliefs || leaf.beliefs->scale != scale.value_or(leaf.beliefs->scale)) continue;
    std::size_t rank = 0;
    for_each_bit(leaf.beliefs->mask, [&](unsigned offset) {
      const Belief& belief = leaf.beliefs->beliefs[rank++];
      if (belief.hits == 0 || !test_bit(leaf.occupied, offset)) return;
      variances.push_back(
          static_cast<float>(detail::lateral_variance(belief.information_matrix(), belief.hits)));
    });
  }
  if (variances.empty()) return 0;
  const auto middle = variances.begin() + static_cast<std::ptrdiff_t>(variances.size() / 2);
  std::nth_element(variances.begin(), middle, variances.end());
  return std::sqrt(static_cast<double>(*middle));
}

}  // namespace

std::vector<FusedPoint> fused_points(const BeliefGrid& grid, const FusedPointsConfig& config,
                                     const ExecConfig& exec) {
  check(config);
  const GridSnapshot snapshot = grid.snapshot();
  const std::vector<BeliefBlockAt> blocks = belief_blocks(grid);
  std::array<bool, 4> is_there{};
  for (const BeliefBlockAt& block : blocks) is_there[block.beliefs->scale] = true;
  std::vector<FusedPoint> points;
  for (int scale = 0; scale < 4; ++scale) {
    if (!is_there[static_cast<std::size_t>(scale)]) continue;
    const std::vector<FusedPoint> part =
        ScalePoints(grid, snapshot, blocks, scale, config, exec).find();
    points.insert(points.end(), part.begin(), part.end());
  }
  return points;
}

Pooling pooling_of(const GridSnapshot& snapshot, std::optional<int> scale) {
  const double footprint = footprint_in(snapshot, scale);
  Pooling pooling{scale.value_or(0), std::ldexp(snapshot.voxel_size, scale.value_or(0))};
  while (pooling.shift < kMostShift && pooling.length * std::numbers::sqrt2 < footprint) {
    ++pooling.shift;
    pooling.length *= 2;
  }
  pooling.length = std::max(pooling.length, footprint);
  return pooling;
}

}  // namespace viewgain
