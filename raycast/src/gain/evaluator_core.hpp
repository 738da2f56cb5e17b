// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "gain_kernels.hpp"
#include "trace/ordered_walk.hpp"
#include "trace/sensor_rays.hpp"
#include "trace/view_sweep.hpp"
#include "viewgain/core/covariance.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/grid/voxel.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/thread_pool.hpp"
#include "viewgain/support/view_rays.hpp"
#include "voxel_sums.hpp"

namespace viewgain::detail {

/// Numbers the voxels that a view meets, in the order in which it first meets them. Serves view
/// after view; allocates when a view meets more voxels than any before.
class VoxelPlaces {
 public:
  void begin() {
    count_ = 0;
    if (++generation_ == 0) {  // after 2^32 views old stamps would look new
      for (Slot& slot : slots_) slot.generation = 0;
      generation_ = 1;
    }
  }
  /// The voxel's place, and whether it is met for the first time.
  std::uint32_t of(Index3 voxel, bool& is_new) {
    if (2 * count_ >= slots_.size()) grow();
    Slot& slot = slot_of(voxel);
    is_new = slot.generation != generation_;
    if (is_new) {
      slot = {voxel, generation_, count_};
      voxels_[count_++] = voxel;
    }
    return slot.place;
  }
  [[nodiscard]] std::uint32_t count() const { return count_; }
  /// How many places there are before it allocates again.
  [[nodiscard]] std::size_t capacity() const { return voxels_.size(); }
  [[nodiscard]] Index3 voxel(std::uint32_t place) const { return voxels_[place]; }

 private:
  struct Slot {
    Index3 voxel;
    std::uint32_t generation = 0;  // void unless it is the view's
    std::uint32_t place = 0;
  };

  // Fibonacci hashing of cubes of 2³ voxels, whose slots are neighbours as a ray's voxels are;
  // linear probing; the table is at most half full.
  [[nodiscard]] Slot& slot_of(Index3 v) {
    const auto bits = [](std::int32_t i) { return static_cast<std::uint32_t>(i); };
    const std::uint64_t cube = (static_cast<std::uint64_t>(bits(v.x >> 1)) << 42U) ^
                               (static_cast<std::uint64_t>(bits(v.y >> 1)) << 21U) ^ bits(v.z >> 1);
    const auto in_cube = static_cast<std::size_t>((v.x & 1) << 2 | (v.y & 1) << 1 | (v.z & 1));
    std::size_t at =
        static_cast<std::size_t>((cube * 0x9E3779B97F4A7C15ULL) >> (shift_ + 3)) << 3U | in_cube;
    while (slots_[at].generation == generation_ && !(slots_[at].voxel == v)) {
      at = (at + 1) & (slots_.size() - 1);
    }
    return slots_[at];
  }
  void grow() {
    slots_.assign(slots_.empty() ? 1024 : 2 * slots_.size(), Slot{});
    shift_ = 64U;
    for (std::size_t size = slots_.size(); size > 1; size /= 2) --shift_;
    for (std::uint32_t i = 0; i < count_; ++i) slot_of(voxels_[i]) = {voxels_[i], generation_, i};
    voxels_.resize(slots_.size());
  }

  std::uint32_t count_ = 0;
  std::vector<Index3> voxels_;
  std::vector<Slot> slots_;
  unsigned shift_ = 64;
  std::uint32_t generation_ = 0;
};

/// Σ T Λ_r of the occupied voxels in which a view's rays end, each at a *place*.
class OccupiedSums {
 public:
  void begin() { places_.begin(); }
  /// The voxel's place; of a new one, whose sum is not set yet, too.
  std::uint32_t place_of(Index3 voxel, bool& is_new) {
    const std::uint32_t place = places_.of(voxel, is_new);
    if (sums_.size() < places_.capacity()) sums_.resize(places_.capacity());
    return place;
  }
  /// Adds to the voxel's sum; returns its place.
  std::uint32_t add(Index3 voxel, const SymmetricMatrix3& m) {
    bool is_new = false;
    const std::uint32_t place = place_of(voxel, is_new);
    VoxelSum& sum = sums_[place];
    const SymmetricMatrix3 whole = is_new ? m : matrix_of(sum) + m;
    sum = {{whole.xx, whole.yy, whole.zz, whole.xy}, {whole.xz, whole.yz, 0, 0}};
    return place;
  }

  [[nodiscard]] std::uint32_t count() const { return places_.count(); }
  [[nodiscard]] Index3 voxel(std::uint32_t place) const { return places_.voxel(place); }
  [[nodiscard]] SymmetricMatrix3 information(std::uint32_t place) const {
    return matrix_of(sums_[place]);
  }
  /// By place; the kernels add to them.
  [[nodiscard]] VoxelSum* sums() { return sums_.data(); }

