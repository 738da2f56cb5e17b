// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "scene_boxes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ray_tile.hpp"
#include "scene_data.hpp"

namespace viewgain::detail {
namespace {

// Boxes count as larger by this much [voxels], against rounding.
constexpr float kBoxMargin = 0.02F;
constexpr float kLeastCellEdge = 32.0F;  // [voxels]
constexpr std::size_t kMaxLattice = std::size_t{1} << 18U;

// Which primitives' centres lie in which cell of a lattice: members[begins[c], begins[c + 1]) are
// those of cell c, in order.
struct Cells {
  std::vector<std::uint32_t> begins, members;
  std::size_t filled = 0;

  // False if the lattice has too many cells.
  bool sort(const std::vector<PrimitiveBox>& primitives, const std::array<float, 3>& low,
            const std::array<float, 3>& high, float edge) {
    std::array<std::size_t, 3> size{};
    for (std::size_t k = 0; k < 3; ++k) {
      size[k] = static_cast<std::size_t>((high[k] - low[k]) / edge) + 1;
    }
    if (size[0] * size[1] * size[2] > kMaxLattice) return false;
    std::vector<std::uint32_t> cell_of(primitives.size());
    begins.assign(size[0] * size[1] * size[2] + 1, 0);
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      std::size_t cell = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const float center = 0.5F * (primitives[i].min[k] + primitives[i].max[k]);
        cell = cell * size[k] + static_cast<std::size_t>((center - low[k]) / edge);
      }
      cell_of[i] = static_cast<std::uint32_t>(cell);
      ++begins[cell + 1];
    }
    filled = begins.size() - static_cast<std::size_t>(std::count(begins.begin(), begins.end(), 0U));
    for (std::size_t c = 1; c < begins.size(); ++c) begins[c] += begins[c - 1];
    members.resize(primitives.size());
    std::vector<std::uint32_t> next(begins.begin(), begins.end() - 1);
    for (std::uint32_t i = 0; i < primitives.size(); ++i) members[next[cell_of[i]]++] = i;
    return true;
  }
};

}  // namespace

void BoxArrays::append(const PrimitiveBox& box) {
  const auto center = [&](std::size_t k) { return 0.5F * (box.min[k] + box.max[k]); };
  const auto half = [&](std::size_t k) { return 0.5F * (box.max[k] - box.min[k]) + kBoxMargin; };
  center_x.push_back(center(0)), center_y.push_back(center(1)), center_z.push_back(center(2));
  half_x.push_back(half(0)), half_y.push_back(half(1)), half_z.push_back(half(2));
}

void BoxArrays::reserve(std::size_t size) {
  for (auto* v : {&center_x, &center_y, &center_z, &half_x, &half_y, &half_z}) v->reserve(size);
}

void BoxArrays::pad() {
  for (auto* v : {&center_x, &center_y, &center_z, &half_x, &half_y, &half_z}) {
    while (v->size() % kBoxVector != 0) v->push_back(v->back());
  }
}

SceneBoxes::SceneBoxes(const std::vector<PrimitiveBox>& all) {
  if (all.size() <= kMaxBoxes) {
    boxes.reserve(all.size() + kBoxVector);
    for (const PrimitiveBox& box : all) boxes.append(box);
    count = all.size();
    boxes.pad();
    return;
  }
  std::array<float, 3> low{}, high{};
  low.fill(std::numeric_limits<float>::max());
  high.fill(std::numeric_limits<float>::lowest());
  for (const PrimitiveBox& box : all) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], box.min[k]);
      high[k] = std::max(high[k], box.max[k]);
    }
  }
  Cells cells;
  for (float edge = kLeastCellEdge;
       !cells.sort(all, low, high, edge) || cells.filled > kMaxBoxes;) {
    edge *= 2.0F;
  }
  count = 0;
  boxes.reserve(cells.filled + kBoxVector);
  members.reserve(all.size() + cells.filled * kBoxVector);
  for (std::size_t c = 0; c + 1 < cells.begins.size(); ++c) {
    if (cells.begins[c] == cells.begins[c + 1]) continue;
    PrimitiveBox box = all[cells.members[cells.begins[c]]];
    first.push_back(static_cast<std::uint32_t>(members.size()));
    for (std::uint32_t m = cells.begins[c]; m < cells.begins[c + 1]; ++m) {
      const std::uint32_t i = cells.members[m];
      for (std::size_t k = 0; k < 3; ++k) {
        box.min[k] = std::min(box.min[k], all[i].min[k]);
        box.max[k] = std::max(box.max[k], all[i].max[k]);
      }
      members.append(all[i]);
      primitives.push_back(i);
    }
    boxes.append(box);
    members.pad();
    primitives.resize(members.size(), kNoPrimitive);
    ++count;
  }
  first.push_back(static_cast<std::uint32_t>(members.size()));
  boxes.pad();
}

}  // namespace viewgain::detail
