// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <ranges>
#include <span>
#include <vector>

#include "gain_kernels.hpp"
#include "scene/scene_data.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::detail {

/// w_v of a voxel: that of the last region that holds its centre, 1 outside all.
[[nodiscard]] inline double task_weight(const std::vector<GainConfig::WeightRegion>& regions,
                                        Index3 voxel, double voxel_size) {
  const Eigen::Vector3d center = voxel_center(voxel, voxel_size);
  for (const GainConfig::WeightRegion& region : std::views::reverse(regions)) {
    if (region.box.contains(center.x(), center.y(), center.z())) return region.weight;
  }
  return 1.0;
}

/// What the gain of a view depends on besides the scene and the hits.
struct GainSettings {
  Criterion criterion = Criterion::log_diagonal;
  double prior_information = 0;  ///< sigma_0⁻² [m⁻²]
  FrontalSigmas sigmas;
  std::vector<GainConfig::WeightRegion> weights;
  bool posterior_entropy = false;
};

/// A hit of a view of which only some rays are traced.
struct SampledHit {
  std::uint32_t place;  ///< of its voxel, see VoxelSums
  std::uint32_t lane;   ///< of its ray in the tile
};

/// The hits of one view, summed by voxel: ΣΛ_r of each voxel in which rays end.
///
/// A hit comes as a primitive of the scene and an offset in it. From there to its voxel's sum:
/// the touched block (a primitive's own, or one of a larger box), the code block << 9 | offset, and
/// by the code the voxel's *place* in the list of touched voxels, in the order in which the view
/// first meets them. close() parts these into unknown and occupied ones.
///
/// One object serves one thread, view after view; it allocates when made and when a view touches
/// more blocks than any before.
class VoxelSums {
 public:
  /// max_rays bounds the hits of one view. Scene and settings must outlive its use.
  VoxelSums(const SceneData& scene, const GainSettings& settings, std::size_t max_rays);

  /// Goes over to another scene, with settings of the same criterion and as many weights; what it
  /// knew of the one before, which may be gone, is forgotten.
  void rebind(const SceneData& scene, const GainSettings& settings);

  /// A new view. With `sample` its hits are listed there too, and counted by voxel: hits(place).
  void begin(std::vector<SampledHit>* sample = nullptr);
  /// Takes the hits of a traced tile.
  void add(const RayTile& tile) {
    if (tile.hit == 0) return;
    kernels_->append(tile, batch_);
    if (batch_.count >= kBatchSize) flush();
  }
  /// The same of a sample; `expected` has a number for each of the hits, by lane: SampledVoxel's.
  void add(const RayTile& tile, const float* expected);
  /// Takes hits that another thread has listed; at most kBatchSize.
  void add(const HitList& hits);
  /// No more hits: parts the touched voxels into unknown and occupied ones.
  void close();

  /// Places of the touched voxels of a class, once closed; readable up to kOverhang beyond the end.
  [[nodiscard]] std::span<const std::uint32_t> unknown() const {
    return {unknown_.data(), unknown_count_};
  }
  [[nodiscard]] std::span<const std::uint32_t> occupied() const {
    return {occupied_.data(), occupied_count_};
  }
  [[nodiscard]] std::uint32_t hit_count() const { return hits_; }
  [[nodiscard]] std::size_t voxel_count() const { return touched_count_; }
  /// Of the voxel at a place.
  [[nodiscard]] VoxelSum& sum(std::uint32_t place) { return sums_[place]; }
  [[nodiscard]] double weight(std::uint32_t place) const;
  /// How many of a sample's hits it has, and how many are to be expected.
  [[nodiscard]] double hits(std::uint32_t place) const { return sums_[place].b[2]; }
  [[nodiscard]] double expected(std::uint32_t place) const {
    return sums_[place].b[2] / sums_[place].b[3];
  }

  /// Finds Λ_v of the occupied voxels.
  void look_up();
  /// The kernels' finish() of a class; look_up() must have found what is known of the occupied.
  void finish_unknown(LogProduct& ratios, LogProduct* posterior, double* each) const;
  void finish_occupied(LogProduct& ratios, LogProduct* posterior, double* each) const;

  /// Closes, and calls visit(key, known, sum, weight) for every voxel touched: its key, Λ_v of an
  /// occupied one (nothing: unknown), ΣΛ_r, w_v. In the same order for the same hits.
  template <typename Visit>
  void visit(Visit&& visit) {
    close();
    look_up();
    const auto call = [&](std::uint32_t place, const std::optional<VoxelSum>& known) {
      visit(key(place), known, sums_[place], weight(place));
    };
    for (const std::uint32_t place : unknown()) call(place, std::nullopt);
    for (std::size_t i = 0; i < occupied_count_; ++i) {
      const auto& a = known_a_[i].value;
      const auto& b = known_b_[i].value;
      call(occupied_[i], VoxelSum{{a[0], a[1], a[2], a[3]}, {b[0], b[1], 0, 0}});
    }
  }

  /// Vectors reach up to this many elements beyond the last voxel.
  static constexpr std::size_t kOverhang = 8;

 protected:
  [[nodiscard]] const GainSettings& settings() const { return *settings_; }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  static constexpr std::size_t kMostAtOnce = kBatchSize + kTileRays;

  // An 8³ block that the view has touched.
  struct Block {
    const GridSnapshot::Leaf* leaf;  // never null
    std::uint64_t key;               // of the block's first voxel
  };
  // Where a block of a larger box is; void unless its generation is the view's.
  struct BlockSlot {
    std::uint64_t key = 0;
    std::uint32_t generation = 0;
    std::uint32_t block = 0;
  };

  void flush();
  void find_places(std::uint32_t* places, std::uint64_t* keep);
  std::uint32_t code_of(std::uint32_t primitive, std::uint32_t offset);
  std::uint32_t block_in_box(std::uint64_t key);
  std::uint32_t start_block(std::uint64_t key, const GridSnapshot::Leaf* leaf);
  [[nodiscard]] std::uint64_t key(std::uint32_t place) const {
    return blocks_[touched_[place] >> 9U].key | (touched_[place] & 511U);
  }

  std::size_t max_rays_;
  const SceneData* scene_ = nullptr;
  const GainSettings* settings_ = nullptr;
  const GainKernels* kernels_ = nullptr;
  HitBatch batch_;  // hits that wait for a flush()
  std::uint32_t hits_ = 0;
  std::vector<SampledHit>* sample_ = nullptr;

  // Touched blocks. Those that are primitives of their own are found by the primitive's number
  // (kNone: not touched), those of larger boxes by their key in an open-addressing table.
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> by_primitive_, touched_primitives_;
  std::vector<BlockSlot> by_key_;
  unsigned shift_ = 0;
  std::uint32_t generation_ = 0;

  // By a voxel's code its place, or kNone. Grows to the most blocks that a view has touched.
  std::vector<std::uint32_t> places_;
  // By place; as all below sized for the most that a view can touch.
  std::size_t touched_count_ = 0;
  std::vector<std::uint32_t> touched_;  // codes
  std::vector<VoxelSum> sums_;
  // The classes: places, and of the occupied ones what is known.
  std::size_t unknown_count_ = 0, occupied_count_ = 0;
  std::vector<std::uint32_t> unknown_, occupied_;
  std::vector<const BeliefBlock*> occupied_block_;  // null: without beliefs
  std::vector<std::uint32_t> occupied_offset_;
  std::vector<MatrixHalf> known_a_, known_b_;
};

}  // namespace viewgain::detail
