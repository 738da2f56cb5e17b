// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "viewgain/support/isa.hpp"

namespace viewgain::detail {

/// Rows of `length` cells along an axis, `stride` cells apart.
struct CellLine {
  std::size_t stride, count, length;
};

/// Where a number of steps leads: whether free space has been reached, and whether all is still
/// unknown. A bit per cell, in words.
template <typename Word>
struct StepWords {
  Word *free, *unknown;
};

/// Loops over cells in integers, with one set of functions per instruction set; the results are the
/// same.
struct CellKernels {
  /// For each cell: the least square of its row and of those up to `reach` rows away, plus k² for
  /// the k-th, and that k: nearest row first, the lower one first. Squares above `most` become -1.
  /// `in` is at most 2^14, and `out` has the same rows. `scratch` serves call after call.
  void (*lower)(const CellLine& line, int reach, int most, const std::int16_t* in,
                std::int16_t* out, std::int8_t* steps, std::vector<std::int16_t>& scratch);
  /// `first`, then `then` from its end; the latter's words shifted by `shift` bits towards lower
  /// bits if positive. First's words may be null: nothing has been reached, and all is unknown.
  void (*join)(StepWords<const std::uint64_t> first, StepWords<const std::uint64_t> then, int shift,
               std::size_t count, StepWords<std::uint64_t> out);
  /// Adds words of a bit each to numbers of which planes[k] has bit k.
  void (*add)(const std::uint64_t* bits, std::size_t count, std::uint64_t* const* planes,
              std::size_t plane_count);
};

[[nodiscard]] const CellKernels& cell_kernels(Isa isa);

}  // namespace viewgain::detail
