// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "evaluator_core.hpp"
#include "reading_worth.hpp"
#include "scene/scene_data.hpp"
#include "trace/ordered_walk.hpp"
#include "trace/ray_tile.hpp"
#include "trace/view_tracer.hpp"
#include "voxel_sums.hpp"

namespace viewgain::detail {

/// How many voxels of a view a voxel stands for in which `hits` rays of a lattice end, and for how
/// many rays each of these hits does. `expected` is how many of the lattice's rays would end in it
/// if nothing stood before it: its exposed area over that of a lattice cell.
///
/// A voxel that is narrower than a cell is met by chance, one in `expected` times, and then by one
/// ray. A wider one is met for sure and stands for itself. But one in some voxels is partly hidden,
/// and is met less often than it should be: a single ray in a voxel that would take several tells
/// that others like it were missed.
struct SampledVoxel {
  double copies = 1;
  double rays_per_hit;

  SampledVoxel(double hits, double expected, double rays_each) : rays_per_hit(rays_each) {
    // All of the view's rays meet no more voxels than there are rays.
    expected = std::max(expected, 1 / rays_each);
    if (hits < 1.5) {
      copies = expected <= 1 ? 1 / expected : 1 + (kLoneHit - 1) * std::min(expected - 1, 1.0);
      rays_per_hit = std::max(1.0, rays_each * std::min(expected, 1.0));
    } else if (hits < 2.5) {
      copies = kTwoHits;
    }
  }

 private:
  // Fitted on maps of a room, see perf/results/choosing.md.
  static constexpr double kLoneHit = 1.6, kTwoHits = 1.15;
};

/// What a sample's rays gain.
struct SampleTally {
  /// By their place in the tile: sixteen lattices of every fourth ray and row.
  std::array<double, kTileRays> by_lane{};
  double gain = 0;
  double by_chance = 0;  ///< of the gain: voxels of under two cells, in which one ray ends
  double lone = 0;       ///< of the gain: larger ones in which one ray ends

  void add(double gained, double hits, double expected) {
    gain += gained;
    if (hits < 1.5) (expected < 2 ? by_chance : lone) += gained;
  }
};

/// The surface and the combined gain of views (raycast/README.md, "Gains"), for
/// the evaluator of one scene. Immutable; thread safe.
class SurfaceView {
 public:
  /// Scene and tracer must outlive it. Finds what the scene has not found yet, as its hazard.
  /// Throws Error(capacity), Error(backend), Error(invalid_argument).
  SurfaceView(const SceneData& scene, const EvaluatorCore& core, const ViewTracer& tracer,
              double prior_sigma);

  /// Fills in the gain of the view from an opened pose. `missed`: as WalkKernels::area() has it;
  /// nothing with weights.
  void evaluate(const PoseFrame& frame, Workspace& workspace, ViewGain& result,
                const float* missed = nullptr) const;

  /// The same in steps, for views whose strips are walked by many threads: walk_strip() by any;
  /// then begin(), add() for each strip in order, close(), finish() of each of some parts, which
  /// may run at once, and end(). Not with weights.
  ///
  /// `sweep` is prepared for the view. Fills the area of each tile that meets anything [voxels²]
  /// and the rays that end in occupied voxels.
  void walk_strip(const PoseFrame& frame, TileRows strip, ViewSweep& sweep,
                  std::vector<double>& areas, std::vector<RefiningEnd>& ends) const;
  void begin(Workspace& workspace) const;
  void add(const std::vector<RefiningEnd>& ends, Workspace& workspace) const;
  void close(Workspace& workspace, std::size_t parts) const;
  void finish(Workspace& workspace, std::size_t part) const;
  /// `area` [m²].
  void end(const Workspace& workspace, std::size_t parts, double area, std::uint32_t hits,
           ViewGain& result) const;
  [[nodiscard]] double square_metres(double square_voxels) const {
    return square_voxels * scene_.snapshot.voxel_size * scene_.snapshot.voxel_size;
  }

  /// The gain of a view of which the tracer's rays are a sample; each stands for `rays_each`, and
  /// counts in `tally` by itself.
  void sample(const PoseFrame& frame, Workspace& workspace, double rays_each,
              SampleTally& tally) const;

  /// A run is the part of a ray in the unknown voxels of one hazard cell.
  enum class SharesOf : std::uint8_t { voxels, runs };
  /// Calls visit(tile number, rays, SurfaceShare) for all rays: run by run, each at its first
  /// voxel, or voxel by voxel, a run's share split by length. `workspace`'s sweep is prepared for
  /// the view.
  template <SharesOf kOf = SharesOf::voxels, typename Visit>
  void for_each_share(const PoseFrame& frame, Workspace& workspace, Visit&& visit) const {
    trace_rays(frame, workspace, [&](std::size_t number, const RayTile& rays) {
      workspace.shares.clear();
      if (rays.hit != 0) find_shares(frame, number, rays, workspace, kOf);
      for (const SurfaceShare& share : workspace.shares) visit(number, rays, share);
    });
  }

