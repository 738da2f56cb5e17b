// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "scene_boxes.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "scene_data.hpp"

namespace viewgain::detail {
namespace {

std::size_t whole_vectors(std::size_t size) {
  return (size + kBoxVector - 1) / kBoxVector * kBoxVector;
}

/// Primitives [first, last) of one kind.
struct Run {
  std::uint32_t first, last;
};

struct Cell {
  std::uint64_t number;
  std::uint32_t region;  // one of those in the cell
};

/// The regions by the bits of their numbers that `mask` keeps.
std::vector<Cell> grouped(std::vector<Cell> cells, std::uint64_t mask) {
  for (Cell& cell : cells) cell.number &= mask;
  std::sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) {
    return std::pair(a.number, a.region) < std::pair(b.number, b.region);
  });
  return cells;
}

std::size_t count_of(const std::vector<Cell>& cells) {
  std::size_t count = cells.empty() ? 0 : 1;
  for (std::size_t i = 1; i < cells.size(); ++i) {
    count += cells[i].number != cells[i - 1].number ? 1U : 0U;
  }
  return count;
}

/// The regions that have primitives, cell by cell.
std::vector<Cell> regions_by_cell(const SceneData& data) {
  std::vector<Cell> regions;
  for (std::uint32_t i = 0; i + 1 < data.regions.size(); ++i) {
    const SceneRegion &begin = data.regions[i], &end = data.regions[i + 1];
    if (begin.leaf == end.leaf && begin.block == end.block && begin.box == end.box) continue;
    regions.push_back({data.snapshot.regions[i].number, i});
  }
  if (regions.size() <= SceneBoxes::kMaxCells) return regions;
  // Nodes of 128³, of whose regions' numbers the low six bits say where they are: x, y, z, two
  // each.
  const std::vector<Cell> eighths = grouped(regions, ~std::uint64_t{0b010101});
  if (count_of(eighths) <= SceneBoxes::kMaxCells) return eighths;
  return grouped(regions, ~std::uint64_t{0b111111});
}

std::array<Run, 3> runs_of(const SceneData& data, std::uint32_t region) {
  const SceneRegion &begin = data.regions[region], &end = data.regions[region + 1];
  const auto leaves = static_cast<std::uint32_t>(data.leaf_count);
  const auto blocks = static_cast<std::uint32_t>(data.block_count);
  return {{{begin.leaf, end.leaf},
           {leaves + begin.block, leaves + end.block},
           {blocks + begin.box, blocks + end.box}}};
}

}  // namespace

void BoxArrays::resize(std::size_t size) {
  for (auto* v : {&center_x, &center_y, &center_z, &half_x, &half_y, &half_z}) v->resize(size);
}

void BoxArrays::set(std::size_t at, const PrimitiveBox& box) {
  const auto center = [&](std::size_t k) { return 0.5F * (box.min[k] + box.max[k]); };
  const auto half = [&](std::size_t k) { return 0.5F * (box.max[k] - box.min[k]) + kBoxMargin; };
  center_x[at] = center(0), center_y[at] = center(1), center_z[at] = center(2);
  half_x[at] = half(0), half_y[at] = half(1), half_z[at] = half(2);
}

SceneBoxes::SceneBoxes(const SceneData& data, Kind kind) {
  const std::vector<PrimitiveBox>& all = data.boxes;
  if (kind == Kind::primitives) {
    count = all.size();
    boxes.resize(whole_vectors(count));
    for (std::size_t i = 0; i < boxes.size(); ++i) boxes.set(i, all[std::min(i, count - 1)]);
    return;
  }
  const std::vector<Cell> regions = regions_by_cell(data);
  const std::size_t large = data.regions.empty() ? 0 : data.regions.front().box;
  std::vector<PrimitiveBox> cells;
  cells.reserve(regions.size() + large);
  const std::size_t most = all.size() + (regions.size() + large) * kBoxVector;
  members.resize(most);
  primitives.resize(most);
  std::size_t size = 0;
  const auto begin_cell = [&](std::uint32_t primitive) {
    first.push_back(static_cast<std::uint32_t>(size));
    cells.push_back(all[primitive]);
  };
  const auto add = [&](std::uint32_t primitive) {
    const PrimitiveBox& box = all[primitive];
    for (std::size_t k = 0; k < 3; ++k) {
      cells.back().min[k] = std::min(cells.back().min[k], box.min[k]);
      cells.back().max[k] = std::max(cells.back().max[k], box.max[k]);
    }
    members.set(size, box);
    primitives[size++] = primitive;
  };
  const auto end_cell = [&] {
    const std::uint32_t last = primitives[size - 1];
    for (; size % kBoxVector != 0; ++size) {
      members.set(size, all[last]);
      primitives[size] = kNoPrimitive;
    }
  };

  for (std::size_t i = 0; i < large; ++i) {
    const auto primitive = static_cast<std::uint32_t>(data.block_count + i);
    begin_cell(primitive);
    add(primitive);
    end_cell();
  }
  for (std::size_t i = 0; i < regions.size();) {
    const std::uint64_t cell = regions[i].number;
    bool is_begun = false;
    for (; i < regions.size() && regions[i].number == cell; ++i) {
      for (const Run& run : runs_of(data, regions[i].region)) {
        for (std::uint32_t p = run.first; p < run.last; ++p) {
          if (!is_begun) begin_cell(p);
          is_begun = true;
          add(p);
        }
      }
    }
    end_cell();
  }
  first.push_back(static_cast<std::uint32_t>(size));
  members.resize(size);
  primitives.resize(size);

  count = cells.size();
  boxes.resize(whole_vectors(count));
  for (std::size_t i = 0; i < boxes.size(); ++i) boxes.set(i, cells[std::min(i, count - 1)]);
}

}  // namespace viewgain::detail
