// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace viewgain::detail {

/// A number with a key of two numbers.
using Keyed = std::pair<std::uint64_t, std::uint32_t>;

[[nodiscard]] inline std::uint64_t key_of(std::uint32_t first, std::uint32_t second) {
  return static_cast<std::uint64_t>(first) << 32U | second;
}

/// Same result as std::sort. About O(n) if the keys' first numbers count from 0 and each occurs a
/// few times, as vertices of a mesh do. Takes memory for the largest first number.
inline void sort_by_key(std::vector<Keyed>& items) {
  std::vector<std::size_t> begins;  // of the buckets; after the scatter loop their ends
  for (const Keyed& item : items) {
    const auto first = static_cast<std::size_t>(item.first >> 32U);
    if (begins.size() < first + 2) begins.resize(first + 2);
    ++begins[first + 1];
  }
  for (std::size_t i = 1; i < begins.size(); ++i) begins[i] += begins[i - 1];
  std::vector<Keyed> sorted(items.size());
  for (const Keyed& item : items) sorted[begins[item.first >> 32U]++] = item;
  std::size_t begin = 0;
  for (const std::size_t end : begins) {
    std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(begin),
              sorted.begin() + static_cast<std::ptrdiff_t>(end));
    begin = end;
  }
  items.swap(sorted);
}

}  // namespace viewgain::detail
