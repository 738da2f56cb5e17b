// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "non_free_voxels.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

namespace viewgain::detail {
namespace {

constexpr std::int32_t kBlock = 8, kRegion = 32, kNode = 128;

Box box_of(const VoxelBox& box) {
  const auto corner = [](const Index3& v) {
    return std::array{static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
  };
  return {corner(box.min), corner(box.max)};
}

Eigen::Vector3d vector(const Index3& index) {
  return {static_cast<double>(index.x), static_cast<double>(index.y), static_cast<double>(index.z)};
}

Index3 rounded_down(const Index3& v, std::int32_t size) {
  return {v.x & -size, v.y & -size, v.z & -size};
}

bool is_before(const Index3& a, const Index3& b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

/// Number of the cube of this size that contains a voxel, within the next larger cube of four per
/// side.
unsigned place_in_four(const Index3& v, std::int32_t size) {
  const int shift = std::countr_zero(static_cast<unsigned>(size));
  const auto part = [&](std::int32_t x) { return static_cast<unsigned>(x >> shift & 3); };
  return part(v.x) << 4U | part(v.y) << 2U | part(v.z);
}

/// Which of the 64 cubes of this size from `origin` on the voxels [low, high] touch.
std::uint64_t cubes_within(const Index3& origin, std::int32_t size, const Index3& low,
                           const Index3& high) {
  const auto range = [&](std::int32_t from, std::int32_t a, std::int32_t b) {
    const auto first = static_cast<unsigned>(std::clamp((a - from) / size, 0, 4));
    const auto last = static_cast<unsigned>(b < from ? 0 : std::clamp((b - from) / size + 1, 0, 4));
    return last > first ? (1U << last) - (1U << first) : 0U;
  };
  const std::uint64_t z = range(origin.z, low.z, high.z);
  const unsigned ys = range(origin.y, low.y, high.y), xs = range(origin.x, low.x, high.x);
  std::uint64_t plane = 0, cubes = 0;
  for (unsigned y = 0; y < 4; ++y) {
    if ((ys >> y & 1U) != 0) plane |= z << 4U * y;
  }
  for (unsigned x = 0; x < 4; ++x) {
    if ((xs >> x & 1U) != 0) cubes |= plane << 16U * x;
  }
  return cubes;
}

Index3 cube_at(const Index3& origin, std::int32_t size, unsigned number) {
  const auto part = [&](unsigned shift) {
    return static_cast<std::int32_t>(number >> shift & 3U) * size;
  };
  return {origin.x + part(4), origin.y + part(2), origin.z + part(0)};
}

bool voxels_overlap(const OrientedBox& body, const Box& range, const GridSnapshot::Leaf& leaf,
                    const OrientedBox::Limits& limits) {
  const Eigen::Vector3d origin = vector(leaf.origin);
  // Voxels [low, high) of the leaf are within the body's bounds.
  std::array<unsigned, 3> low{}, high{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double base = origin[static_cast<Eigen::Index>(k)];
    low[k] = static_cast<unsigned>(std::clamp(std::floor(range.min[k] - base), 0.0, 8.0));
    high[k] = static_cast<unsigned>(std::clamp(std::ceil(range.max[k] - base), 0.0, 8.0));
  }
  const std::uint64_t row = (1ULL << high[2]) - (1ULL << low[2]);
  std::uint64_t within = 0;  // bits are y << 3 | z
  for (unsigned y = low[1]; y < high[1]; ++y) within |= row << 8U * y;
  for (unsigned x = low[0]; x < high[0]; ++x) {
    for (std::uint64_t bits = leaf.non_free[x] & within; bits != 0; bits &= bits - 1) {
      const auto bit = static_cast<unsigned>(std::countr_zero(bits));
      const Eigen::Vector3d center =
          origin + Eigen::Vector3d(x + 0.5, (bit >> 3U) + 0.5, (bit & 7U) + 0.5);
      if (body.overlaps(center, limits)) return true;
    }
  }
  return false;
}

}  // namespace

std::uint32_t NonFreeVoxels::Node::place(unsigned region) const {
  const std::uint64_t before = listed & ((std::uint64_t{1} << region) - 1U);
  return first + static_cast<std::uint32_t>(std::popcount(before));
}

NonFreeVoxels::NonFreeVoxels(const GridSnapshot& snapshot)
    : snapshot_(snapshot),
      workspace_(VoxelBox::from_dims(snapshot.min_index, snapshot.dims)),
      blocks_(snapshot.regions.size()) {
  const std::size_t large =
      snapshot.regions.empty() ? snapshot.tiles.size() : snapshot.tiles_of(0)[0];
  std::vector<Box> boxes;
  boxes.reserve(large);
  for (std::size_t i = 0; i < large; ++i) boxes.push_back(box_of(snapshot.tiles[i]));
  large_ = BoxHierarchy(std::move(boxes));

  // Region numbers ascend. All bits except the low six are those of the node.
  Node node;
  for (std::size_t i = 0; i < snapshot.regions.size(); ++i) {
    const std::uint64_t number = snapshot.regions[i].number;
    if (node.listed == 0) node.first = static_cast<std::uint32_t>(i);
    const std::uint64_t bit = std::uint64_t{1} << (number & 63U);
    node.listed |= bit;
    const auto [leaf, leaf_end] = snapshot.leaves_of(i);
    const auto [tile, tile_end] = snapshot.tiles_of(i);
    if (leaf < leaf_end || tile < tile_end) {
      node.in_use |= bit;
      node.origin = rounded_down(
          leaf < leaf_end ? snapshot.leaves[leaf].origin : snapshot.tiles[tile].min, kNode);
    }
    const bool is_last =
        i + 1 == snapshot.regions.size() || snapshot.regions[i + 1].number >> 6U != number >> 6U;
    if (!is_last) continue;
    if (node.in_use != 0) nodes_.push_back(node);
    node = {};
  }
}

const NonFreeVoxels::Node* NonFreeVoxels::find_node(const Index3& voxel) const {
  const Index3 origin = rounded_down(voxel, kNode);
  const auto node =
      std::lower_bound(nodes_.begin(), nodes_.end(), origin,
                       [](const Node& n, const Index3& at) { return is_before(n.origin, at); });
  return node != nodes_.end() && node->origin == origin ? &*node : nullptr;
}

NonFreeVoxels::Blocks NonFreeVoxels::blocks_of(std::uint32_t region) const {
  KnownBlocks& known = blocks_[region];
  if (known.is_known.load(std::memory_order_acquire)) {
    return {known.leaves.load(std::memory_order_relaxed),
            known.tiles.load(std::memory_order_relaxed)};
  }
  Blocks blocks;
  const auto [leaf, leaf_end] = snapshot_.leaves_of(region);
  for (std::uint32_t i = leaf; i < leaf_end; ++i) {
    blocks.leaves |= std::uint64_t{1} << place_in_four(snapshot_.leaves[i].origin, kBlock);
  }
  const auto [tile, tile_end] = snapshot_.tiles_of(region);
  for (std::uint32_t i = tile; i < tile_end; ++i) {
    blocks.tiles |= std::uint64_t{1} << place_in_four(snapshot_.tiles[i].min, kBlock);
  }
  known.leaves.store(blocks.leaves, std::memory_order_relaxed);
  known.tiles.store(blocks.tiles, std::memory_order_relaxed);
  known.is_known.store(true, std::memory_order_release);
  return blocks;
}

const GridSnapshot::Leaf& NonFreeVoxels::leaf_at(std::uint32_t region, const Blocks& blocks,
                                                 unsigned block) const {
  const std::uint64_t before = blocks.leaves & ((std::uint64_t{1} << block) - 1U);
  const std::uint32_t first = snapshot_.leaves_of(region)[0];
  return snapshot_.leaves[first + static_cast<std::uint32_t>(std::popcount(before))];
}

template <typename Visit>
bool NonFreeVoxels::any_region(const Box& range, const Visit& visit) const {
  const Box workspace = box_of(workspace_);
  std::array<std::int32_t, 3> from{}, to{};
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(range.min[k] < workspace.max[k] && range.max[k] >= workspace.min[k])) return false;
    const auto inside = [&](double x) {
      return static_cast<std::int32_t>(
          std::clamp(std::floor(x), workspace.min[k], workspace.max[k] - 1));
    };
    from[k] = inside(range.min[k]);
    to[k] = inside(range.max[k]);
  }
  const Index3 low{from[0], from[1], from[2]}, high{to[0], to[1], to[2]};
  const Index3 first = rounded_down(low, kNode);
  for (std::int32_t x = first.x; x <= high.x; x += kNode) {
    for (std::int32_t y = first.y; y <= high.y; y += kNode) {
      auto node =
          std::lower_bound(nodes_.begin(), nodes_.end(), Index3{x, y, first.z},
                           [](const Node& n, const Index3& at) { return is_before(n.origin, at); });
      for (; node != nodes_.end() && node->origin.x == x && node->origin.y == y &&
             node->origin.z <= high.z;
           ++node) {
        std::uint64_t regions = node->in_use & cubes_within(node->origin, kRegion, low, high);
        for (; regions != 0; regions &= regions - 1) {
          const auto number = static_cast<unsigned>(std::countr_zero(regions));
          const Index3 origin = cube_at(node->origin, kRegion, number);
          if (visit(node->place(number), origin, cubes_within(origin, kBlock, low, high))) {
            return true;
          }
        }
      }
    }
  }
  return false;
}

template <typename LeafVisit, typename TileVisit>
bool NonFreeVoxels::any_block(const Box& range, const LeafVisit& leaf_visit,
                              const TileVisit& tile_visit) const {
  if (large_.any(range, [&](std::uint32_t item) { return tile_visit(snapshot_.tiles[item]); })) {
    return true;
  }
  return any_region(range, [&](std::uint32_t region, const Index3&, std::uint64_t wanted) {
    const Blocks blocks = blocks_of(region);
    if (((blocks.leaves | blocks.tiles) & wanted) == 0) return false;
    const auto is_wanted = [&](const Index3& at) {
      return (wanted >> place_in_four(at, kBlock) & 1U) != 0;
    };
    const auto [leaf, leaf_end] = snapshot_.leaves_of(region);
    for (std::uint32_t i = leaf; i < leaf_end; ++i) {
      const GridSnapshot::Leaf& item = snapshot_.leaves[i];
      if (is_wanted(item.origin) && leaf_visit(item)) return true;
    }
    const auto [tile, tile_end] = snapshot_.tiles_of(region);
    for (std::uint32_t i = tile; i < tile_end; ++i) {
      const VoxelBox& item = snapshot_.tiles[i];
      if (is_wanted(item.min) && tile_visit(item)) return true;
    }
    return false;
  });
}

bool NonFreeVoxels::overlap(const OrientedBox& body) const {
  const Box range = body.bounds();
  const auto voxel_limits = body.limits(Eigen::Vector3d::Constant(0.5));
  const auto leaf_limits = body.limits(Eigen::Vector3d::Constant(0.5 * kBlock));
  return any_block(
      range,
      [&](const GridSnapshot::Leaf& leaf) {
        const Eigen::Vector3d center = vector(leaf.origin) + Eigen::Vector3d::Constant(4.0);
        return body.overlaps(center, leaf_limits) &&
               voxels_overlap(body, range, leaf, voxel_limits);
      },
      [&](const VoxelBox& tile) { return body.overlaps(box_of(tile)); });
}

bool NonFreeVoxels::may_meet(const Cone& cone, const Box& range) const {
  const auto touches = [&](const Eigen::Vector3d& center, double radius) {
    const Eigen::Vector3d offset = center - cone.tip;
    const double along = offset.dot(cone.axis);
    const double across = std::sqrt(std::max(0.0, offset.squaredNorm() - along * along));
    return cone.cosine * across - cone.sine * along <= radius;
  };
  return any_block(
      range,
      [&](const GridSnapshot::Leaf& leaf) {
        // A ball around the leaf; 6.93 is half its diagonal.
        return touches(vector(leaf.origin) + Eigen::Vector3d::Constant(4.0), 6.93);
      },
      [&](const VoxelBox& tile) {
        const Eigen::Vector3d low = vector(tile.min), high = vector(tile.max);
        return touches(0.5 * (low + high), 0.5 * (high - low).norm());
      });
}

// Whether the voxel with this index is not free.
bool NonFreeVoxels::contains(const Index3& voxel) const {
  if (!workspace_.contains(voxel)) return false;
  const Eigen::Vector3d p = voxel_center(voxel, 1.0);
  const Box place{{p.x(), p.y(), p.z()}, {p.x(), p.y(), p.z()}};
  if (large_.any(place, [](std::uint32_t) { return true; })) return true;
  const Node* node = find_node(voxel);
  const unsigned region = place_in_four(voxel, kRegion);
  if (node == nullptr || (node->in_use >> region & 1U) == 0) return false;
  const Blocks blocks = blocks_of(node->place(region));
  const unsigned block = place_in_four(voxel, kBlock);
  if ((blocks.tiles >> block & 1U) != 0) return true;
  return (blocks.leaves >> block & 1U) != 0 &&
         test_bit(leaf_at(node->place(region), blocks, block).non_free, block_offset(voxel));
}

bool NonFreeVoxels::enclose(const Eigen::Vector3d& point, double touch) const {
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(touch);
  const std::optional<Index3> low = workspace_.voxel_at(point - margin);
  const std::optional<Index3> high = workspace_.voxel_at(point + margin);
  if (!low || !high) return false;
  for (std::int32_t x = low->x; x <= high->x; ++x) {
    for (std::int32_t y = low->y; y <= high->y; ++y) {
      for (std::int32_t z = low->z; z <= high->z; ++z) {
        if (!contains({x, y, z})) return false;
      }
    }
  }
  return true;
}

double NonFreeVoxels::first_along(const HalfLine& line, double begin, double end) const {
  constexpr double kNowhere = std::numeric_limits<double>::infinity();
  const auto [enter_all, leave_all] = line.inside(box_of(workspace_));
  const double from = std::max(begin, enter_all);
  double out = std::min(end, leave_all);
  if (!(from < out)) return kNowhere;

  double nearest = kNowhere;
  (void)large_.any_along(line, out, [&](std::uint32_t item) {
    const auto [enter, leave] = line.inside(box_of(snapshot_.tiles[item]));
    if (std::max(enter, begin) < leave) nearest = std::min(nearest, std::max(enter, begin));
    return false;
  });
  out = std::min(out, nearest);

  VoxelWalk walk(line, from, workspace_);
  const Node* node = nullptr;
  for (Index3 voxel = walk.voxel(); workspace_.contains(voxel) && walk.from() <= out;
       voxel = walk.voxel()) {
    if (node == nullptr || node->origin != rounded_down(voxel, kNode)) node = find_node(voxel);
    if (node == nullptr) {
      walk.leave<kNode>();
      continue;
    }
    const unsigned number = place_in_four(voxel, kRegion);
    if ((node->in_use >> number & 1U) == 0) {
      walk.leave<kRegion>();
      continue;
    }
    const std::uint32_t region = node->place(number);
    const Blocks blocks = blocks_of(region);
    const Index3 cube = rounded_down(voxel, kRegion);
    while (walk.from() <= out && rounded_down(voxel, kRegion) == cube) {
      const unsigned block = place_in_four(voxel, kBlock);
      const bool is_tile = (blocks.tiles >> block & 1U) != 0;
      if (!is_tile && (blocks.leaves >> block & 1U) == 0) {
        walk.leave<kBlock>();
        voxel = walk.voxel();
        continue;
      }
      const LeafMask* mask = is_tile ? nullptr : &leaf_at(region, blocks, block).non_free;
      const Index3 corner = rounded_down(voxel, kBlock);
      for (; rounded_down(voxel, kBlock) == corner; voxel = walk.voxel()) {
        const double enter = walk.from();
        const bool is_solid =
            mask == nullptr ? workspace_.contains(voxel) : test_bit(*mask, block_offset(voxel));
        if (walk.leave<1>() && is_solid) return enter <= out ? enter : nearest;
      }
    }
  }
  return nearest;
}

}  // namespace viewgain::detail
