// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gain_kernels.hpp"
#include "ray_sample.hpp"
#include "scene/scene_data.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::detail {

/// Frontal sigmas of a sensor in the form the kernels take.
[[nodiscard]] FrontalSigmas frontal_sigmas(const Sensor& sensor);

[[nodiscard]] inline SymmetricMatrix3 matrix_of(const VoxelSum& m) {
  return {m.a[0], m.a[1], m.a[2], m.a[3], m.b[0], m.b[1]};
}

/// What the gain of a view depends on besides the scene and the hits.
struct GainSettings {
  Criterion criterion = Criterion::log_diagonal;
  double prior_information = 0;  ///< sigma_0⁻² [m⁻²]
  FrontalSigmas sigmas;
  std::vector<WeightRegion> weights;
  bool posterior_entropy = false;
};

/// Sums the hits of one view by voxel and turns the sums into a gain (raycast/README.md, "Gains").
/// One object serves one thread, view after view, except where it says so; it allocates when made
/// and when a view touches more voxels than any before.
class GainAccumulator {
 public:
  /// max_rays bounds the hits of one view. Scene and settings must outlive its use.
  GainAccumulator(const SceneData& scene, const GainSettings& settings, std::size_t max_rays);

  /// Goes over to another scene, with settings of the same criterion and as many weights; what it
  /// knew of the one before, which may be gone, is forgotten.
  void rebind(const SceneData& scene, const GainSettings& settings);

  void begin();
  /// Takes the hits of a traced tile.
  void add(const RayTile& tile) {
    if (tile.hit == 0) return;
    kernels_->append(tile, batch_);
    if (batch_.count >= kBatchSize) flush();
  }
  /// Takes hits that another thread has listed; at most kBatchSize.
  void add(const HitList& hits);
  /// Fills gain, exploration, refinement, posterior_entropy, hits and voxel counts.
  void finish(ViewGain& result) {
    close();
    finish(explored(), refined(), result);
  }

  /// finish() in parts: close() parts the touched voxels into unknown and occupied ones; then
  /// explored() and refined() may run on two threads at once.
  struct ClassGain {
    double gain = 0, posterior_entropy = 0;
  };
  void close();
  [[nodiscard]] ClassGain explored();
  [[nodiscard]] ClassGain refined();
  void finish(const ClassGain& explored, const ClassGain& refined, ViewGain& result) const;

  /// The same for some of a view's rays, which stand for all: instead of begin(), add() and
  /// finish(). `expected` has a number for each of the tile's hits, by lane: SampledVoxel's.
  void begin_sample();
  void add(const RayTile& tile, const float* expected);
  /// What the hits' voxels and those that they stand for gain; a ray stands for `rays_each`.
  void finish_sample(double rays_each, SampleTally& tally);

  /// Calls visit(key, known, sum, weight) for every voxel touched so far: its key, Λ_v of an
  /// occupied one (nothing: unknown), ΣΛ_r, w_v. In the same order for the same hits.
  template <typename Visit>
  void visit(Visit&& visit) {
    close();
    look_up();
    const auto call = [&](std::uint32_t place, const std::optional<VoxelSum>& known) {
      const std::uint32_t code = touched_[place];
      visit(blocks_[code >> 9U].key | (code & 511U), known, sums_[place],
            settings_->weights.empty() ? 1.0 : weight(code));
    };
    for (std::size_t i = 0; i < unknown_count_; ++i) call(unknown_[i], std::nullopt);
    for (std::size_t i = 0; i < occupied_count_; ++i) {
      const auto& a = known_a_[i].value;
      const auto& b = known_b_[i].value;
      call(occupied_[i], VoxelSum{{a[0], a[1], a[2], a[3]}, {b[0], b[1], b[2], b[3]}});
    }
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  // An 8³ block that the view has touched.
  struct Block {
    const SnapshotLeaf* leaf;  // never null
    std::uint64_t key;         // of the block's first voxel
  };
  // Where a block of a larger box is; void unless its generation is the view's.
  struct BlockSlot {
    std::uint64_t key = 0;
    std::uint32_t generation = 0;
    std::uint32_t block = 0;
  };

  // Of a sample, a hit an entry.
  struct SampledHit {
    std::uint32_t place;  // in the list of touched voxels
    std::uint32_t lane;
  };

  void flush();
  void count_hits();
  std::uint32_t code_of(std::uint32_t primitive, std::uint32_t offset);
  std::uint32_t block_in_box(std::uint64_t key);
  std::uint32_t start_block(std::uint64_t key, const SnapshotLeaf* leaf);
  void look_up();
  [[nodiscard]] ClassGain finish_class(std::span<const std::uint32_t> members, bool is_known,
                                       double* each) const;
  void spread(std::span<const std::uint32_t> members, bool is_known, double rays_each,
              SampleTally& tally);
  [[nodiscard]] double weight(std::uint32_t code) const;

  std::size_t max_rays_;
  const SceneData* scene_ = nullptr;
  const GainSettings* settings_ = nullptr;
  const GainKernels* kernels_ = nullptr;
  HitBatch batch_;
  // Touched blocks. Those that are primitives of their own are found by the primitive's number
  // (kNone: not touched), those of larger boxes by their key in an open-addressing table.
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> by_primitive_, touched_primitives_;
  std::vector<BlockSlot> by_key_;
  unsigned shift_ = 0;
  std::uint32_t generation_ = 0;
  // A voxel's code is block << 9 | offset; its place in the list of touched voxels, or kNone. Grows
  // to the most blocks that a view has touched.
  std::vector<std::uint32_t> places_;
  std::uint32_t hits_ = 0;
  // The touched voxels in the order in which the view first meets them, and their sums. All are
  // sized for the most that a view can touch.
  std::size_t touched_count_ = 0;
  std::vector<std::uint32_t> touched_;  // codes
  std::vector<VoxelSum> sums_;
  std::vector<std::uint32_t> unknown_, occupied_;  // places in touched_
  std::vector<const SnapshotLeaf*> occupied_leaf_;
  std::vector<std::uint32_t> occupied_offset_;
  std::size_t unknown_count_ = 0, occupied_count_ = 0;
  std::vector<MatrixHalf> known_a_, known_b_;  // of occupied_
  std::vector<double> each_;                   // for weights and for the trace
  // Of a sample: its hits, and of each touched voxel how many it stands for, then a hit's gain.
  bool is_sample_ = false;
  std::vector<SampledHit> sampled_;
  std::vector<double> copies_, sampled_each_;
};

}  // namespace viewgain::detail
