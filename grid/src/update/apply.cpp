// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "apply.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "map/grid_storage.hpp"
#include "map/leaf_scales.hpp"

namespace viewgain::detail {
namespace {

// Results of a thread in a region that it must not insert into the tree itself.
struct RegionResult {
  std::vector<std::unique_ptr<CodeLeaf>> leaves;
  std::vector<std::pair<Index3, std::uint8_t>> tiles;
  std::vector<std::pair<std::uint64_t, int>> scales;  // by key, of blocks whose scale changed
  ApplyCounts counts;
  bool changed = false;  // for snapshots
};

// The regions that the frame can change, in increasing order.
template <Evidence E>
void list_regions(const BlockLattice& lattice, const E& evidence, FrameHits& hits,
                  std::vector<std::uint64_t>& regions) {
  const std::vector<std::uint64_t> crossed = evidence.regions(lattice);
  std::vector<std::uint64_t> hit;
  for (const HitBlock& block : hits.blocks()) {
    if (hit.empty() || hit.back() != block.key >> 6U) hit.push_back(block.key >> 6U);
  }
  regions.clear();
  std::set_union(crossed.begin(), crossed.end(), hit.begin(), hit.end(),
                 std::back_inserter(regions));
}

void put_mask(const LeafMask& mask, CodeLeaf& leaf) {
  for (openvdb::Index i = 0; i < 8; ++i) leaf.getValueMask().getWord<std::uint64_t>(i) = mask[i];
}

// A block before the frame: its leaf, or the common code of its voxels.
struct BlockPlace {
  Index3 origin;
  bool whole = true;  // whether all of it is in the workspace
  CodeLeaf* leaf = nullptr;
  std::uint8_t tile_code = kUnknownCode;
  int scale = 0;
};

/// Processes regions on many threads. Each thread writes only the leaves and belief blocks of its
/// region. It reads the rest of the tree, whose topology stays fixed.
template <Evidence E>
class RegionUpdate {
 public:
  RegionUpdate(GridStorage& storage, const PlacedFrame& frame, const E& evidence,
               const FrameHits& hits, const ScalePlan& plan, const BlockKernels& kernels,
               bool literal)
      : s_(storage),
        frame_(frame),
        evidence_(evidence),
        hits_(hits),
        plan_(plan),
        kernels_(kernels),
        literal_(literal) {}

  void run(std::uint64_t region, RegionResult& result) const {
    const Index3 region_origin = s_.lattice.origin(region << 6U);
    std::span<const HitBlock> hit_blocks = hits_.in_region(region);
    const CubeClass region_class = evidence_.classify(region_origin, kRegionSize);
    if (region_class == CubeClass::untouched && hit_blocks.empty()) return;

    auto* node = s_.tree.template probeNode<CodeNode>(to_coord(region_origin));
    BlockPlace place;
    if (node == nullptr) place.tile_code = s_.tree.getValue(to_coord(region_origin));
    for (std::uint64_t key = region << 6U; key < (region + 1) << 6U; ++key) {
      place.origin = s_.lattice.origin(key);
      const HitBlock* hit_block = nullptr;
      if (!hit_blocks.empty() && hit_blocks.front().key == key) {
        hit_block = &hit_blocks.front();
        hit_blocks = hit_blocks.subspan(1);
      }
      place.whole = s_.lattice.covers(place.origin, kBlockSize);
      if (!place.whole && !s_.lattice.overlaps(place.origin, kBlockSize)) continue;
      CubeClass block_class = region_class;
      if (region_class == CubeClass::mixed || region_class == CubeClass::cut) {
        block_class = evidence_.classify(place.origin, kBlockSize);
      }
      if (block_class == CubeClass::untouched && hit_block == nullptr) continue;

      if (node != nullptr) {
        place.leaf = node->probeLeaf(to_coord(place.origin));
        if (place.leaf == nullptr) {
          place.tile_code =
              node->getTable()[CodeNode::coordToOffset(to_coord(place.origin))].getValue();
        }
      }
      if (block_class == CubeClass::crossed && hit_block == nullptr && place.leaf == nullptr &&
          may_be_tile(place.tile_code)) {
        cross_tile(place, result);
      } else {
        if (!plan_.is_idle()) {
          place.scale = scale_of(key, place, hit_block != nullptr);
          // Space far outside the image is not worth a leaf.
          if (block_class == CubeClass::cut && hit_block == nullptr && place.leaf == nullptr &&
              place.scale > 1) {
            continue;
          }
        }
        update_block(key, place, block_class, hit_block, result);
      }
    }
  }

