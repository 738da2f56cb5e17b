// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Compiled once per instruction set. Plain loops of fixed length, which compilers vectorise.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "hazard/cell_kernels.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
//
#include <hwy/highway.h>

#include <algorithm>
#include <cstdlib>

#include "cell_kernels.hpp"
#include "viewgain/support/isa_dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {
namespace {

constexpr std::size_t kChunk = 32;  // cells that lower() takes through its steps at once

// The distances and steps of a chunk of a row.
struct alignas(64) Lowered {
  std::int16_t squared[kChunk], step[kChunk];
};

std::int16_t greatest(const std::int16_t* cells) {
  std::int16_t most = 0;
  for (std::size_t i = 0; i < kChunk; ++i) most = std::max(most, cells[i]);
  return most;
}

std::int16_t least(const std::int16_t* cells, std::size_t size) {
  std::int16_t result = cells[0];
  for (std::size_t i = 1; i < size; ++i) result = std::min(result, cells[i]);
  return result;
}

template <bool kWhole>
void take(const std::int16_t* other, std::size_t size, std::int16_t square, std::int16_t rows,
          Lowered& out) {
  const std::size_t count = kWhole ? kChunk : size;
  for (std::size_t i = 0; i < count; ++i) {
    const auto through = static_cast<std::int16_t>(other[i] + square);
    out.step[i] = through < out.squared[i] ? rows : out.step[i];
    out.squared[i] = std::min(out.squared[i], through);
  }
}

// lower() for the chunk `in` of the row at `position`. Skips rows that cannot lower the result, or
// not below reach²: `lowest` has the minimum of this chunk in each row, every `apart`.
void lower_chunk(const CellLine& line, std::size_t position, const std::int16_t* in,
                 std::size_t size, const std::int16_t* lowest, std::size_t apart, int reach,
                 Lowered& out) {
  for (std::size_t i = 0; i < kChunk; ++i) {
    out.squared[i] = i < size ? in[i] : std::int16_t{0};
    out.step[i] = 0;
  }
  int most = greatest(out.squared);
  const int limit = reach * reach;
  for (int k = 1; k <= reach && k * k < most; ++k) {
    const auto rows = static_cast<std::ptrdiff_t>(k);
    for (const std::ptrdiff_t by : {-rows, rows}) {
      const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(position) + by;
      if (row < 0 || row >= static_cast<std::ptrdiff_t>(line.count)) continue;
      const int from = lowest[static_cast<std::size_t>(row) * apart] + k * k;
      if (from > limit || from >= most) continue;
      const std::int16_t* other = in + by * static_cast<std::ptrdiff_t>(line.stride);
      (size == kChunk ? take<true> : take<false>)(other, size, static_cast<std::int16_t>(k * k),
                                                  static_cast<std::int16_t>(by), out);
      most = greatest(out.squared);
    }
  }
}

void lower(const CellLine& line, int reach, int most, const std::int16_t* in, std::int16_t* out,
           std::int8_t* steps, std::vector<std::int16_t>& scratch) {
  const std::size_t size = std::min(line.length, kChunk),
                    chunks = (line.length + kChunk - 1) / kChunk;
  scratch.resize(line.count * chunks);
  for (std::size_t pass = 0; pass < 2; ++pass) {
    for (std::size_t row = 0; row < line.count; ++row) {
      for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
        // A short last chunk overlaps the one before.
        const std::size_t at = row * line.stride + std::min(chunk * kChunk, line.length - size);
        if (pass == 0) {
          scratch[row * chunks + chunk] = least(in + at, size);
          continue;
        }
        Lowered lowered;
        lower_chunk(line, row, in + at, size, &scratch[chunk], chunks, reach, lowered);
        for (std::size_t i = 0; i < size; ++i) {
          const std::int16_t squared = lowered.squared[i];
          out[at + i] = squared > most ? std::int16_t{-1} : squared;
          steps[at + i] = static_cast<std::int8_t>(lowered.step[i]);
        }
      }
    }
  }
}

// The word that is `shift` bits further on.
template <int kSign>
std::uint64_t shifted(const std::uint64_t* words, std::size_t i, unsigned shift) {
  if constexpr (kSign == 0) return words[i];
  if constexpr (kSign > 0) return words[i] >> shift | words[i + 1] << (64 - shift);
  return words[i] << shift | *(words + i - 1) >> (64 - shift);
}

template <int kSign>
void join_by(StepWords<const std::uint64_t> first, StepWords<const std::uint64_t> then,
             unsigned shift, std::size_t count, StepWords<std::uint64_t> out) {
  if (first.free == nullptr) {
    for (std::size_t i = 0; i < count; ++i) {
      out.free[i] = shifted<kSign>(then.free, i, shift);
      out.unknown[i] = shifted<kSign>(then.unknown, i, shift);
    }
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t passed = first.unknown[i];
    out.free[i] = first.free[i] | (passed & shifted<kSign>(then.free, i, shift));
    out.unknown[i] = passed & shifted<kSign>(then.unknown, i, shift);
  }
}

void join(StepWords<const std::uint64_t> first, StepWords<const std::uint64_t> then, int shift,
          std::size_t count, StepWords<std::uint64_t> out) {
  const auto by = static_cast<unsigned>(std::abs(shift));
  (shift == 0 ? join_by<0> : shift > 0 ? join_by<1> : join_by<-1>)(first, then, by, count, out);
}

void add(const std::uint64_t* bits, std::size_t count, std::uint64_t* const* planes,
         std::size_t plane_count) {
  constexpr std::size_t kBlock = 64;
  std::uint64_t carry[kBlock];
  for (std::size_t begin = 0; begin < count; begin += kBlock) {
    const std::size_t size = std::min(kBlock, count - begin);
    std::copy_n(bits + begin, size, carry);
    for (std::size_t k = 0; k < plane_count; ++k) {
      std::uint64_t* sums = planes[k] + begin;
      for (std::size_t i = 0; i < size; ++i) {
        const std::uint64_t both = sums[i] & carry[i];
        sums[i] ^= carry[i];
        carry[i] = both;
      }
    }
  }
}

}  // namespace

const CellKernels& cell_kernels_of_target() {
  static const CellKernels table{lower, join, add};
  return table;
}

}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewgain::detail {

const CellKernels& cell_kernels(Isa isa) { return VIEWGAIN_OF_ISA(isa, cell_kernels_of_target)(); }

}  // namespace viewgain::detail
#endif