  /// Calls visit(tile number, rays, visits) for the tiles whose rays meet anything: what they
  /// visit, each ray's in one piece and in order.
  template <typename Visit>
  void for_each_visited(const PoseFrame& frame, Workspace& workspace, Visit&& visit) const {
    trace_rays(frame, workspace, [&](std::size_t number, const RayTile& rays) {
      if (rays.hit == 0) return;
      find_visits(frame, number, rays, workspace);
      visit(number, rays, workspace.visits);
    });
  }
  /// The voxel at table coordinates.
  [[nodiscard]] Index3 voxel_at(std::int32_t x, std::int32_t y, std::int32_t z) const;

  /// What BrickTable has: hazard cells, and their places in `missed`.
  [[nodiscard]] const BrickTable& bricks() const { return bricks_; }
  /// Nats for one m² of new surface: ΔH_new / V².
  [[nodiscard]] double nats_per_area() const { return nats_per_area_; }
  /// w_v c_v [H_nF(Λ̄_v) - H_nF(Λ̄_v + information)] of an occupied voxel; by the
  /// combined gain only.
  [[nodiscard]] double saturated_gain(Index3 voxel, const SymmetricMatrix3& information) const;

 private:
  struct WaitingTiles;
  class ShareFinder;

  template <typename Visit>
  void trace_rays(const PoseFrame& frame, Workspace& workspace, Visit&& visit) const {
    tracer_.trace<ViewTracer::Asked::along_rays>(frame, workspace.sweep, visit);
  }

  /// Sums what all tiles meet: calls met(tile number, rays, lane, range, place in
  /// workspace.occupied) for each occupied voxel by the combined gain, and adds up in by_lane what
  /// new surface each lane shows [m²] unless it is null. Returns that of all [m²].
  template <typename Met>
  double trace(const PoseFrame& frame, Workspace& workspace, const float* missed,
               std::uint32_t& hits, double* by_lane, Met&& met) const;
  template <typename Met>
  double trace_shares(const PoseFrame& frame, Workspace& workspace, std::uint32_t& hits,
                      double* by_lane, Met&& met) const;
  /// Calls trace(visit) for tiles, and walked(tile number, rays, WalkedTile) for those that meet
  /// anything, in order.
  template <typename Trace, typename Walked>
  void walk(const PoseFrame& frame, const float* missed, Trace&& trace, Walked&& walked) const;
  [[nodiscard]] RefiningEnd end_of(const RayTile& rays, const WalkedTile& walked, int lane) const {
    return {rays.dx[lane],       rays.dy[lane],
            rays.dz[lane],       walked.range[lane],
            walked.passed[lane], voxel_at(walked.x[lane], walked.y[lane], walked.z[lane])};
  }
  /// Has a hit wait for sum_refining(). Returns the place of its voxel.
  static std::uint32_t add_refining(const RefiningEnd& end, Workspace& workspace) {
    RefiningHits& refining = workspace.refining;
    HitBatch& batch = refining.batch;
    const std::size_t i = batch.count++;
    batch.dx[i] = end.dx, batch.dy[i] = end.dy, batch.dz[i] = end.dz;
    batch.range[i] = end.range;
    refining.passed[i] = end.passed;
    bool is_new = false;
    refining.places[i] = workspace.occupied.place_of(end.voxel, is_new);
    refining.keep[i] = is_new ? 0 : ~std::uint64_t{0};
    return refining.places[i];
  }
  /// How many of the tracer's rays would end in an occupied voxel if nothing stood before it.
  [[nodiscard]] double expected_hits(std::size_t number, const RayTile& rays, int lane, float range,
                                     Index3 voxel) const;
  void sum_refining(Workspace& workspace) const;
  void find_visits(const PoseFrame& frame, std::size_t number, const RayTile& rays,
                   Workspace& workspace) const;
  void find_shares(const PoseFrame& frame, std::size_t number, const RayTile& rays,
                   Workspace& workspace, SharesOf of) const;
  /// w_v.
  [[nodiscard]] double weight_of(Index3 voxel) const {
    const std::vector<GainConfig::WeightRegion>& weights = core_.config.weights;
    return weights.empty() ? 1.0 : task_weight(weights, voxel, scene_.snapshot.voxel_size);
  }
  [[nodiscard]] double area_of(const RayTile& rays, WalkedTile& tile) const;
  /// Cosine of a ray to the outward normal of an occupied voxel, in table coordinates; 0: not
  /// known.
  [[nodiscard]] float cosine_at(const RayTile& rays, int lane, Index3 at) const;
  [[nodiscard]] SymmetricMatrix3 information(const RayTile& rays, int lane, float range) const;

  const SceneData& scene_;
  const EvaluatorCore& core_;
  const ViewTracer& tracer_;
  const BrickTable& bricks_;
  const WalkKernels& walk_;
  const GainKernels& gain_kernels_;
  const PooledSurface* pooled_;  // by the combined gain
  FrontalSigmas frontal_;
  ReadingWorth reading_worth_;
  PixelWorth worth_{};        // of a ray
  double prior_information_;  // Λ_0 / n
  double floor_variance_;     // n F
  double nats_per_area_;
};

}  // namespace viewgain::detail