 private:
  VoxelPlaces places_;
  std::vector<VoxelSum> sums_;
};

/// A ray that ends in an occupied voxel.
struct RefiningEnd {
  float dx, dy, dz;
  float range;   ///< [voxels]
  float passed;  ///< T
  Index3 voxel;
};

/// Rays that end in occupied voxels, on their way into the sums.
struct RefiningHits {
  HitBatch batch;
  float passed[HitList::kCapacity];  ///< T of each
  std::uint32_t places[HitList::kCapacity];
  std::uint64_t keep[HitList::kCapacity];  ///< as GainKernels::accumulate() has it
  // What the gain is made of, by place.
  std::vector<const BeliefBlock*> blocks;
  std::vector<std::uint32_t> offsets, members;
  std::vector<MatrixHalf> known_a, known_b;
  std::vector<double> each;

  /// Threads refine different parts of the voxels. Each part has its own range in the arrays by
  /// place.
  static constexpr std::size_t kMostParts = 2;
  struct Part {
    std::uint32_t begin = 0, end = 0;  ///< places
    std::size_t at = 0;                ///< of the first in the arrays
    std::uint32_t measured = 0;        ///< how many have a reading
  };
  std::array<Part, kMostParts> parts;

  /// Keeps those of a part's voxels that have a reading: what has none, as in a map of labels, is
  /// not refined.
  void keep_measured(Part& part) {
    part.measured = 0;
    for (std::uint32_t place = part.begin; place < part.end; ++place) {
      const std::size_t from = part.at + (place - part.begin), to = part.at + part.measured;
      if (known_b[from].value[2] == 0) continue;
      members[to] = place;
      known_a[to] = known_a[from];
      known_b[to] = known_b[from];
      ++part.measured;
    }
  }
};

/// Objects that no call is using, so that a call need not make one. Thread safe.
template <typename T>
class IdleList {
 public:
  /// Null if there is none.
  [[nodiscard]] std::unique_ptr<T> take() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return nullptr;
    std::unique_ptr<T> object = std::move(idle_.back());
    idle_.pop_back();
    return object;
  }
  void give_back(std::unique_ptr<T> object) noexcept {
    const std::lock_guard lock(mutex_);
    try {
      idle_.push_back(std::move(object));
    } catch (const std::bad_alloc&) {  // then the next call makes one
    }
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<T>> idle_;
};

/// Sums the hits of one view by voxel and turns the sums into the paper's gain (raycast/README.md,
/// "Gains").
class GainAccumulator : public VoxelSums {
 public:
  GainAccumulator(const SceneData& scene, const GainSettings& settings, std::size_t max_rays);

  /// Fills gain, exploration, refinement, posterior_entropy, hits and voxel counts.
  void finish(ViewGain& result) {
    close();
    finish(explored(), refined(), result);
  }

  /// finish() in parts: after close() explored(), of the unknown voxels, and refined(), of the
  /// occupied ones, may run on two threads at once.
  struct ClassGain {
    double gain = 0, posterior_entropy = 0;
  };
  [[nodiscard]] ClassGain explored();
  [[nodiscard]] ClassGain refined();
  void finish(const ClassGain& explored, const ClassGain& refined, ViewGain& result) const;

 private:
  [[nodiscard]] ClassGain gain_of(std::span<const std::uint32_t> members, const LogProduct& ratios,
                                  const LogProduct& posterior, const double* each) const;

  std::vector<double> each_;  // what voxels gain, unknown ones first; for weights and the trace
};

/// A voxel that a ray may end in, and what the ray would show there.
struct SurfaceShare {
  int lane;     ///< the ray's, in its tile
  float range;  ///< where the ray enters [voxels]
  Index3 voxel;
  bool is_occupied;
  double probability;  ///< P; occupied: T
  double area;         ///< P min(ω t², cap) ρ(t) w_v where surface is new, else 0 [m²]
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
  std::vector<double> share_areas;             ///< of each share, as if its surface were new [m²]
  std::unique_ptr<ViewScratch> scratch;        ///< of a gain that walks rays itself
  std::optional<GainAccumulator> accumulator;  ///< made when first needed
  std::uint64_t bound_to = 0;                  ///< number of the driver whose scene it sums for
};

/// A view's strips, which any thread may trace; what they meet is added up in order.
struct ViewStrips {
  struct Strip {
    std::vector<HitList> lists;  ///< by the paper's gain
    std::size_t list_count = 0;  ///< of lists that are in use
    std::vector<double> areas;  ///< by the other gains, of each tile that meets anything [voxels²]
    std::vector<RefiningEnd> ends;
  };
  explicit ViewStrips(std::size_t count) : strips(count), is_traced(count) {}
  std::vector<Strip> strips;
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