 private:
  // A block without hits has a scale if it stores anything; FrameHits has set the others.
  [[nodiscard]] int scale_of(std::uint64_t key, const BlockPlace& place, bool is_hit) const {
    const bool is_held =
        is_hit || place.leaf != nullptr || is_occupied(place.tile_code) || s_.beliefs.contains(key);
    return is_held ? s_.scale(key) : plan_.of_new(place.origin);
  }

  void cross_tile(const BlockPlace& place, RegionResult& result) const {
    const std::uint8_t code = updated_code(place.tile_code, kMissDelta, literal_);
    if (code != place.tile_code) result.tiles.emplace_back(place.origin, code);
    result.changed = result.changed || is_non_free(place.tile_code);
    result.counts.crossed += place.whole ? kBlockVoxels : count_bits(s_.lattice.clip(place.origin));
  }

  void update_block(std::uint64_t key, const BlockPlace& place, CubeClass block_class,
                    const HitBlock* hit_block, RegionResult& result) const {
    alignas(64) std::array<std::int8_t, kBlockVoxels> deltas;
    bool any = block_class == CubeClass::crossed;
    if (block_class == CubeClass::mixed || block_class == CubeClass::cut) {
      any = evidence_.deltas(key, place.origin, place.scale, deltas.data());
    } else {
      deltas.fill(any ? kMissDelta : kNoDelta);
    }
    if (!any && hit_block == nullptr) return;
    if (hit_block != nullptr) {
      result.changed = true;
      put_hits(place, *hit_block, deltas.data(), result);
    }
    put_codes(key, place, deltas.data(), hit_block != nullptr, result);
  }

  void put_hits(const BlockPlace& place, const HitBlock& hit_block, std::int8_t* deltas,
                RegionResult& result) const {
    LeafMask mask{};
    for (const Hit& hit : hits_.of(hit_block)) set_bit(mask, hit.offset);
    result.counts.hit += count_bits(mask);
    for_each_bit(mask, [&](unsigned lowest) {  // overrides a crossing
      for_each_in_cell(lowest, place.scale, [&](unsigned offset) { deltas[offset] = kHitDelta; });
    });
    *hit_block.beliefs =
        with_hits(hit_block.beliefs->get(), hits_.of(hit_block), frame_.readings,
                  frame_.T_grid_readings, place.origin, s_.voxel_size, place.scale);
  }

  // The code of a block that needs no leaf: it is one cell, all codes are equal, or, in a map of
  // many scales, all were crossed once in full, so that the least certain one represents all.
  [[nodiscard]] std::optional<std::uint8_t> tile_of(const BlockPlace& place,
                                                    const std::uint8_t* codes,
                                                    const BlockUpdate& update) const {
    if (update.uniform) {
      const bool is_tile = may_be_tile(codes[0]) || place.scale == kMaxScale;
      return is_tile ? std::optional(codes[0]) : std::nullopt;
    }
    if (plan_.is_idle() || !place.whole || update.non_free != LeafMask{}) return std::nullopt;
    const std::uint8_t least_sure = *std::max_element(codes, codes + kBlockVoxels);
    if (least_sure > kZeroCode + kMissDelta) return std::nullopt;
    return least_sure;
  }

