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

/// Makes a snapshot's lists of leaves and tiles, node by node and region by region. A map has many
/// times more free leaves than others, spread over the heap: those of a node are read some time
/// after they are asked for, so that they can be on their way into the cache.
class SnapshotMaker {
 public:
  SnapshotMaker(const GridStorage& storage, const GridSnapshot& before, GridSnapshot& out)
      : storage_(storage), before_(before), out_(out), earlier_(before.regions.begin()) {
    out.shared_until = storage.is_earlier(before) ? before.time : 0;
    if (out.shared_until != 0) {
      out.leaves.reserve(before.leaves.size() + before.leaves.size() / 8);
      out.tiles.reserve(before.tiles.size() + before.tiles.size() / 8);
      out.regions.reserve(before.regions.size() + before.regions.size() / 8);
    }
  }

  void run() {
    const auto& root = storage_.tree.root();
    for (auto it = root.cbeginValueAll(); it; ++it) {
      add_tile(to_index(it.getCoord()), static_cast<int>(CodeUpper::DIM), *it);
    }
    std::vector<std::pair<std::uint64_t, const CodeNode*>> nodes;
    for (auto upper = root.cbeginChildOn(); upper; ++upper) {
      for (auto it = upper->cbeginValueAll(); it; ++it) {
        add_tile(to_index(it.getCoord()), kNodeSize, *it);
      }
      for (auto node = upper->cbeginChildOn(); node; ++node) {
        const Index3 origin = to_index(node.getCoord());
        if (storage_.lattice.overlaps(origin, kNodeSize)) {
          nodes.emplace_back(storage_.lattice.key(origin) >> 12U, &*node);
        }
      }
    }
    std::sort(nodes.begin(), nodes.end());
    for (const auto& [number, node] : nodes) {
      for (std::uint64_t part = 0; part < 64; ++part) add_region(number << 6U | part, *node);
    }
  }

 private:
  static constexpr std::size_t kMasksAhead = 12, kCodesAhead = 4;
  struct Waiting {
    const CodeLeaf* leaf;
    Index3 origin;
    std::uint64_t key;
  };

  void add_tile(Index3 origin, int size, std::uint8_t code) {
    if (code != kUnknownCode || !storage_.lattice.overlaps(origin, size)) return;
    const VoxelBox box = clipped(storage_.lattice, origin, size);
    out_.tiles.push_back({box.min, box.max});
  }

  void add_region(std::uint64_t number, const CodeNode& node) {
    const Index3 origin = storage_.lattice.origin(number << 6U);
    if (!storage_.lattice.overlaps(origin, kRegionSize)) return;
    const auto change = storage_.changed.find(number);
    const std::uint64_t changed = change == storage_.changed.end() ? 0 : change->second;
    out_.regions.push_back({number, changed, static_cast<std::uint32_t>(out_.leaves.size()),
                            static_cast<std::uint32_t>(out_.tiles.size())});
    if (out_.is_shared(out_.regions.back())) {
      while (earlier_ != before_.regions.end() && earlier_->number < number) ++earlier_;
      if (earlier_ != before_.regions.end() && earlier_->number == number) {
        copy_region(static_cast<std::size_t>(earlier_ - before_.regions.begin()));
        return;
      }
    }
    for (std::uint64_t block = number << 6U; block < (number + 1) << 6U; ++block) {
      const Index3 at = storage_.lattice.origin(block);
      if (!storage_.lattice.overlaps(at, kBlockSize)) continue;
      const openvdb::Index place = CodeNode::coordToOffset(to_coord(at));
      if (!node.isChildMaskOn(place)) {
        add_tile(at, kBlockSize, node.getTable()[place].getValue());
      } else {
        const CodeLeaf* leaf = node.getTable()[place].getChild();
        waiting_.push_back({leaf, at, block});
      }
    }
    read_waiting();
  }

