// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "gain_accumulator.hpp"
#include "idle_list.hpp"
#include "occupied_sums.hpp"
#include "trace/ordered_walk.hpp"
#include "trace/sensor_rays.hpp"
#include "trace/view_sweep.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/thread_pool.hpp"
#include "viewgain/support/view_rays.hpp"

namespace viewgain::detail {

/// Frontal sigmas of a sensor in the form the kernels take.
[[nodiscard]] FrontalSigmas frontal_sigmas(const Sensor& sensor);

/// A voxel that a ray may end in, and what the ray would show there.
struct SurfaceShare {
  int lane;     ///< the ray's, in its tile
  float range;  ///< where the ray enters [voxels]
  Index3 voxel;
  bool is_occupied;
  double probability;              ///< P; occupied: T
  double area;                     ///< P min(ω t², cap) w_v where surface is new, else 0 [m²]
  SymmetricMatrix3 information{};  ///< occupied, combined: T Λ_r [m⁻²]
  double rate = 0;                 ///< unknown: of its hazard cell [1/voxel]
};

/// A ray of a sample that ends in an occupied voxel.
struct SampledEnd {
  std::uint32_t place;  ///< of its voxel in OccupiedSums
  int lane;
  double expected;  ///< SampledVoxel's
};

/// Of a sample by the paper's gain.
struct SampleScratch {
  std::vector<SampledHit> hits;
  std::vector<double> gain_per_hit;  ///< by a voxel's place
  std::vector<double> copies,
      each;  ///< of the voxels of one class: SampledVoxel's, what each gains
};

/// What a thread needs for a view. Serves the views of any scene, one after another.
struct Workspace {
  ViewSweep sweep;
  std::vector<ViewMeasure::Hit> view_hits;  ///< for a gain of the user's own
  std::vector<RunMeasure::Run> view_runs;
  SampleScratch sample;
  OccupiedSums occupied;  ///< these seven for the surface gain
  VoxelPlaces cells;      ///< that a view reaches, of hazard or voxels
  RefiningHits refining;
  std::vector<SampledEnd> sampled_ends;
  std::vector<VoxelVisit> mixed_visits, visits;
  std::vector<SurfaceShare> shares;
  std::unique_ptr<ViewScratch> scratch;        ///< of a gain that walks rays itself
  std::optional<GainAccumulator> accumulator;  ///< made when first needed
  std::uint64_t bound_to = 0;                  ///< number of the driver whose scene it sums for
};

/// A view's strips, which any thread may trace; their hits are added up in order.
struct ViewStrips {
  struct Hits {
    std::vector<HitList> lists;
    std::size_t count = 0;  ///< of lists that are in use
  };
  explicit ViewStrips(std::size_t strips) : hits(strips), is_traced(strips) {}
  std::vector<Hits> hits;  ///< of each strip
  std::vector<std::atomic<bool>> is_traced;
  std::atomic<std::size_t> next{0};  ///< to be traced
};

/// What the evaluators of one sensor and configuration share, whatever their scenes: rays, threads
/// and what threads work in. Thread safe.
struct EvaluatorCore {
  GainConfig config;
  FrontalSigmas sigmas;
  double working_distance;      ///< the sensor's [m]
  double min_range, max_range;  ///< along the ray [m]
  ExecConfig::Tracer tracer;    ///< of all views, samples of them too
  std::shared_ptr<const SensorRays> rays;
  std::uint32_t ray_count = 0;  ///< of the rays that a lens has
  ThreadPool pool;
  IdleList<Workspace> workspaces;
  IdleList<ViewStrips> view_strips;
  std::atomic<std::uint64_t> drivers{0};  ///< made so far

  /// Throws Error(invalid_argument), naming the value, as GainEvaluator's constructor.
  EvaluatorCore(const Sensor& sensor, const GainConfig& gain_config, const ExecConfig& exec);
  /// The same with some of the rays. Has no threads of its own unless it is given some.
  EvaluatorCore(const EvaluatorCore& full, const RayLattice& lattice, int num_threads = 1);

  /// The sensor's sigmas at range t [m], frontal.
  [[nodiscard]] MeasurementSigmas frontal(double t) const {
    t = std::max(t, kMinNoiseRange);
    return {sigmas.a0 + sigmas.a1 * t + sigmas.a2 * (t - sigmas.v) * (t - sigmas.v),
            sigmas.l0 + sigmas.l1 * t};
  }

  /// sigma_0 [m] in a scene. Throws Error(invalid_argument) unless it is in 1e-6..1e3.
  [[nodiscard]] double prior_sigma_in(const VoxelScene& scene) const;
};

}  // namespace viewgain::detail
