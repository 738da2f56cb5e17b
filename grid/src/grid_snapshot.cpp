// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "grid_storage.hpp"
#include "hash64.hpp"

namespace viewgain {
namespace {

using namespace detail;

LeafMask intersection(const LeafMask& a, const LeafMask& b) {
  LeafMask result;
  for (std::size_t i = 0; i < 8; ++i) result[i] = a[i] & b[i];
  return result;
}

std::uint64_t tree_bytes(const CodeTree& tree) {
  std::uint64_t bytes = sizeof(CodeTree);
  const auto& root = tree.root();
  // A node of the root's map: key, entry and the red-black tree's own links and colour.
  bytes += root.getTableSize() * (sizeof(openvdb::Coord) + 2 * sizeof(void*) + 4 * sizeof(void*));
  for (auto upper = root.cbeginChildOn(); upper; ++upper) {
    bytes += sizeof(CodeUpper);
    for (auto node = upper->cbeginChildOn(); node; ++node) {
      bytes += sizeof(CodeNode) +
               std::uint64_t{node->getChildMask().countOn()} * (sizeof(CodeLeaf) + kBlockVoxels);
    }
  }
  return bytes;
}

// Where visit_blocks() comes to a leaf of the workspace: upper node, node, leaf, each by x, y, z.
std::uint64_t tree_order(const BlockLattice& lattice, Index3 origin) {
  // A workspace of 65,536 voxels touches at most 33 upper nodes along an axis.
  const auto upper = [](std::int32_t at, std::int32_t low) {
    return static_cast<std::uint64_t>((at >> 11) - (low >> 11));
  };
  const auto part = [](std::int32_t at, int shift) {
    return static_cast<std::uint64_t>(at >> shift & 15);
  };
  std::uint64_t order = upper(origin.x, lattice.min.x);
  order = order << 6U | upper(origin.y, lattice.min.y);
  order = order << 6U | upper(origin.z, lattice.min.z);
  for (const int shift : {7, 3}) {
    order = order << 4U | part(origin.x, shift);
    order = order << 4U | part(origin.y, shift);
    order = order << 4U | part(origin.z, shift);
  }
  return order;
}

std::uint64_t hash_origin(Index3 origin, std::uint64_t contents) {
  Hash64 hash;
  hash.add(static_cast<std::uint64_t>(static_cast<std::uint32_t>(origin.x)) << 32U |
           static_cast<std::uint32_t>(origin.y));
  hash.add(static_cast<std::uint32_t>(origin.z));
  hash.add(contents);
  return hash.value();
}

std::uint64_t hash_codes(const std::array<std::uint8_t, kBlockVoxels>& codes) {
  Hash64 hash;
  for (std::size_t i = 0; i < kBlockVoxels; i += 8) {
    std::uint64_t word;
    std::memcpy(&word, codes.data() + i, 8);
    hash.add(word);
  }
  return hash.value();
}

/// Adds up hashes of 8³ blocks, wholly unknown ones left out, so that neither the tree's topology
/// nor the order matters.
class BlockHashes {
 public:
  explicit BlockHashes(const BlockLattice& lattice) : lattice_(lattice) {}

  void add_leaf(const CodeLeaf& leaf) {
    std::array<std::uint8_t, kBlockVoxels> codes{};
    const Index3 origin = to_index(leaf.origin());
    const LeafMask inside = lattice_.clip(origin);
    const std::uint8_t* from = leaf.buffer().data();
    bool known = false;
    for_each_bit(inside, [&](unsigned offset) {
      codes[offset] = from[offset];
      known = known || from[offset] != kUnknownCode;
    });
    if (known) sum_ += hash_origin(origin, hash_codes(codes));
  }

  void add_tile(Index3 origin, int size, std::uint8_t code) {
    if (code == kUnknownCode) return;
    const IndexBox box = clipped(lattice_, origin, size);
    const Index3 low = block_origin(box.min);
    for (std::int32_t x = low.x; x < box.max.x; x += kBlockSize) {
      for (std::int32_t y = low.y; y < box.max.y; y += kBlockSize) {
        for (std::int32_t z = low.z; z < box.max.z; z += kBlockSize) add_uniform({x, y, z}, code);
      }
    }
  }