  void copy_region(std::size_t region) {
    const auto [leaves, leaves_end] = before_.leaves_of(region);
    const auto [tiles, tiles_end] = before_.tiles_of(region);
    out_.leaves.insert(out_.leaves.end(), before_.leaves.begin() + leaves,
                       before_.leaves.begin() + leaves_end);
    out_.tiles.insert(out_.tiles.end(), before_.tiles.begin() + tiles,
                      before_.tiles.begin() + tiles_end);
  }

  void read_waiting() {
    const auto leaf_at = [&](std::size_t i) {
      return i < waiting_.size() ? waiting_[i].leaf : nullptr;
    };
    const auto fetch_mask = [&](std::size_t i) {
      if (const CodeLeaf* leaf = leaf_at(i)) {
        __builtin_prefetch(leaf);
        __builtin_prefetch(reinterpret_cast<const char*>(leaf) + 64);
      }
    };
    const auto fetch_codes = [&](std::size_t i) {
      const CodeLeaf* leaf = leaf_at(i);
      if (leaf == nullptr || leaf->getValueMask().isOff()) return;
      const std::uint8_t* codes = leaf->buffer().data();
      for (int line = 0; line < kBlockVoxels; line += 64) __builtin_prefetch(codes + line);
    };
    for (std::size_t i = 0; i < kMasksAhead; ++i) fetch_mask(i);
    for (std::size_t i = 0; i < waiting_.size(); ++i) {
      fetch_mask(i + kMasksAhead);
      fetch_codes(i + kCodesAhead);
      read(waiting_[i]);
    }
    waiting_.clear();
  }

  void read(const Waiting& entry) {
    const CodeLeaf& leaf = *entry.leaf;
    if (leaf.getValueMask().isOff()) return;
    LeafMask non_free = leaf_mask(leaf.getValueMask());
    if (!storage_.lattice.covers(entry.origin, kBlockSize)) {
      non_free = intersection(non_free, storage_.lattice.clip(entry.origin));
      if (non_free == LeafMask{}) return;
    }
    const LeafMask occupied = intersection(non_free, occupied_mask(leaf.buffer().data()));
    std::shared_ptr<const BeliefBlock> beliefs;
    if (occupied != LeafMask{}) {
      const auto found = storage_.beliefs.find(entry.key);
      if (found != storage_.beliefs.end()) beliefs = found->second;
    }
    out_.leaves.push_back({entry.origin, non_free, occupied, std::move(beliefs)});
  }

  const GridStorage& storage_;
  const GridSnapshot& before_;
  GridSnapshot& out_;
  std::vector<SnapshotRegion>::const_iterator earlier_;
  std::vector<Waiting> waiting_;
};

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

/// Adds up hashes of the largest uniform cubes of 2048, 128 and 8 voxels, unknown ones left out,
/// and of the blocks that are not uniform. A cube is uniform if its voxels in the workspace are, so
/// neither the tree's topology nor the order matters, and the cost is that of the tree's nodes.
class ContentHash {
 public:
  explicit ContentHash(const BlockLattice& lattice) : lattice_(lattice) {}

