// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "surface_view.hpp"

#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

#include "from_behind.hpp"
#include "trace/scene_tracing.hpp"
#include "view_driver.hpp"
#include "viewgain/support/belief_block.hpp"

namespace viewgain::detail {
namespace {

// A surface point is made of the readings within a pooling length of it, and of so many at least
// (grid's fused points).
constexpr double kLeastReadings = 2.0;
// Readings that a voxel of new surface is counted with.
constexpr double kNewReadings = 3.0;

// ½ Σ_k ln [Λ⁻¹ + F]_kk
double entropy_with_floor(const SymmetricMatrix3& information, double floor_variance) {
  const SymmetricMatrix3 sigma = information.inverse();
  return 0.5 * std::log((sigma.xx + floor_variance) * (sigma.yy + floor_variance) *
                        (sigma.zz + floor_variance));
}

// ΔH_new: what readings from the working distance take off the point at a voxel if nothing is known
// around.
double entropy_of_new_voxel(const EvaluatorCore& core, double prior_information,
                            double floor_variance) {
  const MeasurementSigmas sigmas = core.frontal(core.working_distance);
  const SymmetricMatrix3 seen =
      measurement_information(Eigen::Vector3d::UnitZ(), sigmas) * kNewReadings;
  const auto prior = SymmetricMatrix3::identity(prior_information);
  return entropy_with_floor(prior, floor_variance) -
         entropy_with_floor(prior + seen, floor_variance);
}

}  // namespace

SurfaceView::SurfaceView(const SceneData& scene, const EvaluatorCore& core,
                         const ViewTracer& tracer, double prior_sigma)
    : scene_(scene),
      core_(core),
      tracer_(tracer),
      bricks_(scene.tracing->bricks()),
      walk_(walk_kernels(scene.tracing->kernels.isa)),
      gain_kernels_(gain_kernels(scene.tracing->kernels.isa)),
      pooled_(core.config.model == GainModel::combined ? &scene.tracing->pooled_surface()
                                                       : nullptr),
      frontal_(core.sigmas),
      reading_worth_(core.sigmas, core.working_distance, scene.snapshot.voxel_size),
      prior_information_(1.0 / (PooledSurface::kCells * prior_sigma * prior_sigma)) {
  const double V = scene.snapshot.voxel_size;
  const double stride = core.config.pixel_stride;
  const double radius = bricks_.pooling_length;
  const ReadingWorth& worth = reading_worth_;
  worth_ = {
      static_cast<float>(stride * stride * std::numbers::pi * radius * radius / kLeastReadings),
      static_cast<float>(worth.scale),
      static_cast<float>(worth.s0),
      static_cast<float>(worth.s1 * V),
      static_cast<float>(worth.s2 * V * V),
      static_cast<float>(worth.at / V)};
  floor_variance_ = PooledSurface::kCells * V * V;
  frontal_.p0 = frontal_.p2 = 0;  // as core's frontal(): readings that share a pose share its error
  nats_per_area_ = entropy_of_new_voxel(core, prior_information_, floor_variance_) / (V * V);
}

Index3 SurfaceView::voxel_at(std::int32_t x, std::int32_t y, std::int32_t z) const {
  const Index3& base = scene_.snapshot.min_index;
  return {x - bricks_.offset[0] + base.x, y - bricks_.offset[1] + base.y,
          z - bricks_.offset[2] + base.z};
}

SymmetricMatrix3 SurfaceView::information(const RayTile& rays, int lane, float range) const {
  const Eigen::Vector3d d(rays.dx[lane], rays.dy[lane], rays.dz[lane]);
  return measurement_information(
      d.normalized(), core_.frontal(static_cast<double>(range) * scene_.snapshot.voxel_size));
}

float SurfaceView::cosine_at(const RayTile& rays, int lane, Index3 at) const {
  const Eigen::Vector3f normal = bricks_.normal_at(at.x, at.y, at.z);
  return normal.x() * rays.dx[lane] + normal.y() * rays.dy[lane] + normal.z() * rays.dz[lane];
}

double SurfaceView::area_of(const RayTile& rays, WalkedTile& tile) const {
  for_each_lane(tile.occupied, [&](int lane) {
    if (!(tile.stretch_length[lane] >= FromBehind::kLeastStretch)) return;
    const float cosine = cosine_at(rays, lane, {tile.x[lane], tile.y[lane], tile.z[lane]});
    if (!(cosine > FromBehind::kLeastCosine)) return;
    // With a hazard of 0 throughout there is nowhere for the surface to be.
    const float chance = tile.stretch_chance[lane];
    const auto factor =
        static_cast<float>(FromBehind::area_over_across(static_cast<double>(cosine)));
    if (chance > 0) {
      tile.area[lane] += tile.stretch_all[lane] * factor / chance - tile.stretch_area[lane];
    }
    tile.passed[lane] = 0;
  });
  double sum = 0;
  for_each_lane(rays.hit, [&](int lane) { sum += static_cast<double>(tile.area[lane]); });
  return sum;
}

template <typename Met>
double SurfaceView::trace(const PoseFrame& frame, Workspace& workspace, const float* missed,
                          std::uint32_t& hits, double* by_lane, Met&& met) const {
  const bool refines = core_.config.model == GainModel::combined;
  const double V = scene_.snapshot.voxel_size;
  tracer_.prepare(frame, workspace.sweep);
  OccupiedSums& occupied = workspace.occupied;
  occupied.begin();
  RefiningHits& refining = workspace.refining;
  refining.batch.count = 0;
  if (!core_.config.weights.empty()) {
    double area = 0;
    for_each_share(
        frame, workspace, [&](std::size_t number, const RayTile& rays, const SurfaceShare& share) {
          area += share.area;
          if (by_lane != nullptr) by_lane[share.lane] += share.area;
          if (!share.is_occupied) return;
          ++hits;
          if (!refines) return;
          met(number, rays, share.lane, share.range, occupied.add(share.voxel, share.information));
        });
    return area;
  }
  double sum = 0;  // [voxels²]
  const WalkLimits limits = walk_limits(scene_, frame);
  WalkTask task;
  WalkedTile walked;
  trace_rays(frame, workspace, [&](std::size_t number, const RayTile& rays) {
    if (rays.hit == 0) return;
    set_up(tracer_.table(), number, frame, rays, task);
    walk_.area(bricks_, limits, task, worth_, missed, walked);
    sum += area_of(rays, walked);
    if (by_lane != nullptr) {
      for_each_lane(rays.hit, [&](int lane) {
        by_lane[lane] += static_cast<double>(walked.area[lane]) * V * V;
      });
    }
    hits += static_cast<std::uint32_t>(std::popcount(walked.occupied));
    if (!refines) return;
    HitBatch& batch = refining.batch;
    for_each_lane(walked.occupied, [&](int lane) {
      const std::size_t i = batch.count++;
      batch.dx[i] = rays.dx[lane], batch.dy[i] = rays.dy[lane], batch.dz[i] = rays.dz[lane];
      batch.range[i] = walked.range[lane];
      refining.passed[i] = walked.passed[lane];
      bool is_new = false;
      refining.places[i] =
          occupied.place_of(voxel_at(walked.x[lane], walked.y[lane], walked.z[lane]), is_new);
      refining.keep[i] = is_new ? 0 : ~std::uint64_t{0};
      met(number, rays, lane, walked.range[lane], refining.places[i]);
    });
    if (batch.count >= kBatchSize) sum_refining(workspace);
  });
  sum_refining(workspace);
  return sum * V * V;
}

// Λ_r of the hits that wait, each times its ray's T, into the sums.
void SurfaceView::sum_refining(Workspace& workspace) const {
  RefiningHits& refining = workspace.refining;
  HitBatch& batch = refining.batch;
  gain_kernels_.expand(frontal_, scene_.snapshot.voxel_size, batch);
  for (std::size_t i = 0; i < batch.count; ++i) {
    const auto passed = static_cast<double>(refining.passed[i]);
    for (double& part : batch.information_a[i]) part *= passed;
    for (double& part : batch.information_b[i]) part *= passed;
  }
  gain_kernels_.accumulate(batch, refining.places, refining.keep, workspace.occupied.sums());
  batch.count = 0;
}

double SurfaceView::saturated_gain(Workspace& workspace) const {
  OccupiedSums& occupied = workspace.occupied;
  RefiningHits& refining = workspace.refining;
  const std::uint32_t count = occupied.count();
  const std::size_t room = std::size_t{count} + VoxelSums::kOverhang;
  if (refining.blocks.size() < room) {
    refining.blocks.resize(room), refining.offsets.resize(room), refining.members.resize(room);
    refining.known_a.resize(room), refining.known_b.resize(room), refining.each.resize(room);
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const Index3 voxel = occupied.voxel(i);
    refining.blocks[i] = &pooled_->block(bricks_.leaf_of(voxel));
    refining.offsets[i] = block_offset(voxel);
  }
  gain_kernels_.look_up(refining.blocks.data(), refining.offsets.data(), count,
                        refining.known_a.data(), refining.known_b.data());
  const std::uint32_t measured = refining.keep_measured(count);
  gain_kernels_.finish_with_floor(prior_information_, floor_variance_,
                                  {occupied.sums(), refining.members.data(),
                                   refining.known_a.data(), refining.known_b.data(), measured},
                                  refining.each.data());
  double sum = 0;
  for (std::uint32_t i = 0; i < measured; ++i) {
    sum += weight_of(occupied.voxel(refining.members[i])) *
           PooledSurface::chance(refining.known_b[i].value[2]) * 0.5 * std::log(refining.each[i]);
  }
  return sum;
}

void SurfaceView::evaluate(const PoseFrame& frame, Workspace& workspace, ViewGain& result,
                           const float* missed) const {
  result.hits = 0;
  result.area = result.gain = trace(frame, workspace, missed, result.hits, nullptr,
                                    [](std::size_t, const RayTile&, int, float, std::uint32_t) {});
  if (core_.config.model != GainModel::combined) return;
  result.occupied_voxels = workspace.occupied.count();
  result.refinement_saturated = saturated_gain(workspace);
  result.gain =
      nats_per_area_ * result.area + core_.config.refinement_weight * result.refinement_saturated;
}

double SurfaceView::expected_hits(std::size_t number, const RayTile& rays, int lane, float range,
                                  Index3 voxel) const {
  // Unknown voxels do not hide what is behind them.
  const auto is_exposed = [&](Index3 beside) {
    const GridSnapshot::Leaf* leaf = scene_.snapshot.find_leaf(beside);
    return leaf == nullptr || !test_bit(leaf->occupied, block_offset(beside));
  };
  const auto before = [](float d) { return d > 0 ? -1 : 1; };
  const float dx = rays.dx[lane], dy = rays.dy[lane], dz = rays.dz[lane];
  const float all = std::abs(dx) + std::abs(dy) + std::abs(dz);
  float exposed = 0;
  if (is_exposed({voxel.x + before(dx), voxel.y, voxel.z})) exposed += std::abs(dx);
  if (is_exposed({voxel.x, voxel.y + before(dy), voxel.z})) exposed += std::abs(dy);
  if (is_exposed({voxel.x, voxel.y, voxel.z + before(dz)})) exposed += std::abs(dz);
  const auto ray = number * kTileRays + static_cast<std::size_t>(lane);
  return static_cast<double>((exposed > 0 ? exposed : all) /
                             (range * range * tracer_.table().solid_angle[ray]));
}

void SurfaceView::sample(const PoseFrame& frame, Workspace& workspace, double rays_each,
                         SampleTally& tally) const {
  const OccupiedSums& occupied = workspace.occupied;
  std::vector<SampledEnd>& ends = workspace.sampled_ends;
  ends.clear();
  std::uint32_t hits = 0;
  // The rays' solid angles are those of what they stand for, so areas add up to the whole.
  const double area = trace(
      frame, workspace, nullptr, hits, tally.by_lane.data(),
      [&](std::size_t number, const RayTile& rays, int lane, float range, std::uint32_t place) {
        ends.push_back(
            {place, lane, expected_hits(number, rays, lane, range, occupied.voxel(place))});
      });
  tally.gain = area;
  if (core_.config.model != GainModel::combined) return;
  tally.gain *= nats_per_area_;
  for (double& gain : tally.by_lane) gain *= nats_per_area_;
  // A voxel's rays, and the sum of 1 / expected, which is then what a ray gains.
  struct Voxel {
    double hits = 0, share = 0;
  };
  std::vector<Voxel> voxels(occupied.count());
  for (const SampledEnd& end : ends) {
    voxels[end.place].hits += 1;
    voxels[end.place].share += 1 / end.expected;
  }
  for (std::uint32_t i = 0; i < occupied.count(); ++i) {
    Voxel& voxel = voxels[i];
    const double expected = voxel.hits / voxel.share;
    const SampledVoxel stands(voxel.hits, expected, rays_each);
    const double gain =
        core_.config.refinement_weight * stands.copies *
        saturated_gain(occupied.voxel(i), occupied.information(i) * stands.rays_per_hit);
    tally.add(gain, voxel.hits, expected);
    voxel.share = gain / voxel.hits;
  }
  for (const SampledEnd& end : ends) {
    tally.by_lane[static_cast<std::size_t>(end.lane)] += voxels[end.place].share;
  }
}

double SurfaceView::saturated_gain(Index3 voxel, const SymmetricMatrix3& information) const {
  const BeliefBlock& block = pooled_->block(bricks_.leaf_of(voxel));
  const Belief* belief = block.find(block_offset(voxel));
  if (belief == nullptr) return 0;
  const SymmetricMatrix3 before = SymmetricMatrix3::identity(prior_information_) +
                                  belief->information_matrix() * surface_share(block.scale);
  return weight_of(voxel) * PooledSurface::chance(belief->hits) *
         (entropy_with_floor(before, floor_variance_) -
          entropy_with_floor(before + information, floor_variance_));
}

void SurfaceView::find_visits(const PoseFrame& frame, std::size_t number, const RayTile& rays,
                              Workspace& workspace) const {
  WalkTask task;
  set_up(tracer_.table(), number, frame, rays, task);
  std::vector<VoxelVisit>& mixed = workspace.mixed_visits;
  mixed.clear();
  walk_.visits(bricks_, walk_limits(scene_, frame), task, mixed);
  // A packet's rays take turns; each ray's visits are in order, and stay so.
  std::array<std::size_t, kTileRays> place{};
  for (const VoxelVisit& visit : mixed) ++place[visit.lane];
  std::size_t sum = 0;
  for (std::size_t& p : place) sum += std::exchange(p, sum);
  workspace.visits.resize(mixed.size());
  for (const VoxelVisit& visit : mixed) workspace.visits[place[visit.lane]++] = visit;
}

void SurfaceView::find_shares(const PoseFrame& frame, std::size_t number, const RayTile& rays,
                              Workspace& workspace, SharesOf of) const {
  find_visits(frame, number, rays, workspace);
  const double V = scene_.snapshot.voxel_size;
  const int shift = bricks_.rate_shift;
  const std::vector<GainConfig::WeightRegion>& weights = core_.config.weights;
  double passed = 1.0;
  // The stretch of unknown voxels that the ray is in: its first share, where it begins, T there,
  // what of T ends in it.
  std::size_t stretch = 0;
  float stretch_begin = 0;
  double stretch_passed = 1.0, stretch_share = 0;
  const auto same_run = [&](const VoxelVisit& a, const VoxelVisit& b) {
    return a.lane == b.lane && a.state == b.state && a.end == b.begin &&
           a.x >> shift == b.x >> shift && a.y >> shift == b.y >> shift &&
           a.z >> shift == b.z >> shift;
  };
  const auto& visits = workspace.visits;
  std::vector<double>& areas = workspace.share_areas;
  areas.clear();
  for (auto first = visits.begin(), last = first; first != visits.end(); first = last) {
    const bool is_new_ray = first == visits.begin() || first->lane != (first - 1)->lane;
    const bool follows_on = !is_new_ray && first->begin == (first - 1)->end;
    if (is_new_ray) passed = 1.0;
    last = first + 1;
    const int lane = static_cast<int>(first->lane);
    if (first->state == BrickTable::kOccupiedVoxel) {
      const bool is_hidden =
          follows_on && first->begin - stretch_begin >= FromBehind::kLeastStretch;
      const float cosine = is_hidden ? cosine_at(rays, lane, {first->x, first->y, first->z}) : 0.0F;
      if (cosine > FromBehind::kLeastCosine) {
        const double chance = stretch_passed > 0 ? stretch_share / stretch_passed : 0;
        const double factor = FromBehind::area_over_across(static_cast<double>(cosine)) / chance;
        for (std::size_t i = stretch; chance > 0 && i < workspace.shares.size(); ++i) {
          workspace.shares[i].probability /= chance;
          workspace.shares[i].area = areas[i] * factor;
        }
        passed = 0;
      }
      SurfaceShare share{lane, first->begin, voxel_at(first->x, first->y, first->z),
                         true, passed,       0.0};
      if (core_.config.model == GainModel::combined) {
        share.information = information(rays, lane, first->begin) * passed;
      }
      workspace.shares.push_back(share);
      areas.push_back(0);
      continue;
    }
    if (!follows_on) {
      stretch = workspace.shares.size();
      stretch_begin = first->begin;
      stretch_passed = passed;
      stretch_share = 0;
    }
    while (last != visits.end() && same_run(*(last - 1), *last)) ++last;
    const double begin = static_cast<double>(first->begin),
                 end = static_cast<double>((last - 1)->end);
    const double rate = std::abs(static_cast<double>(first->rate));
    const double depth = rate * (end - begin);
    const double P = passed * -std::expm1(-depth);
    const double t = 0.5 * (begin + end);
    const auto angle =
        static_cast<double>(tracer_.table().solid_angle[number * kTileRays + first->lane]);
    const double across =
        std::min(angle * t * t, static_cast<double>(worth_.cap)) * reading_worth_(t * V);
    const auto put = [&](Index3 voxel, float from, double part, double weight, bool is_new) {
      const double area = part * across * weight * V * V;
      areas.push_back(area);
      workspace.shares.push_back({lane, from, voxel, false, part, is_new ? area : 0.0, {}, rate});
    };
    double weight_of_run = weights.empty() ? 1.0 : 0.0;
    for (auto visit = first; visit != last; ++visit) {
      const double of_run =
          (static_cast<double>(visit->end) - static_cast<double>(visit->begin)) / (end - begin);
      const Index3 voxel = voxel_at(visit->x, visit->y, visit->z);
      if (of == SharesOf::voxels) {
        put(voxel, visit->begin, P * of_run, weight_of(voxel), !std::signbit(visit->rate));
      } else if (!weights.empty()) {
        weight_of_run += of_run * weight_of(voxel);
      }
    }
    if (of == SharesOf::runs) {
      put(voxel_at(first->x, first->y, first->z), first->begin, P, weight_of_run,
          !std::signbit(first->rate));
    }
    passed *= std::exp(-depth);
    stretch_share += P;
  }
}

}  // namespace viewgain::detail
