// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "surface_view.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <span>
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

// Tiles that wait for others, to be walked together.
struct SurfaceView::WaitingTiles {
  static constexpr std::size_t kMost = 2;
  std::array<RayTile, kMost> rays;
  std::array<std::size_t, kMost> numbers{};
  std::array<WalkTask, kMost> tasks;
  std::array<WalkedTile, kMost> walked;
  std::size_t count = 0;
};

template <typename Trace, typename Walked>
void SurfaceView::walk(const PoseFrame& frame, const float* missed, Trace&& trace,
                       Walked&& walked) const {
  const WalkLimits limits = walk_limits(scene_, frame);
  WaitingTiles waiting;
  const auto walk = [&] {
    walk_.area(bricks_, limits, std::span(waiting.tasks).first(waiting.count), worth_, missed,
               waiting.walked.data());
    for (std::size_t i = 0; i < waiting.count; ++i) {
      walked(waiting.numbers[i], waiting.rays[i], waiting.walked[i]);
    }
    waiting.count = 0;
  };
  trace([&](std::size_t number, const RayTile& rays) {
    if (rays.hit == 0) return;
    set_up(tracer_.table(), number, frame, rays, waiting.tasks[waiting.count]);
    waiting.rays[waiting.count] = rays;
    waiting.numbers[waiting.count] = number;
    if (++waiting.count == WaitingTiles::kMost) walk();
  });
  walk();
}

template <typename Met>
double SurfaceView::trace(const PoseFrame& frame, Workspace& workspace, const float* missed,
                          std::uint32_t& hits, double* by_lane, Met&& met) const {
  const double V = scene_.snapshot.voxel_size;
  tracer_.prepare(frame, workspace.sweep);
  begin(workspace);
  if (!core_.config.weights.empty()) {
    return trace_shares(frame, workspace, hits, by_lane, met);
  }
  double sum = 0;  // [voxels²]
  walk(
      frame, missed, [&](auto&& visit) { trace_rays(frame, workspace, visit); },
      [&](std::size_t number, const RayTile& rays, WalkedTile& walked) {
        sum += area_of(rays, walked);
        if (by_lane != nullptr) {
          for_each_lane(rays.hit, [&](int lane) {
            by_lane[lane] += static_cast<double>(walked.area[lane]) * V * V;
          });
        }
        hits += static_cast<std::uint32_t>(std::popcount(walked.occupied));
        if (core_.config.model != GainModel::combined) return;
        for_each_lane(walked.occupied, [&](int lane) {
          const std::uint32_t place = add_refining(end_of(rays, walked, lane), workspace);
          met(number, rays, lane, walked.range[lane], place);
        });
        if (workspace.refining.batch.count >= kBatchSize) sum_refining(workspace);
      });
  sum_refining(workspace);
  return square_metres(sum);
}

void SurfaceView::walk_strip(const PoseFrame& frame, TileRows strip, ViewSweep& sweep,
                             std::vector<double>& areas, std::vector<RefiningEnd>& ends) const {
  areas.clear();
  ends.clear();
  walk(
      frame, nullptr,
      [&](auto&& visit) {
        tracer_.trace_strip<ViewTracer::Asked::along_rays>(frame, strip, sweep, visit);
      },
      [&](std::size_t, const RayTile& rays, WalkedTile& walked) {
        areas.push_back(area_of(rays, walked));
        for_each_lane(walked.occupied,
                      [&](int lane) { ends.push_back(end_of(rays, walked, lane)); });
      });
}

void SurfaceView::begin(Workspace& workspace) const {
  workspace.occupied.begin();
  workspace.refining.batch.count = 0;
}

void SurfaceView::add(const std::vector<RefiningEnd>& ends, Workspace& workspace) const {
  if (core_.config.model != GainModel::combined) return;
  for (const RefiningEnd& end : ends) {
    (void)add_refining(end, workspace);
    if (workspace.refining.batch.count >= kBatchSize) sum_refining(workspace);
  }
}

