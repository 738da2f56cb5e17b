// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "scene_cells.hpp"

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

std::array<Run, 3> runs_of(const SceneData& data, std::size_t region) {
  const SceneRegion &begin = data.regions[region], &end = data.regions[region + 1];
  const auto leaves = static_cast<std::uint32_t>(data.leaf_count);
  const auto blocks = static_cast<std::uint32_t>(data.block_count);
  return {{{begin.leaf, end.leaf},
           {leaves + begin.block, leaves + end.block},
           {blocks + begin.box, blocks + end.box}}};
}

/// Fills the cells one after another.
class CellMaker {
 public:
  CellMaker(const SceneData& data, SceneCells& cells) : data_(data), cells_(cells) {
    const std::size_t regions = data.regions.empty() ? 0 : data.regions.size() - 1;
    const std::size_t most_cells = regions + large_count();
    const std::size_t most = data.boxes.size() + most_cells * kBoxVector;
    cells.members.resize(most);
    cells.primitives.resize(most);
    cells.blocks.resize(most);
    cells.first.reserve(most_cells + 1);
    cells.places.reserve(most_cells);
    round_.reserve(most_cells);
  }

  void run() {
    for (std::size_t i = 0; i < large_count(); ++i) {
      begin();
      add(static_cast<std::uint32_t>(data_.block_count + i));
      end();
    }
    for (std::size_t i = 0; i + 1 < data_.regions.size(); ++i) {
      begin();
      for (const Run& run : runs_of(data_, i)) {
        for (std::uint32_t p = run.first; p < run.last; ++p) add(p);
      }
      end();
    }
    cells_.first.push_back(static_cast<std::uint32_t>(size_));
    cells_.members.resize(size_);
    cells_.primitives.resize(size_);
    cells_.blocks.resize(size_);
    cells_.boxes.resize(whole_vectors(round_.size()));
    for (std::size_t i = 0; i < cells_.boxes.size(); ++i) {
      cells_.boxes.set(i, round_[std::min(i, round_.size() - 1)]);
    }
  }

 private:
  // Boxes larger than a region come before all regions' boxes.
  [[nodiscard]] std::size_t large_count() const {
    return data_.regions.empty() ? 0 : data_.regions.front().box;
  }

  void begin() { begin_ = size_; }

  void add(std::uint32_t primitive) {
    const PrimitiveBox& box = data_.boxes[primitive];
    if (size_ == begin_) {
      round_.push_back(box);
    } else {
      PrimitiveBox& round = round_.back();
      for (std::size_t k = 0; k < 3; ++k) {
        round.min[k] = std::min(round.min[k], box.min[k]);
        round.max[k] = std::max(round.max[k], box.max[k]);
      }
    }
    cells_.members.set(size_, box);
    cells_.blocks[size_] = static_cast<std::uint8_t>((voxel(box.min[0], 0) >> 3 & 3) |
                                                     (voxel(box.min[1], 1) >> 3 & 3) << 2 |
                                                     (voxel(box.min[2], 2) >> 3 & 3) << 4);
    cells_.primitives[size_++] = primitive;
  }

  void end() {
    if (size_ == begin_) return;
    cells_.first.push_back(static_cast<std::uint32_t>(begin_));
    const std::uint32_t last = cells_.primitives[size_ - 1];
    for (; size_ % kBoxVector != 0; ++size_) {
      cells_.members.set(size_, data_.boxes[last]);
      cells_.primitives[size_] = kNoPrimitive;
      cells_.blocks[size_] = 0;
    }
    CellPlace place{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t low = voxel(round_.back().min[k], k);
      const std::int32_t high = voxel(round_.back().max[k] - 1.0F, k);
      place.node[k] = low >> 7;
      place.part[k] = static_cast<std::uint8_t>(low >> 5 & 3);
      place.is_larger |= high >> 7 != place.node[k];
      const bool is_first = cells_.places.empty();
      cells_.min_node[k] = is_first ? place.node[k] : std::min(cells_.min_node[k], place.node[k]);
      cells_.max_node[k] = is_first ? place.node[k] : std::max(cells_.max_node[k], place.node[k]);
    }
    cells_.has_larger |= place.is_larger;
    cells_.places.push_back(place);
  }

  // Converts to the grid's lattice.
  [[nodiscard]] std::int32_t voxel(float relative, std::size_t axis) const {
    return static_cast<std::int32_t>(relative) + cells_.base[axis];
  }

  const SceneData& data_;
  SceneCells& cells_;
  std::vector<PrimitiveBox> round_;
  std::size_t begin_ = 0, size_ = 0;
};

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

SceneCells::SceneCells(const SceneData& data)
    : base{data.snapshot.min_index.x, data.snapshot.min_index.y, data.snapshot.min_index.z} {
  CellMaker(data, *this).run();
}

}  // namespace viewgain::detail