  void add_beliefs(Index3 origin, const BeliefBlock& block) {
    Hash64 hash;
    for (const std::uint64_t word : block.mask) hash.add(word);
    for (const Belief& belief : block.beliefs) {
      for (const float value : belief.information) hash.add(std::bit_cast<std::uint32_t>(value));
      for (const float value : belief.information_vector)
        hash.add(std::bit_cast<std::uint32_t>(value));
      hash.add(belief.hits);
    }
    sum_ += hash_origin(origin, hash.value());
  }

  [[nodiscard]] std::uint64_t sum() const { return sum_; }

 private:
  void add_uniform(Index3 origin, std::uint8_t code) {
    std::array<std::uint8_t, kBlockVoxels> codes{};
    if (lattice_.covers(origin, kBlockSize)) {
      std::uint64_t& hash = uniform_[code];
      if (hash == 0) {
        codes.fill(code);
        hash = hash_codes(codes);
      }
      sum_ += hash_origin(origin, hash);
    } else {
      for_each_bit(lattice_.clip(origin), [&](unsigned offset) { codes[offset] = code; });
      sum_ += hash_origin(origin, hash_codes(codes));
    }
  }

  const BlockLattice& lattice_;
  std::array<std::uint64_t, kMaxCode + 1> uniform_{};
  std::uint64_t sum_ = 0;
};

}  // namespace

GridSnapshot BeliefGrid::snapshot() const { return snapshot(GridSnapshot{}); }

GridSnapshot BeliefGrid::snapshot(const GridSnapshot& before) const {
  const Storage& s = *storage_;
  GridSnapshot result{s.voxel_size, s.prior_sigma, s.T_world_grid, s.min_index, s.dims, {},
                      {},           s.number,      s.time};
  const bool is_related = s.is_earlier(before);
  if (is_related) {
    result.leaves.reserve(before.leaves.size() + before.leaves.size() / 8);
    result.tiles.reserve(before.tiles.size() + before.tiles.size() / 8);
  }
  auto earlier = before.leaves.begin();
  // The leaf as it was, if nothing near it has changed. Both lists are in the tree's order.
  const auto unchanged = [&](Index3 origin, std::uint64_t key) -> const SnapshotLeaf* {
    if (!is_related) return nullptr;
    const std::uint64_t place = tree_order(s.lattice, origin);
    while (earlier != before.leaves.end() && tree_order(s.lattice, earlier->origin) < place) {
      ++earlier;
    }
    if (earlier == before.leaves.end() || !(earlier->origin == origin)) return nullptr;
    const auto change = s.changed.find(key >> 6U);
    if (change != s.changed.end() && change->second > before.time) return nullptr;
    return &*earlier;
  };
  visit_blocks(
      s,
      [&](const CodeLeaf& leaf, Index3 origin) {
        const std::uint64_t key = s.lattice.key(clipped(s.lattice, origin, kBlockSize).min);
        if (const SnapshotLeaf* same = unchanged(origin, key)) {
          result.leaves.push_back(*same);
          return;
        }
        if (leaf.getValueMask().isOff()) return;
        LeafMask non_free = leaf_mask(leaf.getValueMask());
        if (!s.lattice.covers(origin, kBlockSize)) {
          non_free = intersection(non_free, s.lattice.clip(origin));
          if (non_free == LeafMask{}) return;
        }
        const LeafMask occupied = intersection(non_free, occupied_mask(leaf.buffer().data()));
        std::shared_ptr<const BeliefBlock> beliefs;
        if (occupied != LeafMask{}) {
          const auto found = s.beliefs.find(key);
          if (found != s.beliefs.end()) beliefs = found->second;
        }
        result.leaves.push_back({origin, non_free, occupied, std::move(beliefs)});
      },
      [&](Index3 origin, int size, std::uint8_t code) {
        if (code != kUnknownCode) return;
        const IndexBox box = clipped(s.lattice, origin, size);
        result.tiles.push_back({box.min, box.max});
      });
  return result;
}

std::vector<BeliefBlockAt> BeliefGrid::belief_blocks() const {
  std::vector<std::uint64_t> keys;
  keys.reserve(storage_->beliefs.size());
  for (const auto& [key, block] : storage_->beliefs) keys.push_back(key);
  std::sort(keys.begin(), keys.end());
  std::vector<BeliefBlockAt> blocks;
  blocks.reserve(keys.size());
  for (const std::uint64_t key : keys) {
    blocks.push_back({storage_->lattice.origin(key), storage_->beliefs.at(key)});
  }
  return blocks;
}

GridStatistics BeliefGrid::statistics(Criterion criterion) const {
  const Storage& s = *storage_;
  GridStatistics result;
  const auto prior = SymmetricMatrix3::identity(1.0 / (s.prior_sigma * s.prior_sigma));
  visit_blocks(
      s,
      [&](const CodeLeaf& leaf, Index3 origin) {
        const std::uint8_t* codes = leaf.buffer().data();
        LeafMask inside;
        inside.fill(~std::uint64_t{0});
        if (!s.lattice.covers(origin, kBlockSize)) inside = s.lattice.clip(origin);
        const LeafMask occupied = intersection(inside, occupied_mask(codes));
        const LeafMask non_free = intersection(inside, leaf_mask(leaf.getValueMask()));
        const std::uint64_t occupied_count = count_bits(occupied);
        result.occupied += occupied_count;
        result.free += count_bits(inside) - count_bits(non_free);
        if (occupied_count == 0) return;
        const IndexBox box = clipped(s.lattice, origin, kBlockSize);
        const BeliefBlock* block = s.find_beliefs(s.lattice.key(box.min));
        if (block == nullptr) return;
        for_each_bit(intersection(occupied, block->mask), [&](unsigned offset) {
          result.entropy_removed +=
              entropy_reduction(prior, block->find(offset)->information_matrix(), criterion);
        });
      },
      [&](Index3 origin, int size, std::uint8_t code) {
        if (code != kUnknownCode) result.free += clipped(s.lattice, origin, size).volume();
      });
  result.unknown = voxel_count() - result.free - result.occupied;

  result.bytes = sizeof(Storage) + tree_bytes(s.tree) + s.views.capacity() * sizeof(Pose);
  // Each entry of the map: its node (link, key, pointer), its bucket and the shared block.
  constexpr std::size_t kSharedCounts = 2 * sizeof(void*);
  for (const auto& [key, block] : s.beliefs) {
    result.bytes += sizeof(void*) + sizeof(std::pair<std::uint64_t, std::shared_ptr<BeliefBlock>>) +
                    kSharedCounts + sizeof(BeliefBlock) +
                    block->beliefs.capacity() * sizeof(Belief);
  }
  result.bytes += s.beliefs.bucket_count() * sizeof(void*);
  return result;
}

std::string BeliefGrid::content_hash() const {
  const Storage& s = *storage_;
  BlockHashes blocks(s.lattice);
  visit_blocks(
      s, [&](const CodeLeaf& leaf, Index3) { blocks.add_leaf(leaf); },
      [&](Index3 origin, int size, std::uint8_t code) { blocks.add_tile(origin, size, code); });
  for (const auto& [key, block] : s.beliefs) blocks.add_beliefs(s.lattice.origin(key), *block);

  Hash64 hash;
  const auto add_double = [&hash](double value) { hash.add(std::bit_cast<std::uint64_t>(value)); };
  const auto add_pose = [&](const Pose& pose) {
    for (const double value : pose.m) add_double(value);
  };
  add_double(s.voxel_size);
  add_double(s.prior_sigma);
  add_pose(s.T_world_grid);
  for (const std::int32_t value :
       {s.min_index.x, s.min_index.y, s.min_index.z, s.dims.x, s.dims.y, s.dims.z}) {
    hash.add(static_cast<std::uint32_t>(value));
  }
  hash.add(s.views.size());
  for (const Pose& view : s.views) add_pose(view);
  hash.add(blocks.sum());
  return hash.hex();
}

}  // namespace viewgain