// The same with task weights, share by share.
template <typename Met>
double SurfaceView::trace_shares(const PoseFrame& frame, Workspace& workspace, std::uint32_t& hits,
                                 double* by_lane, Met&& met) const {
  double area = 0;
  for_each_share(frame, workspace,
                 [&](std::size_t number, const RayTile& rays, const SurfaceShare& share) {
                   area += share.area;
                   if (by_lane != nullptr) by_lane[share.lane] += share.area;
                   if (!share.is_occupied) return;
                   ++hits;
                   if (core_.config.model != GainModel::combined) return;
                   met(number, rays, share.lane, share.range,
                       workspace.occupied.add(share.voxel, share.information));
                 });
  return area;
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

void SurfaceView::close(Workspace& workspace, std::size_t parts) const {
  if (core_.config.model != GainModel::combined) return;
  sum_refining(workspace);
  RefiningHits& refining = workspace.refining;
  const std::uint32_t count = workspace.occupied.count();
  const std::size_t room = std::size_t{count} + parts * VoxelSums::kOverhang;
  if (refining.blocks.size() < room) {
    refining.blocks.resize(room), refining.offsets.resize(room), refining.members.resize(room);
    refining.known_a.resize(room), refining.known_b.resize(room), refining.each.resize(room);
  }
  const auto of = static_cast<std::uint32_t>(parts);
  for (std::uint32_t i = 0; i < of; ++i) {
    RefiningHits::Part& part = refining.parts[i];
    part.begin = count / of * i;
    part.end = i + 1 < of ? count / of * (i + 1) : count;
    part.at = part.begin + i * VoxelSums::kOverhang;
  }
}

void SurfaceView::finish(Workspace& workspace, std::size_t number) const {
  if (core_.config.model != GainModel::combined) return;
  OccupiedSums& occupied = workspace.occupied;
  RefiningHits& refining = workspace.refining;
  RefiningHits::Part& part = refining.parts[number];
  for (std::uint32_t place = part.begin; place < part.end; ++place) {
    const Index3 voxel = occupied.voxel(place);
    const std::size_t i = part.at + (place - part.begin);
    refining.blocks[i] = &pooled_->block(bricks_.leaf_of(voxel));
    refining.offsets[i] = block_offset(voxel);
  }
  const std::size_t at = part.at;
  gain_kernels_.look_up(&refining.blocks[at], &refining.offsets[at], part.end - part.begin,
                        &refining.known_a[at], &refining.known_b[at]);
  refining.keep_measured(part);
  gain_kernels_.finish_with_floor(prior_information_, floor_variance_,
                                  {occupied.sums(), &refining.members[at], &refining.known_a[at],
                                   &refining.known_b[at], part.measured},
                                  &refining.each[at]);
  for (std::size_t i = at; i < at + part.measured; ++i) {
    refining.each[i] = weight_of(occupied.voxel(refining.members[i])) *
                       PooledSurface::chance(refining.known_b[i].value[2]) * 0.5 *
                       std::log(refining.each[i]);
  }
}

void SurfaceView::end(const Workspace& workspace, std::size_t parts, double area,
                      std::uint32_t hits, ViewGain& result) const {
  result.hits = hits;
  result.area = result.gain = area;
  if (core_.config.model != GainModel::combined) return;
  const RefiningHits& refining = workspace.refining;
  double saturated = 0;
  for (std::size_t k = 0; k < parts; ++k) {
    const RefiningHits::Part& part = refining.parts[k];
    for (std::size_t i = part.at; i < part.at + part.measured; ++i) saturated += refining.each[i];
  }
  result.occupied_voxels = workspace.occupied.count();
  result.refinement_saturated = saturated;
  result.gain = nats_per_area_ * result.area + core_.config.refinement_weight * saturated;
}

void SurfaceView::evaluate(const PoseFrame& frame, Workspace& workspace, ViewGain& result,
                           const float* missed) const {
  std::uint32_t hits = 0;
  const double area = trace(frame, workspace, missed, hits, nullptr,
                            [](std::size_t, const RayTile&, int, float, std::uint32_t) {});
  close(workspace, 1);
  finish(workspace, 0);
  end(workspace, 1, area, hits, result);
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

}  // namespace viewgain::detail
