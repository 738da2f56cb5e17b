// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "open_directions.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <mutex>

#include "viewgain/support/belief_block.hpp"

namespace viewgain::detail {
namespace {

// A bit per byte that is 1, of 8 bytes that are 0 or 1.
std::uint64_t packed(const std::uint8_t* bytes) {
  std::uint64_t eight = 0;
  std::memcpy(&eight, bytes, 8);
  return eight * 0x0102040810204080U >> 56U;
}

}  // namespace

OpenDirections::OpenDirections(const GridSnapshot& snapshot, const VoxelBox& cells, int shift,
                               const FreeShare& free, int reach, ThreadPool& pool)
    : size_{static_cast<std::size_t>(cells.max.x - cells.min.x),
            static_cast<std::size_t>(cells.max.y - cells.min.y),
            static_cast<std::size_t>(cells.max.z - cells.min.z)},
      words_((size_[2] + 63) / 64 + 1),
      kernels_(cell_kernels(select_isa())) {
  const Steps here = cells_of(snapshot, cells, shift, free, pool);
  for (Bits& plane : counts_) plane.assign(here.free.size(), 0);
  // Each thread counts some directions; sums of integers are the same in any order.
  std::mutex mutex;
  const auto groups = static_cast<std::size_t>(std::min(pool.num_threads(), kDirections));
  std::atomic<int> next{0};
  pool.for_each_chunk(groups, 1, [&](std::size_t, std::size_t) {
    std::array<Steps, 3> buffers;
    for (Steps& steps : buffers) {
      steps.free.assign(here.free.size(), 0);
      steps.unknown.assign(here.free.size(), 0);
    }
    Counts counts;
    for (Bits& plane : counts) plane.assign(here.free.size(), 0);
    for (int i = next++; i < kDirections + 1; i = next++) {
      const Direction by{i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1};
      const int squared = by[0] * by[0] + by[1] * by[1] + by[2] * by[2];
      if (squared == 0) continue;
      const double steps = reach / std::sqrt(double{1} * squared);
      go(here, by, static_cast<unsigned>(std::max(1.0, steps)), buffers, counts);
    }
    const std::lock_guard lock(mutex);
    for (std::size_t k = 0; k < kPlanes; ++k) add(counts[k], k, counts_);
  });
}

OpenDirections::Steps OpenDirections::cells_of(const GridSnapshot& snapshot, const VoxelBox& cells,
                                               int shift, const FreeShare& free,
                                               ThreadPool& pool) const {
  const std::size_t rows = size_[0] * size_[1], length = size_[2];
  const std::size_t all = rows * words_ + 2;  // one more on each side, because shifts read there
  Steps here{Bits(all), Bits(all)};
  pool.for_each_chunk(rows, 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const std::uint8_t* is_free = free.is_free() + row * length;
      std::uint64_t* const bits = &here.free[word_of(row, 0)];
      std::uint64_t* const unknown = &here.unknown[word_of(row, 0)];
      std::size_t z = 0;
      for (; z + 8 <= length; z += 8) bits[z / 64] |= packed(is_free + z) << z % 64;
      for (; z < length; ++z) bits[z / 64] |= std::uint64_t{is_free[z]} << z % 64;
      for (z = 0; z < length; z += 64) {
        const std::uint64_t inside =
            length - z >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << (length - z)) - 1;
        unknown[z / 64] = ~bits[z / 64] & inside;
      }
    }
  });
  const VoxelBox voxels{{cells.min.x << shift, cells.min.y << shift, cells.min.z << shift},
                        {cells.max.x << shift, cells.max.y << shift, cells.max.z << shift}};
  for (const GridSnapshot::Leaf& leaf : snapshot.leaves) {
    for_each_bit(leaf.occupied, [&](unsigned offset) {
      const Index3 v = offset_voxel(leaf.origin, offset);
      if (!voxels.contains(v)) return;
      const auto x = static_cast<std::size_t>((v.x >> shift) - cells.min.x),
                 y = static_cast<std::size_t>((v.y >> shift) - cells.min.y),
                 z = static_cast<std::size_t>((v.z >> shift) - cells.min.z);
      here.unknown[word_of(x * size_[1] + y, z)] &= ~(std::uint64_t{1} << (z % 64));
    });
  }
  return here;
}

// Counts the cells from which so many steps reach free space.
void OpenDirections::go(const Steps& here, const Direction& by, unsigned wanted,
                        std::array<Steps, 3>& buffers, Counts& counts) const {
  auto& [one, a, b] = buffers;
  join(nullptr, here, by, 1, one);
  const Steps* last = &one;
  const auto take = [&](const Steps& first, int steps) {
    Steps& result = last == &a ? b : a;
    join(&first, *last, by, steps, result);
    last = &result;
  };
  // The bits of `wanted` from the second on: doubles the distance, plus one step for a set bit.
  int taken = 1;
  for (int bit = std::bit_width(wanted) - 2; bit >= 0; --bit) {
    take(*last, taken);
    taken *= 2;
    if ((wanted >> bit & 1U) != 0) {
      take(one, 1);
      ++taken;
    }
  }
  add(last->free, 0, counts);
}

// `first` from each cell, or nothing, then `then` from its end, `steps` further. The last word of a
// row stays 0, so that bits shifted from one row into the next are lost.
void OpenDirections::join(const Steps* first, const Steps& then, const Direction& by, int steps,
                          Steps& result) const {
  const int nx = static_cast<int>(size_[0]), ny = static_cast<int>(size_[1]);
  const int dx = by[0] * steps, dy = by[1] * steps, dz = by[2] * steps;
  const int low = std::clamp(-dy, 0, ny), high = std::clamp(ny - dy, low, ny);
  // Rows from which the steps lead out of the box.
  const auto end_there = [&](int x, int begin, int end) {
    const std::size_t from = word_of(static_cast<std::size_t>(x * ny + begin), 0),
                      count = static_cast<std::size_t>(end - begin) * words_;
    if (first == nullptr) {
      std::fill_n(&result.free[from], count, 0);
    } else {
      std::copy_n(&first->free[from], count, &result.free[from]);
    }
    std::fill_n(&result.unknown[from], count, 0);
  };
  for (int x = 0; x < nx; ++x) {
    if (x + dx < 0 || x + dx >= nx) {
      end_there(x, 0, ny);
      continue;
    }
    end_there(x, 0, low);
    end_there(x, high, ny);
    if (low == high) continue;
    const std::size_t here = word_of(static_cast<std::size_t>(x * ny + low), 0),
                      there = word_of(static_cast<std::size_t>((x + dx) * ny + low + dy), 0),
                      count = static_cast<std::size_t>(high - low) * words_;
    StepWords<const std::uint64_t> begin{};
    if (first != nullptr) begin = {&first->free[here], &first->unknown[here]};
    kernels_.join(begin, {&then.free[there], &then.unknown[there]}, dz, count,
                  {&result.free[here], &result.unknown[here]});
  }
  if (first != nullptr) return;
  for (std::size_t row = 1; row <= size_[0] * size_[1]; ++row) {
    const std::size_t last = word_of(row, 0) - 1;
    result.free[last] = result.unknown[last] = 0;
  }
}

// Adds 2^plane where a bit is set.
void OpenDirections::add(const Bits& bits, std::size_t plane, Counts& counts) const {
  std::array<std::uint64_t*, kPlanes> planes{};
  for (std::size_t k = plane; k < kPlanes; ++k) planes[k] = counts[k].data();
  kernels_.add(bits.data(), bits.size(), planes.data() + plane, kPlanes - plane);
}

}  // namespace viewgain::detail
