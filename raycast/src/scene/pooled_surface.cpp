// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "pooled_surface.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "viewgain/support/block_lattice.hpp"

namespace viewgain::detail {
namespace {

// Sums over the 27 cells centred on each cell of one leaf. The same object serves all leaves.
class Pool {
 public:
  void look_at(const GridSnapshot& snapshot, const GridSnapshot::Leaf& leaf) {
    scale_ = leaf.beliefs->scale;
    along_ = (std::size_t{8} >> static_cast<unsigned>(scale_)) + 2;
    used_ = along_ * along_ * along_ * kRow;
    std::fill_n(sums_.begin(), used_, 0.0F);
    measured_ = {};
    // The leaf's lowest voxel may lie outside the workspace, where find_leaf() finds nothing.
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
    for (std::size_t step = kRow; step < used_; step *= along_) add_beside(step);
  }

  // The lowest voxels of the leaf's occupied cells with readings.
  [[nodiscard]] const LeafMask& measured() const { return measured_; }

  // The pooled belief of the cell whose lowest voxel has this offset.
  [[nodiscard]] Belief pooled(unsigned offset) const {
    const float* sum = &sums_[place(position(offset))];
    Belief belief;
    for (std::size_t k = 0; k < 6; ++k) {
      belief.information[k] = sum[k] / static_cast<float>(PooledSurface::kCells);
    }
    belief.hits = static_cast<std::uint32_t>(sum[6]);
    return belief;
  }

 private:
  // Cells from -1 to one past the leaf's last along x, y, z. Each has a row of numbers: Λ and 1 if
  // it has readings.
  static constexpr std::size_t kRow = 8;
  using Rows = std::array<float, 10 * 10 * 10 * kRow>;

  [[nodiscard]] std::size_t place(const std::array<int, 3>& voxel) const {
    const auto cell = [&](int i) { return static_cast<std::size_t>((i >> scale_) + 1); };
    return ((cell(voxel[0]) * along_ + cell(voxel[1])) * along_ + cell(voxel[2])) * kRow;
  }
  static std::array<int, 3> position(unsigned offset) {
    return {static_cast<int>(offset >> 6U), static_cast<int>(offset >> 3U & 7U),
            static_cast<int>(offset & 7U)};
  }

  // Adds to each row the two rows beside it along one axis. Rows at the rim also get a wrong row,
  // from the opposite rim. pooled() does not read rows at the rim.
  void add_beside(std::size_t step) {
    Rows own;
    std::copy_n(sums_.begin(), used_, own.begin());
    for (std::size_t i = step; i < used_ - step; ++i) {
      sums_[i] = own[i - step] + own[i] + own[i + step];
    }
  }

  // The occupied voxels of the leaf at `shift` from this leaf that lie at most one cell away from
  // this leaf. If the shift is 0, all of them.
  [[nodiscard]] LeafMask near(const LeafMask& occupied, const std::array<int, 3>& shift) const {
    const unsigned edge = 1U << static_cast<unsigned>(scale_);
    const auto slab = [&](int along) -> std::uint64_t {  // one bit for each of eight positions
      return along < 0 ? 0xFFU << (8 - edge) & 0xFFU : along > 0 ? 0xFFU >> (8 - edge) : 0xFFU;
    };
    std::uint64_t rows = 0;
    for (unsigned y = 0; y < 8; ++y) {
      if ((slab(shift[1]) >> y & 1U) != 0) rows |= slab(shift[2]) << 8 * y;
    }
    LeafMask mask{};
    for (unsigned x = 0; x < 8; ++x) {
      if ((slab(shift[0]) >> x & 1U) != 0) mask[x] = occupied[x] & rows;
    }
    return mask;
  }

  void add(const GridSnapshot::Leaf& leaf, const std::array<int, 3>& shift) {
    const bool is_own = shift == std::array{0, 0, 0};
    const int other = leaf.beliefs->scale, smaller = std::min(scale_, other);
    // A cell of this leaf's size gets its part of a larger cell's information.
    const auto share =
        static_cast<float>(surface_share(std::max(scale_, other)) / surface_share(scale_));
    for_each_bit(near(leaf.occupied, shift), [&](unsigned offset) {
      if (cell_offset(offset, smaller) != offset) return;  // counts once
      const Belief* belief = leaf.beliefs->find(offset);
      if (belief == nullptr || belief->hits == 0) return;
      auto [x, y, z] = position(offset);
      float* row = &sums_[place({x + shift[0], y + shift[1], z + shift[2]})];
      for (std::size_t k = 0; k < 6; ++k) row[k] += belief->information[k] * share;
      row[6] = 1;
      if (is_own) set_bit(measured_, offset);
    });
  }

  int scale_ = 0;
  std::size_t along_ = 0, used_ = 0;  // cells along an axis, numbers
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
    blocks_[i].scale = leaf.beliefs->scale;
    blocks_[i].beliefs.reserve(count_bits(pool.measured()));
    for_each_bit(pool.measured(),
                 [&](unsigned offset) { blocks_[i].beliefs.push_back(pool.pooled(offset)); });
  }
}

}  // namespace viewgain::detail