  void put_codes(std::uint64_t key, const BlockPlace& place, const std::int8_t* deltas, bool is_hit,
                 RegionResult& result) const {
    alignas(64) std::array<std::uint8_t, kBlockVoxels> fresh;
    CodeLeaf* const leaf = place.leaf;
    std::uint8_t* codes = leaf != nullptr ? leaf->buffer().data() : fresh.data();
    LeafMask non_free;
    if (leaf != nullptr) {
      non_free = leaf_mask(leaf->getValueMask());
    } else {
      fresh.fill(place.tile_code);
      non_free.fill(is_non_free(place.tile_code) ? ~std::uint64_t{0} : 0);
    }
    BlockUpdate update;
    kernels_.update(deltas, literal_, codes, update);
    if (!place.whole) {
      update.crossed = intersection(update.crossed, s_.lattice.clip(place.origin));
      // Everything crossed is outside the workspace.
      if (leaf == nullptr && !is_hit && update.crossed == LeafMask{}) return;
    }
    result.counts.crossed += count_bits(update.crossed);
    // Free voxels stay free when crossed.
    result.changed = result.changed || intersection(update.crossed, non_free) != LeafMask{};

    // At once, so that codes and mask agree even if an allocation fails below.
    if (leaf != nullptr) put_mask(update.non_free, *leaf);
    if (const auto code = tile_of(place, codes, update)) {
      if (leaf != nullptr || *code != place.tile_code) {
        result.tiles.emplace_back(place.origin, *code);
      }
      const bool was_held = leaf != nullptr || is_occupied(place.tile_code);
      if (was_held && place.scale > 0 && !is_occupied(*code) && !s_.beliefs.contains(key)) {
        result.scales.emplace_back(key, 0);
      }
      return;
    }
    if (leaf != nullptr) return;
    if (place.scale != s_.scale(key)) result.scales.emplace_back(key, place.scale);
    result.leaves.push_back(std::make_unique<CodeLeaf>(to_coord(place.origin), kUnknownCode, true));
    CodeLeaf& made = *result.leaves.back();
    std::copy(fresh.begin(), fresh.end(), made.buffer().data());
    put_mask(update.non_free, made);
  }

  GridStorage& s_;
  const PlacedFrame& frame_;
  const E& evidence_;
  const FrameHits& hits_;
  const ScalePlan& plan_;
  const BlockKernels& kernels_;
  const bool literal_;
};

// Removes beliefs of voxels that stayed unknown because memory ran out before their leaf was in the
// tree. Only a block made for this frame has such voxels: it is not shared yet, and a shorter list
// needs no memory.
void drop_beliefs_of_unknown(const GridStorage& s, Index3 origin, const BeliefBlock& made) {
  LeafMask unknown{};
  for_each_bit(made.mask, [&](unsigned offset) {
    if (s.tree.getValue(to_coord(offset_voxel(origin, offset))) == kUnknownCode) {
      set_bit(unknown, offset);
    }
  });
  if (unknown == LeafMask{}) return;
  auto& block = const_cast<BeliefBlock&>(made);
  std::size_t kept = 0, rank = 0;
  for_each_bit(block.mask, [&](unsigned offset) {
    if (!test_bit(unknown, offset)) block.beliefs[kept++] = block.beliefs[rank];
    ++rank;
  });
  block.beliefs.resize(kept);
  for (std::size_t word = 0; word < 8; ++word) block.mask[word] &= ~unknown[word];
}

}  // namespace

struct FrameApply::Impl {
  const BlockKernels& kernels;
  bool literal;
  std::vector<std::uint64_t> regions;
  std::vector<RegionResult> results;