  void add_tree(const CodeTree& tree) {
    Part all;
    for (auto it = tree.root().cbeginValueAll(); it; ++it) {
      add_cube(it.getCoord(), CodeUpper::DIM, {.code = *it}, all);
    }
    for (auto upper = tree.root().cbeginChildOn(); upper; ++upper) {
      add_cube(upper.getCoord(), CodeUpper::DIM, hash_node(*upper), all);
    }
    sum_ += all.sum;
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
  /// A cube's voxels in the workspace.
  struct Part {
    bool any = true;      ///< are there some?
    bool uniform = true;  ///< then `code` is that of all, else `sum` is over smaller cubes
    std::uint8_t code = kUnknownCode;
    std::uint64_t sum = 0;
  };

  template <typename Node>
  Part hash_node(const Node& node) const {
    Part all{.any = false};
    constexpr int kSize = Node::ChildNodeType::DIM;
    for (auto it = node.cbeginValueAll(); it; ++it) {
      add_cube(it.getCoord(), kSize, {.code = *it}, all);
    }
    for (auto child = node.cbeginChildOn(); child; ++child) {
      add_cube(child.getCoord(), kSize, hash_node(*child), all);
    }
    return all;
  }

  Part hash_node(const CodeLeaf& leaf) const {
    const std::uint8_t* codes = leaf.buffer().data();
    const LeafMask inside = lattice_.clip(to_index(leaf.origin()));
    std::array<std::uint8_t, kBlockVoxels> own{};
    Part all{.any = false};
    for_each_bit(inside, [&](unsigned offset) {
      own[offset] = codes[offset];
      all.uniform = all.uniform && (!all.any || codes[offset] == all.code);
      all.code = codes[offset];
      all.any = true;
    });
    if (!all.uniform) all.sum = hash_codes(own);
    return all;
  }

  // Puts one of a node's cubes to the others.
  void add_cube(const openvdb::Coord& at, int size, const Part& cube, Part& all) const {
    const Index3 origin = to_index(at);
    if (!cube.any || !lattice_.overlaps(origin, size)) return;
    all.uniform = all.uniform && cube.uniform && (!all.any || cube.code == all.code);
    all.code = cube.code;
    all.any = true;
    if (!cube.uniform) {
      all.sum += size == kBlockSize ? hash_origin(origin, cube.sum) : cube.sum;
    } else if (cube.code != kUnknownCode) {
      Hash64 hash;
      hash.add(static_cast<std::uint64_t>(size));
      hash.add(cube.code);
      all.sum += hash_origin(origin, hash.value());
    }
  }

  const BlockLattice& lattice_;
  std::uint64_t sum_ = 0;
};

}  // namespace

std::optional<Index3> GridSnapshot::index_of(const Eigen::Vector3d& p_world) const {
  return VoxelBox::from_dims(min_index, dims)
      .voxel_at(T_world_grid.inverse() * p_world / voxel_size);
}
Eigen::Vector3d GridSnapshot::center(Index3 voxel) const {
  return T_world_grid * voxel_center(voxel, voxel_size);
}

const SnapshotLeaf* GridSnapshot::find_leaf(Index3 voxel) const {
  const BlockLattice lattice(min_index, dims);
  if (!lattice.contains(voxel)) return nullptr;
  const std::uint64_t number = lattice.key(voxel) >> 6U;
  const auto region =
      std::lower_bound(regions.begin(), regions.end(), number,
                       [](const SnapshotRegion& r, std::uint64_t n) { return r.number < n; });
  if (region == regions.end() || region->number != number) return nullptr;
  const Index3 origin = block_origin(voxel);
  const auto [first, last] = leaves_of(static_cast<std::size_t>(region - regions.begin()));
  for (std::uint32_t i = first; i < last; ++i) {
    if (leaves[i].origin == origin) return &leaves[i];
  }
  return nullptr;
}

GridSnapshot BeliefGrid::snapshot() const { return snapshot(GridSnapshot{}); }

GridSnapshot BeliefGrid::snapshot(const GridSnapshot& before) const {
  const GridStorage& s = *storage_;
  GridSnapshot result;
  result.voxel_size = s.voxel_size;
  result.prior_sigma = s.prior_sigma;
  result.T_world_grid = s.T_world_grid;
  result.min_index = s.min_index;
  result.dims = s.dims;
  result.grid_number = s.number;
  result.time = s.time;
  SnapshotMaker(s, before, result).run();
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
  const GridStorage& s = *storage_;
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
        const VoxelBox box = clipped(s.lattice, origin, kBlockSize);
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

  result.bytes = sizeof(GridStorage) + tree_bytes(s.tree) + s.views.capacity() * sizeof(Pose);
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
  const GridStorage& s = *storage_;
  ContentHash contents(s.lattice);
  contents.add_tree(s.tree);
  for (const auto& [key, block] : s.beliefs) contents.add_beliefs(s.lattice.origin(key), *block);

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
  hash.add(contents.sum());
  return hash.hex();
}

}  // namespace viewgain
