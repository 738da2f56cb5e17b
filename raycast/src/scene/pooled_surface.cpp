// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "pooled_surface.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace viewgain::detail {
namespace {

// What one leaf's voxels and those next to them have; one object serves leaf by leaf.
class Pool {
 public:
  void look_at(const GridSnapshot& snapshot, const GridSnapshot::Leaf& leaf) {
    sums_.fill(0);
    measured_ = {};
    // The workspace may cut the leaf's low corner off.
    const auto [low_x, low_y, low_z] = snapshot.min_index;
    const Index3 inside{std::max(leaf.origin.x, low_x), std::max(leaf.origin.y, low_y),
                        std::max(leaf.origin.z, low_z)};
    const auto beside = [](int own, int first, int shift) {
      return shift < 0 ? first - 1 : shift > 0 ? first + 8 : own;
    };
    for (int x = -8; x <= 8; x += 8) {
      for (int y = -8; y <= 8; y += 8) {
        for (int z = -8; z <= 8; z += 8) {
          const GridSnapshot::Leaf* other = snapshot.find_leaf(
              {beside(inside.x, leaf.origin.x, x), beside(inside.y, leaf.origin.y, y),
               beside(inside.z, leaf.origin.z, z)});
          if (other != nullptr && other->beliefs) add(*other, {x, y, z});
        }
      }
    }
    for (const std::size_t step : {kRow, kRow * kAlong, kRow * kAlong * kAlong}) add_beside(step);
  }

  // The leaf's occupied voxels with readings.
  [[nodiscard]] const LeafMask& measured() const { return measured_; }

  // Of the 27 voxels round one of the leaf's.
  [[nodiscard]] Belief pooled(unsigned offset) const {
    const auto [x, y, z] = position(offset);
    const float* sum = &sums_[place(x, y, z)];
    Belief belief;
    for (std::size_t k = 0; k < 6; ++k) {
      belief.information[k] = sum[k] / static_cast<float>(PooledSurface::kVoxels);
    }
    belief.hits = static_cast<std::uint32_t>(sum[6]);
    return belief;
  }

 private:
  // Voxels from -1 to 8 along x, y, z, each with a row of numbers: Λ_v and 1, if it has readings.
  static constexpr std::size_t kAlong = 10, kRow = 8;
  using Rows = std::array<float, kAlong * kAlong * kAlong * kRow>;
  static std::size_t place(int x, int y, int z) {
    const auto at = [](int i) { return static_cast<std::size_t>(i + 1); };
    return ((at(x) * kAlong + at(y)) * kAlong + at(z)) * kRow;
  }
  static std::array<int, 3> position(unsigned offset) {
    return {static_cast<int>(offset >> 6U), static_cast<int>(offset >> 3U & 7U),
            static_cast<int>(offset & 7U)};
  }

  // To each row those of the two beside it along one axis; what comes from the rim's other side
  // stays at the rim.
  void add_beside(std::size_t step) {
    const Rows own = sums_;
    for (std::size_t i = step; i < own.size() - step; ++i) {
      sums_[i] = own[i - step] + own[i] + own[i + step];
    }
  }

  // Of a leaf that is so far off, the occupied voxels that are next to this one, or in it.
  static LeafMask near(const LeafMask& occupied, const std::array<int, 3>& shift) {
    constexpr std::uint64_t kAll = ~std::uint64_t{0};
    const auto rows = [](int along, std::uint64_t first, std::uint64_t last) {
      return along < 0 ? last : along > 0 ? first : kAll;
    };
    const std::uint64_t plane = rows(shift[1], 0xFF, std::uint64_t{0xFF} << 56U) &
                                rows(shift[2], 0x0101010101010101, 0x8080808080808080);
    LeafMask mask{};
    const std::size_t begin = shift[0] < 0 ? 7 : 0, end = shift[0] > 0 ? 1 : 8;
    for (std::size_t x = begin; x < end; ++x) mask[x] = occupied[x] & plane;
    return mask;
  }

  void add(const GridSnapshot::Leaf& leaf, const std::array<int, 3>& shift) {
    const auto share = static_cast<float>(surface_share(leaf.beliefs->scale));
    for_each_bit(near(leaf.occupied, shift), [&](unsigned offset) {
      const Belief* belief = leaf.beliefs->find(offset);
      if (belief == nullptr || belief->hits == 0) return;
      const auto [x, y, z] = position(offset);
      float* row = &sums_[place(x + shift[0], y + shift[1], z + shift[2])];
      for (std::size_t k = 0; k < 6; ++k) row[k] = belief->information[k] * share;
      row[6] = 1;
      if (shift == std::array{0, 0, 0}) set_bit(measured_, offset);
    });
  }

  Rows sums_;
  LeafMask measured_;
};

}  // namespace

PooledSurface::PooledSurface(const GridSnapshot& snapshot) : blocks_(snapshot.leaves.size()) {
  Pool pool;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const GridSnapshot::Leaf& leaf = snapshot.leaves[i];
    if (!leaf.beliefs || leaf.occupied == LeafMask{}) continue;
    pool.look_at(snapshot, leaf);
    blocks_[i].mask = pool.measured();
    blocks_[i].beliefs.reserve(leaf.beliefs->beliefs.size());
    for_each_bit(pool.measured(),
                 [&](unsigned offset) { blocks_[i].beliefs.push_back(pool.pooled(offset)); });
  }
}

}  // namespace viewgain::detail