  void put_results(GridStorage& s);
  void recover(GridStorage& s, FrameHits& hits);
};

// Handles blocks that changed between leaf and tile, and nodes that became uniform.
void FrameApply::Impl::put_results(GridStorage& s) {
  for (std::size_t i = 0; i < regions.size(); ++i) {
    RegionResult& result = results[i];
    if (result.leaves.empty() && result.tiles.empty()) continue;
    const Index3 origin = s.lattice.origin(regions[i] << 6U);
    auto* node = s.tree.probeNode<CodeNode>(to_coord(origin));
    if (node == nullptr) {
      // Setting a tile of the same value one level down creates the nodes above it.
      const std::uint8_t code = s.tree.getValue(to_coord(origin));
      s.tree.addTile(kBlockTileLevel, to_coord(origin), code, is_non_free(code));
      node = s.tree.probeNode<CodeNode>(to_coord(origin));
    }
    for (auto& leaf : result.leaves) node->addLeaf(leaf.release());
    for (const auto& [at, code] : result.tiles) {
      node->addTile(kBlockTileLevel, to_coord(at), code, is_non_free(code));
    }
    result.leaves.clear();
    result.tiles.clear();
  }
  for (std::size_t i = 0; i < regions.size(); ++i) {
    for (const auto& [key, scale] : results[i].scales) s.put_scale(key, scale);
    results[i].scales.clear();
  }
  for (std::size_t i = 0; i < regions.size(); ++i) {
    if (i + 1 < regions.size() && regions[i] >> 6U == regions[i + 1] >> 6U) continue;
    const openvdb::Coord origin = to_coord(s.lattice.origin(regions[i] << 6U));
    const auto* node = s.tree.probeConstNode<CodeNode>(origin);
    std::uint8_t code = 0;
    bool active = false;
    if (node != nullptr && node->isConstant(code, active) && may_be_tile(code)) {
      s.tree.addTile(kNodeTileLevel, origin, code, active);
    }
  }
}

// After memory ran out with some regions written: keeps the map valid for saving and loading.
void FrameApply::Impl::recover(GridStorage& s, FrameHits& hits) {
  // Earlier snapshots may no longer hold, and pending insertions must not affect another frame's
  // regions.
  s.forget_snapshots();
  for (RegionResult& result : results) result = {};
  for (const HitBlock& block : hits.blocks()) {
    const auto found = s.beliefs.find(block.key);
    if (found == s.beliefs.end()) continue;
    drop_beliefs_of_unknown(s, s.lattice.origin(block.key), *found->second);
    if (found->second->beliefs.empty()) s.beliefs.erase(found);
  }
  drop_idle_scales(s);
}

FrameApply::FrameApply(const BlockKernels& kernels, bool literal)
    : impl_(std::make_unique<Impl>(Impl{kernels, literal, {}, {}})) {}
FrameApply::~FrameApply() = default;

template <Evidence E>
ApplyCounts FrameApply::run(BeliefGrid& grid, const PlacedFrame& frame, const E& evidence,
                            FrameHits& hits, const ScalePlan& plan, ThreadPool& pool) {
  Impl& m = *impl_;
  GridStorage& s = GridAccess::storage(grid);
  list_regions(s.lattice, evidence, hits, m.regions);
  const RegionUpdate<E> update(s, frame, evidence, hits, plan, m.kernels, m.literal);
  const auto empty = std::make_shared<const BeliefBlock>();
  try {
    // Entries are created here, in one thread; the map's values do not move when it grows.
    for (HitBlock& block : hits.blocks()) {
      block.beliefs = &s.beliefs.try_emplace(block.key, empty).first->second;
    }
    if (m.results.size() < m.regions.size()) m.results.resize(m.regions.size());
    for (std::size_t i = 0; i < m.regions.size(); ++i) {
      m.results[i].counts = {};
      m.results[i].changed = false;
    }
    pool.for_each_chunk(m.regions.size(), 1, [&](std::size_t i, std::size_t) {
      update.run(m.regions[i], m.results[i]);
    });
    m.put_results(s);
    for (std::size_t i = 0; i < m.regions.size(); ++i) {
      if (m.results[i].changed) s.mark_changed(m.regions[i] << 6U);
    }
    s.views.push_back(frame.T_world_view);
  } catch (...) {
    m.recover(s, hits);
    throw;
  }
  ++s.time;

  ApplyCounts counts;
  for (std::size_t i = 0; i < m.regions.size(); ++i) {
    counts.hit += m.results[i].counts.hit;
    counts.crossed += m.results[i].counts.crossed;
  }
  return counts;
}

template ApplyCounts FrameApply::run(BeliefGrid&, const PlacedFrame&, const ConeEvidence&,
                                     FrameHits&, const ScalePlan&, ThreadPool&);
template ApplyCounts FrameApply::run(BeliefGrid&, const PlacedFrame&, const LineEvidence&,
                                     FrameHits&, const ScalePlan&, ThreadPool&);

}  // namespace viewgain::detail
