// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <bit>
#include <cstring>

#include "grid_storage.hpp"
#include "viewgain/support/belief_block.hpp"
#include "viewgain/support/hash64.hpp"

namespace viewgain {
namespace {

using namespace detail;

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

/// Sums hashes of the largest uniform cubes of 2048, 128 and 8 voxels, except unknown ones, and of
/// blocks that are not uniform. A cube is uniform if its voxels in the workspace are, so neither
/// the tree's topology nor the order matters; the cost is that of the tree's nodes.
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

  void add_scale(Index3 origin, std::uint8_t scale) {
    Hash64 hash;
    hash.add(scale);
    sum_ += hash_origin(origin, hash.value());
  }

  [[nodiscard]] std::uint64_t sum() const { return sum_; }

 private:
  /// A cube's voxels in the workspace.
  struct Part {
    bool any = true;      ///< whether there are any
    bool uniform = true;  ///< then `code` is common to all, otherwise `sum` is over smaller cubes
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

  // Adds one cube of a node to the others.
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

std::string BeliefGrid::content_hash() const {
  const GridStorage& s = *storage_;
  ContentHash contents(s.lattice);
  contents.add_tree(s.tree);
  for (const auto& [key, block] : s.beliefs) contents.add_beliefs(s.lattice.origin(key), *block);
  for (const auto& [key, scale] : s.scales) contents.add_scale(s.lattice.origin(key), scale);

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
  if (!s.hazard.empty()) {  // maps without it keep their earlier hash
    for (const HazardCounters::Class& c : s.hazard.classes) {
      hash.add(static_cast<std::uint64_t>(c.expected));
      hash.add(static_cast<std::uint64_t>(c.met));
    }
  }
  return hash.hex();
}

}  // namespace viewgain
