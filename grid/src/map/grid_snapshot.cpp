// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/grid/grid_snapshot.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "code_mask.hpp"
#include "grid_storage.hpp"
#include "viewgain/support/belief_block.hpp"

namespace viewgain {
namespace {

using namespace detail;

// Order of tiles larger than a region: by the nodes of 2048³ and of 128³ voxels that contain their
// lowest voxel, each by x, y, z.
std::array<std::int32_t, 6> place_of(Index3 v) {
  constexpr int kUpper = static_cast<int>(CodeUpper::TOTAL),
                kNode = static_cast<int>(CodeNode::TOTAL);
  return {v.x >> kUpper, v.y >> kUpper, v.z >> kUpper, v.x >> kNode, v.y >> kNode, v.z >> kNode};
}

/// Builds a snapshot's lists of leaves and tiles, node by node and region by region. A map has many
/// more free leaves than others, spread over the heap: leaves of a node are prefetched and read
/// some time later.
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
    std::sort(out_.tiles.begin(), out_.tiles.end(), [](const VoxelBox& a, const VoxelBox& b) {
      return place_of(a.min) < place_of(b.min);
    });
    std::sort(nodes.begin(), nodes.end());
    for (const auto& [number, node] : nodes) {
      for (std::uint64_t part = 0; part < 64; ++part) add_region(number << 6U | part, *node);
    }
  }

 private:
  static constexpr std::size_t kMasksAhead = 12, kCodesAhead = 4;
  struct Waiting {
    const CodeLeaf* leaf;  ///< null: an occupied tile
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
        const std::uint8_t code = node.getTable()[place].getValue();
        add_tile(at, kBlockSize, code);
        if (is_occupied(code)) waiting_.push_back({nullptr, at, block});
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
    const CodeLeaf* leaf = entry.leaf;
    if (leaf != nullptr && leaf->getValueMask().isOff()) return;
    LeafMask all;
    all.fill(~std::uint64_t{0});
    LeafMask non_free = leaf != nullptr ? leaf_mask(leaf->getValueMask()) : all;
    if (!storage_.lattice.covers(entry.origin, kBlockSize)) {
      non_free = intersection(non_free, storage_.lattice.clip(entry.origin));
      if (non_free == LeafMask{}) return;
    }
    const LeafMask occupied =
        leaf != nullptr ? intersection(non_free, occupied_mask(leaf->buffer().data())) : non_free;
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
  std::vector<GridSnapshot::Region>::const_iterator earlier_;
  std::vector<Waiting> waiting_;
};

}  // namespace

std::optional<Index3> GridSnapshot::index_of(const Eigen::Vector3d& p_world) const {
  return VoxelBox::from_dims(min_index, dims)
      .voxel_at(T_world_grid.inverse() * p_world / voxel_size);
}
Eigen::Vector3d GridSnapshot::center(Index3 voxel) const {
  return T_world_grid * voxel_center(voxel, voxel_size);
}

namespace {

// The listed region that contains a voxel of the workspace, if any.
std::optional<std::size_t> listed_region(const GridSnapshot& snapshot, const BlockLattice& lattice,
                                         Index3 voxel) {
  const std::vector<GridSnapshot::Region>& regions = snapshot.regions;
  const std::uint64_t number = lattice.key(voxel) >> 6U;
  const auto region =
      std::lower_bound(regions.begin(), regions.end(), number,
                       [](const GridSnapshot::Region& r, std::uint64_t n) { return r.number < n; });
  if (region == regions.end() || region->number != number) return std::nullopt;
  return static_cast<std::size_t>(region - regions.begin());
}

const GridSnapshot::Leaf* leaf_in(const GridSnapshot& snapshot, std::size_t region, Index3 voxel) {
  const Index3 origin = block_origin(voxel);
  const auto [first, last] = snapshot.leaves_of(region);
  for (std::uint32_t i = first; i < last; ++i) {
    if (snapshot.leaves[i].origin == origin) return &snapshot.leaves[i];
  }
  return nullptr;
}

}  // namespace

const GridSnapshot::Leaf* GridSnapshot::find_leaf(Index3 voxel) const {
  const BlockLattice lattice(min_index, dims);
  if (!lattice.contains(voxel)) return nullptr;
  const auto region = listed_region(*this, lattice, voxel);
  return region ? leaf_in(*this, *region, voxel) : nullptr;
}

bool GridSnapshot::is_free(Index3 voxel) const {
  const BlockLattice lattice(min_index, dims);
  if (!lattice.contains(voxel)) return true;
  if (const auto region = listed_region(*this, lattice, voxel)) {
    if (const GridSnapshot::Leaf* leaf = leaf_in(*this, *region, voxel)) {
      return !test_bit(leaf->non_free, block_offset(voxel));
    }
    const auto [first, last] = tiles_of(*region);
    const bool in_tile = std::any_of(tiles.begin() + first, tiles.begin() + last,
                                     [&](const VoxelBox& tile) { return tile.contains(voxel); });
    if (in_tile) return false;
  }
  // A larger tile fills a node, or its part in the workspace: the last one that is not behind the
  // voxel.
  const auto large =
      tiles.begin() +
      static_cast<std::ptrdiff_t>(regions.empty() ? tiles.size() : regions.front().first_tile);
  const auto behind = std::upper_bound(
      tiles.begin(), large, place_of(voxel),
      [](const auto& place, const VoxelBox& tile) { return place < place_of(tile.min); });
  return behind == tiles.begin() || !std::prev(behind)->contains(voxel);
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
  result.hazard = s.hazard;
  result.grid_number = s.number;
  result.time = s.time;
  SnapshotMaker(s, before, result).run();
  return result;
}

}  // namespace viewgain
